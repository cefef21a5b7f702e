#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace lowlap::openmvg::internal {

inline bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Walks over the lines of a text; "\n" and "\r\n" both end one.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// The next line without its end; false after the last one. A final line end
  /// does not start another line.
  bool Next(std::string_view& line) {
    if (offset_ >= text_.size()) return false;
    const std::size_t end = text_.find('\n', offset_);
    const bool last = end == std::string_view::npos;
    line = text_.substr(offset_, (last ? text_.size() : end) - offset_);
    offset_ = last ? text_.size() : end + 1;
    ++number_;
    return true;
  }
  /// "line N" of the line that Next() gave last, counted from 1.
  std::string Place() const { return "line " + std::to_string(number_); }

 private:
  std::string_view text_;
  std::size_t offset_ = 0;
  std::size_t number_ = 0;
};

/// Takes the next blank-separated token off the front of a line; empty at the
/// end.
inline std::string_view TakeToken(std::string_view& line) {
  std::size_t start = 0;
  while (start < line.size() && IsBlank(line[start])) ++start;
  std::size_t end = start;
  while (end < line.size() && !IsBlank(line[end])) ++end;
  const std::string_view token = line.substr(start, end - start);
  line.remove_prefix(end);
  return token;
}

/// A whole token as a number; false for anything else (for doubles also for one
/// that is not finite). Independent of the locale.
template <class T>
bool ParseNumber(std::string_view token, T& value) {
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error != std::errc() || stop != end) return false;
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
  return true;
}

}  // namespace lowlap::openmvg::internal
