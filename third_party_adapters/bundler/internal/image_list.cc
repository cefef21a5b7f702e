#include "third_party_adapters/bundler/internal/image_list.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "lowlap/core/internal/token_reader.h"

namespace lowlap::bundler {

Result<std::vector<ListedImage>> ParseList(std::string_view text,
                                           const std::string& file) {
  TokenReader reader(text, file);
  std::vector<ListedImage> images;
  std::string_view line;
  while (reader.NextLine(&line)) {
    ListedImage image;
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    image.name = std::string(line.substr(0, end));
    if (!IsUtf8(image.name)) {
      reader.Fail("the name '" + Escaped(image.name) + "' is not UTF-8");
      return reader.error();
    }
    if (end < line.size()) {
      const std::string_view focal = line.substr(line.find_last_of(" \t") + 1);
      TokenReader number(focal, file);
      image.focal_px = number.Next<double>("a focal length");
      if (!number.status() || image.focal_px < 0) {
        reader.Fail("'" + Escaped(std::string(focal.substr(0, 32))) +
                    "' is not a focal length");
        return reader.error();
      }
    }
    images.push_back(std::move(image));
  }
  // An empty line at the end is none; elsewhere it would shift the indices.
  while (!images.empty() && images.back().name.empty()) images.pop_back();
  return images;
}

Status CheckListedName(const std::string& name) {
  if (name.find_first_of(" \t\r\n") == std::string::npos) return {};
  return MakeError(ErrorCode::kUnsupported,
                   "the name '" + Escaped(name) +
                       "' has a blank, which this format does not allow");
}

}  // namespace lowlap::bundler
