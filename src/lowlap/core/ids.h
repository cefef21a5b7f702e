#pragma once

#include <cstdint>
#include <tuple>

namespace lowlap {

// Ids are the ones of the scene file: 32 bit, not necessarily contiguous.
using ViewId = std::uint32_t;
using IntrinsicId = std::uint32_t;
using PoseId = std::uint32_t;
using PointTrackId = std::uint32_t;
using LineTrackId = std::uint32_t;

/// Index of a keypoint or segment within its view.
using FeatureIndex = std::uint32_t;

/// OpenMVG's "undefined index".
inline constexpr std::uint32_t kInvalidId = 0xFFFFFFFFu;

/// An ordered pair of views; relative poses are stored with first < second.
struct ViewPair {
  ViewId first = kInvalidId;
  ViewId second = kInvalidId;

  friend bool operator==(const ViewPair& a, const ViewPair& b) {
    return a.first == b.first && a.second == b.second;
  }
  friend bool operator!=(const ViewPair& a, const ViewPair& b) {
    return !(a == b);
  }
  friend bool operator<(const ViewPair& a, const ViewPair& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  }
};

/// Two view pairs that share their middle view.
struct ViewTriplet {
  ViewId first = kInvalidId;
  ViewId middle = kInvalidId;
  ViewId last = kInvalidId;

  friend bool operator==(const ViewTriplet& a, const ViewTriplet& b) {
    return a.first == b.first && a.middle == b.middle && a.last == b.last;
  }
  friend bool operator<(const ViewTriplet& a, const ViewTriplet& b) {
    return std::tie(a.first, a.middle, a.last) <
           std::tie(b.first, b.middle, b.last);
  }
};

/// Indices of the same feature in the first and the second view of a pair.
struct FeatureMatch {
  FeatureIndex first = 0;
  FeatureIndex second = 0;

  friend bool operator==(const FeatureMatch& a, const FeatureMatch& b) {
    return a.first == b.first && a.second == b.second;
  }
  friend bool operator<(const FeatureMatch& a, const FeatureMatch& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  }
};

}  // namespace lowlap
