#pragma once

namespace lowlap::internal {

/// What became of a track.
enum class Fate {
  kLandmark,
  kTooFewViews,
  kInconsistent,
  kBehindCamera,
  kUncertain,
  kImplausible,
};

}  // namespace lowlap::internal
