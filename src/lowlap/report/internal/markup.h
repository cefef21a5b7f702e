#pragma once

#include <string>

namespace lowlap {

/// Text for the content of an HTML or SVG element.
std::string EscapeMarkup(const std::string& text);

}  // namespace lowlap
