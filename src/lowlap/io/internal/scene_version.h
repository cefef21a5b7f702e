#pragma once

#include <cstdint>

namespace lowlap {

/// The version of the scene format that is written, as JSON and as binary, and
/// the oldest that is read. Version 7 did not say which pairs were compared in
/// vain, version 6 not what repeats, version 5 had
/// no weaknesses of relative poses, version 4 no covariances of centres,
/// version 3 no given intrinsics, version 2 no second modes and shares of
/// information either.
inline constexpr std::uint32_t kSceneVersion = 8;
inline constexpr std::uint32_t kOldestSceneVersion = 2;
/// Scale ratios had members for three fixed kinds of evidence before this one.
inline constexpr std::uint32_t kFirstVersionWithKinds = 4;

}  // namespace lowlap
