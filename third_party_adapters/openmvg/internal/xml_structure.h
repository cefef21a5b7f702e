#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"

namespace lowlap::openmvg {

/// Reads the tags of an XML text once, in linear time and without recursion,
/// before it goes to a parser that recurses. kParse, with the byte, for
/// elements nested deeper than `max_depth`, and for tags that the parser might
/// take apart in another way: whatever passes has the depth found here.
Status CheckXmlStructure(std::string_view text, int max_depth,
                         const std::string& file);

}  // namespace lowlap::openmvg
