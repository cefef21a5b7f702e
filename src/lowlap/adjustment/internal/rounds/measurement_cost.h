#pragma once

#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// How well the cameras explain what more than two views show: the sum over all
/// candidates of the tracks that have more than two, in use or not,
///   sum k min(e^2, t^2) / s^2,
/// with the errors e at the landmark that is best for the track, the noise
/// level s and the threshold t of its kind; k is 1 for points and 2 for lines,
/// whose errors are means over two ends. Each track is triangulated anew,
/// however well its landmark is determined; one without a landmark keeps one
/// candidate that would fit any. Two sets of cameras can be compared by it at
/// the same noise and shapes of points (`point_shape_exponent`, WhitenPoints),
/// whatever each had in use.
///
/// Tracks of two views are not asked: they were chosen by a relative pose, and
/// bear out its errors. But cameras that have left a relative pose altogether,
/// which they began with (IsKept), have lost what may be all that holds one
/// part of them to the other: the points that its two views alone see cost t^2
/// / s^2 each, less as much for each that fits all the same, if these are
/// fewer.
///
/// Error: kCancelled.
Result<double> MeasurementCost(const CameraSet& cameras,
                               const StructureState& state,
                               const NoiseLevels& noise,
                               double point_shape_exponent,
                               const RunContext& context);

}  // namespace lowlap
