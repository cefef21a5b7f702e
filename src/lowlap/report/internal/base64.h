#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lowlap {

/// RFC 4648, with padding.
std::string Base64(std::string_view bytes);

/// The numbers as they lie in memory, which the page reads as a typed array
/// (little endian there and on every machine that lowlap is built for).
template <class Number>
std::string Base64(const std::vector<Number>& numbers) {
  static_assert(std::is_arithmetic_v<Number>);
  return Base64(std::string_view(reinterpret_cast<const char*>(numbers.data()),
                                 numbers.size() * sizeof(Number)));
}

}  // namespace lowlap
