#include "lowlap/two_view/internal/evidence/rival_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/points/nearest_two.h"
#include "lowlap/matching/internal/repeats/alike_places.h"
#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxInliers = 256;
constexpr std::size_t kMaxPlaces = 4;
constexpr double kMaxDistanceRatio = 2;
constexpr int kColumns = 8, kRows = 6;  // parts of an image
constexpr double kReach = 2;            // thresholds
constexpr int kNumSamples = 500;
constexpr int kRandomPartners = 10'000;
// Radians. Of less a rotation alone may be the reason.
constexpr double kMinParallax_rad = 0.003;

struct Candidate {
  std::int32_t distance2;
  FeatureIndex point;

  bool operator<(const Candidate& other) const {
    return std::pair(distance2, point) <
           std::pair(other.distance2, other.point);
  }
};

// The points of a view that the image itself shows, by where they are.
class PointsByPart {
 public:
  explicit PointsByPart(const PointView& view)
      : view_(view), parts_(kColumns * kRows) {
    Eigen::AlignedBox2d box;
    for (const Keypoint& keypoint : view.keypoints) {
      box.extend(keypoint.position_px);
    }
    const Vec2 size_px = box.sizes().cwiseMax(1);
    for (std::size_t n = 0; n < view.keypoints.size(); ++n) {
      const Keypoint& keypoint = view.keypoints[n];
      if (keypoint.tilt != 1) continue;
      const Vec2 place =
          (keypoint.position_px - box.min()).cwiseQuotient(size_px);
      const int column =
          std::min(kColumns - 1, static_cast<int>(kColumns * place.x()));
      const int row = std::min(kRows - 1, static_cast<int>(kRows * place.y()));
      Part& part = parts_[row * kColumns + column];
      part.points.push_back(static_cast<FeatureIndex>(n));
      part.descriptors.push_back(view.descriptors[n]);
    }
  }

  // For each query the places of what looks like it. `matches`: its own points.
  std::vector<std::vector<Candidate>> PlacesOf(
      const std::vector<PointDescriptor>& queries,
      const std::vector<FeatureIndex>& matches) const {
    std::vector<std::vector<Candidate>> places(queries.size());
    for (const Part& part : parts_) {
      if (part.points.empty()) continue;
      const auto nearest = FindNearestTwo(queries, part.descriptors);
      for (std::size_t n = 0; n < queries.size(); ++n) {
        const FeatureIndex point = part.points[nearest[n].index];
        const double farthest2 =
            kMaxDistanceRatio * kMaxDistanceRatio *
            SquaredDistance(queries[n], view_.descriptors[matches[n]]);
        if (nearest[n].distance2 <= farthest2 &&
            IsElsewhere(point, matches[n])) {
          places[n].push_back({nearest[n].distance2, point});
        }
      }
    }
    for (std::vector<Candidate>& of_query : places) {
      std::sort(of_query.begin(), of_query.end());
      if (of_query.size() > kMaxPlaces) of_query.resize(kMaxPlaces);
    }
    return places;
  }

 private:
  struct Part {
    std::vector<FeatureIndex> points;
    std::vector<PointDescriptor> descriptors;
  };

  bool IsElsewhere(FeatureIndex point, FeatureIndex match) const {
    const Keypoint &a = view_.keypoints[point], &b = view_.keypoints[match];
    return (a.position_px - b.position_px).norm() >
           kWindowScales * std::max(a.scale_px, b.scale_px);
  }

  const PointView& view_;
  std::vector<Part> parts_;
};

std::vector<FeatureMatch> EvenlySpaced(const std::vector<FeatureMatch>& all) {
  const std::size_t count = std::min(all.size(), kMaxInliers);
  std::vector<FeatureMatch> some;
  some.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    some.push_back(all[n * all.size() / count]);
  }
  return some;
}

// A point of one view and one of the other that looks like it, as unit rays
// about the second camera.
struct Place {
  int point = 0;  // whose place it is, counted from 0
  Vec3 ray1 = Vec3::UnitZ();
  Vec3 ray2 = Vec3::UnitZ();
};

// Of all points of the matches, by point.
class Places {
 public:
  Places(const PointView& first, const PointView& second, const Mat3& rotation)
      : first_(first), second_(second), rotation_(rotation) {}

