#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap::bundler {

/// One line of a list of images: `name`, or `name 0 focal`; the number of the
/// line is that of the camera. Names have no blanks.
struct ListedImage {
  std::string name;
  double focal_px = 0;  // 0: unknown
};

/// kParse, with file and line, for a focal length that is none, and for a name
/// that is not UTF-8.
Result<std::vector<ListedImage>> ParseList(std::string_view text,
                                           const std::string& file);

/// kUnsupported for a name that a list cannot hold.
Status CheckListedName(const std::string& name);

}  // namespace lowlap::bundler
