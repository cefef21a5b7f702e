#pragma once

#include <string>

#include "lowlap/core/ids.h"

namespace lowlap {

/// The text that printf would write, of any length.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

/// Well-formed UTF-8 (RFC 3629).
bool IsUtf8(const std::string& text);

/// The text with bytes that are not ASCII, and control characters, as codes:
/// for messages about text that cannot be shown.
std::string Escaped(const std::string& text);

/// The same for a terminal: line ends stay, and UTF-8 does if all of it is.
std::string Printable(const std::string& text);

/// "2-5".
std::string PairName(const ViewPair& views);

}  // namespace lowlap
