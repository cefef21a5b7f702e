#include "lowlap/study/internal/csv_line.h"

#include <cstddef>

namespace lowlap {

std::vector<std::string> SplitCsvLine(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t n = 0; n < line.size(); ++n) {
    if (quoted && line[n] == '"' && n + 1 < line.size() && line[n + 1] == '"') {
      fields.back() += line[n++];
    } else if (line[n] == '"') {
      quoted = !quoted;
    } else if (line[n] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[n];
    }
  }
  return fields;
}

std::string QuotedCsvField(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + "\"";
}

}  // namespace lowlap
