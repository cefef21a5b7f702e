#pragma once

#include <string_view>

namespace lowlap {

/// The files of page/ and three.js, embedded when lowlap is built.
struct PageSource {
  std::string_view html;  // with @TITLE@, @STYLE@, @DATA@, @THREE@, @SCRIPT@
  std::string_view style;
  std::string_view script;  // the .js files, in the order of CMakeLists.txt
  /// three.js and what of its examples is used; empty if CMake did not find it.
  std::string_view three;
};

extern const PageSource kPageSource;

}  // namespace lowlap
