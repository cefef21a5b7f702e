#pragma once

#include <string>

namespace lowlap {

/// The text that printf would write, of any length.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

}  // namespace lowlap
