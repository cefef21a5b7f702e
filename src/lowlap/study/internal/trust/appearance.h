#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "lowlap/features/internal/features.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// How much of a place looks the same in the views that see it.
struct LikenessOptions {
  /// Of the features; the others look like nothing else.
  double found_share = 1;
  /// Of the places that look different in the views of `second_session`: on
  /// another day, or to another camera.
  double changed_share = 0;
  std::vector<ViewId> second_session;
};

/// The features of a simulated scene with descriptors, as if they were those of
/// photographs. Every place has an appearance of its own, drawn at random, or
/// that of a place that looks the same (SyntheticScene::alike_points), turned
/// with it. It changes with the direction that it is seen from:
///
///   value = base + gradient . direction + noise,
///
/// each value of a descriptor with a base and a gradient of its own, which is
/// small for some places and large for others. A point descriptor has their
/// sizes, a line descriptor their signs. There must be no wrong tracks, and no
/// more than one of a place.
std::map<ViewId, DetectedFeatures> DescribeFeatures(
    const SyntheticScene& synthetic, const LikenessOptions& likeness,
    std::uint64_t seed);

}  // namespace lowlap
