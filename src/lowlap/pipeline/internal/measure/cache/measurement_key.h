#pragma once

#include <string_view>

#include "lowlap/core/internal/hash.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/features/internal/points/tilted_points.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/matching/internal/points/tilted_matching.h"

namespace lowlap {

/// A hash of everything that the features of an image depend on: the bytes of
/// its file, the options, the versions of the algorithms, and the intrinsic
/// where lines are detected on undistorted support.
Hash128::Value FeatureKey(std::string_view image_bytes,
                          const Intrinsic* intrinsic,
                          const FeatureOptions& options);

/// The same of the points of its tilted images, from the key of its features.
Hash128::Value TiltedKey(const Hash128::Value& features,
                         const TiltOptions& options);

/// The same of the matches of a pair, from the keys of its features.
Hash128::Value MatchKey(const Hash128::Value& first,
                        const Hash128::Value& second,
                        const MatchOptions& options);

/// The same of a pair's matches of tilted points, from the keys of these points
/// and of its other matches.
Hash128::Value TiltedMatchKey(const Hash128::Value& first,
                              const Hash128::Value& second,
                              const Hash128::Value& matches,
                              const TiltedPointOptions& options);

}  // namespace lowlap
