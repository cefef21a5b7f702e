#include "third_party_adapters/openmvg/internal/feat.h"

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/token_reader.h"

namespace lowlap::openmvg {

Result<std::vector<Vec2>> ParseFeat(std::string_view text,
                                    const std::string& file) {
  std::vector<Vec2> points_px;
  int numbers_per_line = 0;
  TokenReader reader(text, file);
  // Blank lines are skipped, as OpenMVG's reader does.
  while (reader.status() && !reader.AtEnd()) {
    Vec2 point = Vec2::Zero();
    int count = 0;
    for (; reader.status() && !reader.AtLineEnd(); ++count) {
      const double number = reader.Next<double>("a finite number");
      if (count < 2) point[count] = number;
    }
    if (numbers_per_line == 0) {
      if (count != 2 && count != 4 && count != 8) {
        reader.Fail("a feature has 2, 4 or 8 numbers, this line " +
                    std::to_string(count));
      }
      numbers_per_line = count;
    }
    if (count != numbers_per_line) {
      reader.Fail(std::to_string(count) +
                  " numbers, where the lines before have " +
                  std::to_string(numbers_per_line));
    }
    points_px.push_back(point);
  }
  if (!reader.status()) return reader.error();
  return points_px;
}

Result<std::vector<Vec2>> ReadFeat(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  return ParseFeat(text, path);
}

}  // namespace lowlap::openmvg
