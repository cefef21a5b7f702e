#pragma once

#include <cstdint>
#include <map>

#include "lowlap/features/internal/features.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// The features of a simulated scene with descriptors, as if they were those of
/// photographs. Every place has an appearance of its own, drawn at random, or
/// that of a place that looks the same (SyntheticScene::alike_points), half
/// turned. It changes with the direction that it is seen from:
///
///   value = base + gradient . direction + noise,
///
/// each value of a descriptor with a base and a gradient of its own, which is
/// small for some places and large for others. A point descriptor has their
/// sizes, a line descriptor their signs. A share 1 - `found_share` of the
/// features look like nothing else. There must
/// be no wrong tracks, and no more than one of a place.
std::map<ViewId, DetectedFeatures> DescribeFeatures(
    const SyntheticScene& synthetic, double found_share, std::uint64_t seed);

}  // namespace lowlap
