#pragma once

#include <string>
#include <vector>

namespace lowlap {

/// The texts of the items, with the separator between them.
template <class Items, class TextOf>
std::string Joined(const Items& items, const char* separator,
                   const TextOf& text_of) {
  std::string text;
  const char* before = "";
  for (const auto& item : items) {
    text += before;
    text += text_of(item);
    before = separator;
  }
  return text;
}
inline std::string Joined(const std::vector<std::string>& words,
                          const char* separator) {
  return Joined(words, separator, [](const std::string& word) { return word; });
}

}  // namespace lowlap
