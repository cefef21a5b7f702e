#pragma once

#include <optional>

#include "lowlap/geometry/types.h"
#include "lowlap/scene/relative_pose.h"

namespace lowlap {

/// The covariance of `after`, a refined `before`, where it states in no
/// direction less than that of `before` did: for a refinement that does not
/// know what has made that one so large (SpreadOfRivals, the one plane of
/// TwoViewResult). With U diag(l) U^T = L^-1 C L^-T, C that of `before`, its
/// axes turned with the direction, and L L^T that of `after`, it is
///   L U diag(max(l, 1)) U^T L^T.
/// Where only one pose has a covariance, that is it.
std::optional<Eigen::Matrix<double, 5, 5>> KeptCovariance(
    const RelativePose& before, const RelativePose& after);

}  // namespace lowlap