  std::vector<Place> Find(const std::vector<FeatureMatch>& matches) {
    std::vector<FeatureIndex> points1, points2;
    std::vector<PointDescriptor> descriptors1, descriptors2;
    for (const FeatureMatch& match : matches) {
      points1.push_back(match.first);
      points2.push_back(match.second);
      descriptors1.push_back(first_.descriptors[match.first]);
      descriptors2.push_back(second_.descriptors[match.second]);
    }
    const auto in_second =
        PointsByPart(second_).PlacesOf(descriptors1, points2);
    const auto in_first = PointsByPart(first_).PlacesOf(descriptors2, points1);
    for (std::size_t n = 0; n < matches.size(); ++n) {
      for (const Candidate& place : in_second[n]) {
        Add(points1[n], place.point);
      }
      num_points_ += in_second[n].empty() ? 0 : 1;
      for (const Candidate& place : in_first[n]) Add(place.point, points2[n]);
      num_points_ += in_first[n].empty() ? 0 : 1;
    }
    return std::move(places_);
  }

 private:
  void Add(FeatureIndex point1, FeatureIndex point2) {
    places_.push_back(
        {num_points_, (rotation_ * first_.features.points[point1]).normalized(),
         second_.features.points[point2].normalized()});
  }

  const PointView &first_, &second_;
  const Mat3 rotation_;
  int num_points_ = 0;
  std::vector<Place> places_;
};

// The search for a direction that places bear out, by random samples of them.
class DirectionSearch {
 public:
  DirectionSearch(std::vector<Place> places, double tolerance_rad)
      : places_(std::move(places)), tolerance_rad_(tolerance_rad) {}

  double LeastLog10Nfa() {
    if (places_.size() < 3) return 0;
    Vec3 best = Vec3::UnitZ();
    int most = 2;
    for (int sample = 0; sample < kNumSamples; ++sample) {
      const Place& a = Any();
      const Place& b = Any();
      const Vec3 line = a.ray1.cross(a.ray2).cross(b.ray1.cross(b.ray2));
      if (a.point == b.point || !(line.norm() > 0)) continue;
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 direction = sign * line.normalized();
        // One of the two at most has them in front of both.
        if (!Explains(direction, a.ray1, a.ray2)) continue;
        const int count = NumExplained(direction);
        if (count <= most) continue;
        most = count;
        best = direction;
      }
    }
    return most > 2 ? std::min(0.0, Log10Nfa(best, most)) : 0;
  }

 private:
  const Place& Any() {
    return places_[random_.Index(static_cast<std::uint32_t>(places_.size()))];
  }

  // With depths of depth2 ray2 = depth1 ray1 + direction above zero.
  bool Explains(const Vec3& direction, const Vec3& ray1,
                const Vec3& ray2) const {
    const Vec3 normal = direction.cross(ray1);
    if (std::abs(normal.dot(ray2)) > tolerance_rad_ * normal.norm()) {
      return false;
    }
    const Vec3 across = ray1.cross(ray2);
    return across.norm() > kMinParallax_rad &&
           ray1.cross(direction).dot(across) > 0 &&
           ray2.cross(direction).dot(across) > 0;
  }

  int NumExplained(const Vec3& direction) const {
    int count = 0, last = -1;
    for (const Place& place : places_) {
      if (place.point == last || !Explains(direction, place.ray1, place.ray2)) {
        continue;
      }
      last = place.point;
      ++count;
    }
    return count;
  }

  double Log10Nfa(const Vec3& direction, int k) {
    double hits = 1, drawn = 1;
    for (; drawn < kRandomPartners; ++drawn) {
      // One after the other: arguments are evaluated in any order.
      const Place& place = Any();
      const Place& other = Any();
      hits += Explains(direction, place.ray1, other.ray2) ? 1 : 0;
    }
    const int n = places_.back().point + 1;
    const auto num_places = static_cast<double>(places_.size());
    const double share = std::min(1.0, hits / drawn * num_places / n);
    return 2 * std::log10(num_places) + Log10Binomial(n, k) +
           Log10Binomial(k, 2) + (k - 2) * std::log10(share);
  }

  std::vector<Place> places_;  // by point
  double tolerance_rad_;
  Random random_{0};  // what looks alike is a matter of the photographs alone
};

}  // namespace

double Log10NfaOfRivalMotion(const PointView& first, const PointView& second,
                             const RelativePose& pose,
                             const std::vector<FeatureMatch>& inliers) {
  if (inliers.empty()) return 0;
  const double tolerance_rad =
      kReach * pose.point_threshold_px / second.features.focal_px;
  return DirectionSearch(
             Places(first, second, pose.rotation).Find(EvenlySpaced(inliers)),
             tolerance_rad)
      .LeastLog10Nfa();
}

}  // namespace lowlap
