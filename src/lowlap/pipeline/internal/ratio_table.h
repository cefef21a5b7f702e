#pragma once

#include <string>
#include <vector>

#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

/// Columns of a table of scale ratios: the ratio and its 95 % interval, log10
/// NFA, inliers/candidates of each kind, percent of the information of points,
/// lines and coplanar pairs, second mode with its log10 NFA, verdict.
std::vector<std::string> RatioColumns();

/// The cells of one ratio; dashes for what a triplet without candidates has
/// none of.
std::vector<std::string> RatioRow(const ScaleRatio& ratio);

}  // namespace lowlap
