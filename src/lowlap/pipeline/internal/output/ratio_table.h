#pragma once

#include <string>
#include <vector>

#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

/// A table of scale ratios: the ratio and its 95 % interval, log10 NFA,
/// inliers/candidates of each kind of evidence, percent of the information of
/// each in that order, second mode with its log10 NFA, verdict.
struct RatioTable {
  std::vector<std::string> columns;
  /// Of each ratio; dashes for what a triplet without candidates has none of,
  /// and for kinds that were not asked about it.
  std::vector<std::vector<std::string>> rows;
};

RatioTable MakeRatioTable(const std::vector<ScaleRatio>& ratios);

/// The kinds of evidence that were asked about any of the ratios, in the order
/// in which they first occur.
std::vector<std::string> KindNames(const std::vector<ScaleRatio>& ratios);

}  // namespace lowlap
