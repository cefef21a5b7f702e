#pragma once

namespace lowlap::internal {

/// What became of a track.
enum class LandmarkStatus {
  kLandmark,
  kTooFewViews,
  kInconsistent,
  kBehindCamera,
  kUncertain,
  kImplausible,
};

}  // namespace lowlap::internal
