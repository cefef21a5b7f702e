#include "lowlap/scene/view_names.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace lowlap {
namespace {

bool IsNumber(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

std::string WithoutLeadingZeros(const std::string& number) {
  const std::size_t first = number.find_first_not_of('0');
  return first == std::string::npos ? "0" : number.substr(first);
}

}  // namespace

ViewNames::ViewNames(const Scene& scene) {
  Index whole, last_part, stem, number, id_text;
  bool all_numbers = !scene.views.empty();
  for (const auto& [id, view] : scene.views) {
    const std::filesystem::path path(view.filename);
    whole[view.filename].push_back(id);
    last_part[path.filename().string()].push_back(id);
    stem[path.stem().string()].push_back(id);
    number[WithoutLeadingZeros(path.stem().string())].push_back(id);
    id_text[std::to_string(id)].push_back(id);
    all_numbers = all_numbers && IsNumber(path.stem().string());
  }
  indices_ = {std::move(whole), std::move(last_part), std::move(stem),
              std::move(all_numbers ? number : id_text)};
}

Result<ViewId> ViewNames::Find(const std::string& word) const {
  for (const Index& index : indices_) {
    const auto found = index.find(word);
    if (found == index.end()) continue;
    if (found->second.size() == 1) return found->second.front();
    return MakeError(
        ErrorCode::kInvalidArgument,
        "several views are named \"" + word + "\"; use their whole names");
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "no view has the file name or the id \"" + word + "\"");
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
  std::string escaped;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) {
      escaped += c;
    } else {
      char code[8];
      std::snprintf(code, sizeof(code), "\\x%02X", byte);
      escaped += code;
    }
  }
  return escaped;
}

}  // namespace lowlap
