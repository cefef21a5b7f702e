#pragma once

#include <string_view>

#include "lowlap/core/internal/hash.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/matching.h"

namespace lowlap {

/// A hash of everything that the features of an image depend on: the bytes of
/// its file, the options, the versions of the algorithms, and the intrinsic
/// where lines are detected on undistorted support.
Hash128::Value FeatureKey(std::string_view image_bytes,
                          const Intrinsic* intrinsic,
                          const FeatureOptions& options);

/// The same of the matches of a pair, from the keys of its features.
Hash128::Value MatchKey(const Hash128::Value& first,
                        const Hash128::Value& second,
                        const MatchOptions& options);

}  // namespace lowlap
