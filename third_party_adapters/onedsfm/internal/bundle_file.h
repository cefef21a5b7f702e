#pragma once

#include <map>
#include <string>
#include <string_view>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/scene/view.h"

namespace lowlap::onedsfm {

/// The cameras of a Bundler file (v0.3, or without its first line) by index, in
/// our axes; empty cameras are left out, points are not read.
Result<std::map<ViewId, Pose>> ParseBundlePoses(std::string_view text,
                                                const std::string& file);

}  // namespace lowlap::onedsfm
