#include "lowlap/io/internal/json/json_text.h"

#include <array>
#include <charconv>

namespace lowlap {

void AppendValue(double value, std::string& text) {
  std::array<char, 32> digits;
  const auto result =
      std::to_chars(digits.data(), digits.data() + digits.size(), value);
  const std::string_view written(
      digits.data(), static_cast<std::size_t>(result.ptr - digits.data()));
  text += written;
  if (written.find_first_of(".en") == std::string_view::npos) text += ".0";
}

void AppendValue(std::uint32_t value, std::string& text) {
  std::array<char, 16> digits;
  const auto result =
      std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

void AppendValue(int value, std::string& text) {
  AppendValue(static_cast<std::uint32_t>(value), text);
}

void AppendValue(std::string_view utf8, std::string& text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  text += '"';
  for (const char c : utf8) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      text += "\\u00";
      text += kHex[static_cast<unsigned char>(c) >> 4];
      text += kHex[static_cast<unsigned char>(c) & 15];
    } else {
      text += c;
    }
  }
  text += '"';
}

void AppendValue(const ViewPair& views, std::string& text) {
  AppendValue(std::vector<ViewId>{views.first, views.second}, text);
}

void AppendValue(const ViewTriplet& views, std::string& text) {
  AppendValue(std::vector<ViewId>{views.first, views.middle, views.last}, text);
}

void AppendComma(std::string& text) {
  const char last = text.empty() ? '[' : text.back();
  if (last != '[' && last != '{') text += ", ";
}

void AppendKey(std::string_view name, std::string& text) {
  AppendComma(text);
  AppendValue(name, text);
  text += ": ";
}

}  // namespace lowlap
