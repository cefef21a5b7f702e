#include "third_party_adapters/openmvg/feat.h"

#include "lowlap/core/atomic_file.h"
#include "third_party_adapters/openmvg/internal/text_reader.h"

namespace lowlap::openmvg {

Result<std::vector<Vec2>> ParseFeat(std::string_view text,
                                    const std::string& file) {
  std::vector<Vec2> points_px;
  std::size_t numbers_per_line = 0;
  internal::LineReader lines(text);
  std::string_view line;
  while (lines.Next(line)) {
    Vec2 point = Vec2::Zero();
    std::size_t count = 0;
    for (std::string_view token = internal::TakeToken(line); !token.empty();
         token = internal::TakeToken(line), ++count) {
      double value = 0;
      if (!internal::ParseNumber(token, value)) {
        return MakeError(
            ErrorCode::kParse,
            "'" + std::string(token.substr(0, 32)) + "' is not a finite number",
            file, lines.Place());
      }
      if (count < 2) point[static_cast<Eigen::Index>(count)] = value;
    }
    if (count == 0) continue;  // OpenMVG's reader skips white space as well
    if (numbers_per_line == 0) {
      if (count != 2 && count != 4 && count != 8) {
        return MakeError(ErrorCode::kParse,
                         "a feature has 2, 4 or 8 numbers, this line " +
                             std::to_string(count),
                         file, lines.Place());
      }
      numbers_per_line = count;
    }
    if (count != numbers_per_line) {
      return MakeError(ErrorCode::kParse,
                       std::to_string(count) +
                           " numbers, where the lines "
                           "before have " +
                           std::to_string(numbers_per_line),
                       file, lines.Place());
    }
    points_px.push_back(point);
  }
  return points_px;
}

Result<std::vector<Vec2>> ReadFeat(const std::string& path) {
  const Result<std::string> text = ReadWholeFile(path);
  if (!text) return tl::unexpected<Error>(text.error());
  return ParseFeat(*text, path);
}

}  // namespace lowlap::openmvg
