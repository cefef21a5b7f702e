#include "lowlap/core/internal/format.h"

#include <cstdarg>
#include <cstddef>
#include <cstdio>

namespace lowlap {
namespace {

template <class IsHidden>
std::string WithCodes(const std::string& text, const IsHidden& is_hidden) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (is_hidden(byte)) {
      shown += Format("\\x%02X", byte);
    } else {
      shown += c;
    }
  }
  return shown;
}

}  // namespace

std::string Format(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  // With its terminating zero, which the string has room for.
  if (length > 0) std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

// No overlong forms, surrogates or values beyond U+10FFFF.
bool IsUtf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t n) -> unsigned {
      return i + n < text.size() ? static_cast<unsigned char>(text[i + n]) : 0;
    };
    const unsigned lead = byte(0);
    std::size_t length = 1;
    unsigned low = 0x80, high = 0xBF;  // range of the second byte
    if (lead >= 0x80) {
      if (lead < 0xC2 || lead > 0xF4) return false;
      length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
      if (lead == 0xE0) low = 0xA0;
      if (lead == 0xED) high = 0x9F;
      if (lead == 0xF0) low = 0x90;
      if (lead == 0xF4) high = 0x8F;
    }
    for (std::size_t n = 1; n < length; ++n) {
      if (byte(n) < low || byte(n) > high) return false;
      low = 0x80;
      high = 0xBF;
    }
    i += length;
  }
  return true;
}

std::string Escaped(const std::string& text) {
  return WithCodes(text, [](unsigned char c) { return c < 0x20 || c >= 0x7F; });
}

std::string Printable(const std::string& text) {
  const bool is_utf8 = IsUtf8(text);
  return WithCodes(text, [&](unsigned char c) {
    return (c < 0x20 && c != '\n') || c == 0x7F || (c > 0x7F && !is_utf8);
  });
}

std::string PairName(const ViewPair& views) {
  return Format("%u-%u", views.first.value(), views.second.value());
}

}  // namespace lowlap
