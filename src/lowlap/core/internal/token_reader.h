#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// Takes numbers off a text, one after the other; white space stands between
/// them. The first failure stays: what is read after it is 0, and `status`
/// tells the file, line and cause. Independent of the locale.
class TokenReader {
 public:
  TokenReader(std::string_view text, std::string file)
      : text_(text), file_(std::move(file)) {}

  /// Only white space is left.
  bool AtEnd() {
    SkipSpace();
    return offset_ >= text_.size();
  }

  /// Only blanks are left on the line.
  bool AtLineEnd() {
    offset_ = std::min(text_.find_first_not_of(" \t\r", offset_), text_.size());
    return offset_ >= text_.size() || text_[offset_] == '\n';
  }

  /// The next token as a number; `what` it is, for the message. Numbers that
  /// are not finite are none.
  template <class T>
  T Next(const char* what) {
    T value{};
    const std::string_view token = PeekWord(what);
    if (token.empty()) return value;
    const auto [stop, error] =
        std::from_chars(token.data(), token.data() + token.size(), value);
    bool is_good = error == std::errc() && stop == token.data() + token.size();
    if constexpr (std::is_floating_point_v<T>) {
      is_good = is_good && std::isfinite(value);
    }
    if (!is_good) {
      Fail("'" + Escaped(std::string(token.substr(0, 32))) + "' is not " +
           what);
      return T{};
    }
    offset_ += token.size();
    return value;
  }

  /// The next character that is not white space; only if not AtEnd.
  char Peek() {
    SkipSpace();
    return text_[offset_];
  }

  /// The next token as it is.
  std::string_view Word(const char* what) {
    const std::string_view token = PeekWord(what);
    offset_ += token.size();
    return token;
  }

  /// The rest of the line, without its end and outer blanks.
  std::string_view RestOfLine() {
    const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
    std::string_view rest = text_.substr(offset_, end - offset_);
    offset_ = end;
    const auto is_blank = [](char c) {
      return c == ' ' || c == '\t' || c == '\r';
    };
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return rest;
  }

  /// RestOfLine of the next line; false at the end of the text.
  bool NextLine(std::string_view* line) {
    if (offset_ < text_.size() && text_[offset_] == '\n') {
      ++offset_;
      ++line_;
    }
    if (offset_ >= text_.size()) return false;
    *line = RestOfLine();
    return true;
  }

  void Fail(const std::string& message, ErrorCode code = ErrorCode::kParse) {
    if (!status_) return;
    status_ = MakeError(code, message, file_, "line " + std::to_string(line_));
  }
  const Status& status() const { return status_; }
  tl::unexpected<Error> error() const {
    return tl::unexpected<Error>(status_.error());
  }

 private:
  /// Empty after a failure.
  std::string_view PeekWord(const char* what) {
    if (!status_) return {};
    SkipSpace();
    const std::size_t end =
        std::min(text_.find_first_of(" \t\r\n", offset_), text_.size());
    if (end == offset_) {
      Fail(std::string("the file ends where ") + what + " is expected");
    }
    return text_.substr(offset_, end - offset_);
  }

  void SkipSpace() {
    for (; offset_ < text_.size(); ++offset_) {
      const char c = text_[offset_];
      if (c == '\n') {
        ++line_;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        break;
      }
    }
  }

  std::string_view text_;
  std::string file_;
  std::size_t offset_ = 0;
  std::size_t line_ = 1;
  Status status_;
};

}  // namespace lowlap
