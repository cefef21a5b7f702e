#pragma once

#include <string>
#include <vector>

namespace lowlap {

/// The fields of one line of CSV (RFC 4180), without the end of the line.
std::vector<std::string> SplitCsvLine(const std::string& line);

/// The text in quotes, as a field; ends of lines in it become spaces, so that a
/// record is one line.
std::string QuotedCsvField(const std::string& text);

}  // namespace lowlap
