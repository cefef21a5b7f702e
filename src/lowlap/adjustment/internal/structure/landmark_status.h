#pragma once

namespace lowlap {

/// What became of a track.
enum class LandmarkStatus {
  kLandmark,
  kTooFewViews,
  kInconsistent,
  kBehindCamera,
  kUncertain,
  kImplausible,
};

}  // namespace lowlap
