#pragma once

#include <cstdint>
#include <ostream>
#include <tuple>

namespace lowlap {

/// OpenMVG's "undefined index".
inline constexpr std::uint32_t kInvalidId = 0xFFFFFFFFu;

/// The id of a thing in the scene file: 32 bit, not necessarily contiguous. Ids
/// of different things are different types; a number becomes an id where one
/// is asked for, and an id a number by value().
template <class Thing>
class Id {
 public:
  constexpr Id() = default;
  constexpr Id(std::uint32_t value) : value_(value) {}  // NOLINT

  constexpr std::uint32_t value() const { return value_; }
  constexpr explicit operator std::uint32_t() const { return value_; }

  Id& operator++() {
    ++value_;
    return *this;
  }

  friend constexpr bool operator==(Id a, Id b) { return a.value_ == b.value_; }
  friend constexpr bool operator!=(Id a, Id b) { return a.value_ != b.value_; }
  friend constexpr bool operator<(Id a, Id b) { return a.value_ < b.value_; }
  friend constexpr bool operator>(Id a, Id b) { return b < a; }
  friend constexpr bool operator<=(Id a, Id b) { return !(b < a); }
  friend constexpr bool operator>=(Id a, Id b) { return !(a < b); }
  friend std::ostream& operator<<(std::ostream& out, Id id) {
    return out << id.value_;
  }
  /// For nlohmann::json.
  template <class Json>
  friend void to_json(Json& json, Id id) {
    json = id.value_;
  }
  template <class Json>
  friend void from_json(const Json& json, Id& id) {
    json.get_to(id.value_);
  }

 private:
  std::uint32_t value_ = kInvalidId;
};

using ViewId = Id<struct ViewTag>;
using IntrinsicId = Id<struct IntrinsicTag>;
using PoseId = Id<struct PoseTag>;
using PointTrackId = Id<struct PointTrackTag>;
using LineTrackId = Id<struct LineTrackTag>;

/// Index of a keypoint or segment within its view.
using FeatureIndex = std::uint32_t;

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
