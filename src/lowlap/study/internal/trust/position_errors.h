#pragma once

#include <map>

#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A camera that is further off than this share of the scene's size is wrong.
inline constexpr double kWrongCamera = 0.2;
/// One that is no further off than this is good.
inline constexpr double kGoodCamera = kFirmReach;

/// Where solved cameras are, in shares of the size of the truth.
struct PositionErrors {
  double size = 0;  // the greatest distance of two cameras of the truth
  std::map<ViewId, double> error;  // of the views with a solved pose
  /// One unit of the solved world, in shares of the size; 0 if nothing aligns.
  double unit = 0;
};

/// Errors after the similarity of least sum of errors, none of which counts for
/// more than `wrong`. Moving cameras that are exact, to share the errors of
/// fewer others, lessens the sum of squares, but not the sum of errors, even if
/// it brings more cameras within `wrong`. The rotations tried are those of
/// single cameras, scale and translation those of two, of at most 30 cameras,
/// evenly spaced. The errors are infinite if no two of these have different
/// places.
PositionErrors RobustPositionErrors(const Scene& scene,
                                    const GroundTruth& truth, double wrong);

}  // namespace lowlap
