#include "lowlap/matching/internal/points/guided_point_matching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/matching/internal/points/nearest_two.h"

namespace lowlap {
namespace {

// Least sine of the angle between a viewing ray and the baseline.
constexpr double kMinSine = 0.0175;

// A point in polar coordinates about the baseline, whose axis is the same in
// both cameras: rays that meet have the same longitude, and the one of the
// second camera lies nearer to the axis, cam2_from_cam1.translation.
struct PolarPoint {
  double longitude = 0;
  double colatitude = 0;
  double sine = 0;      // of the colatitude
  double log_size = 0;  // of the blob in space, up to one constant
  double turn = 0;      // of the orientation from the direction of the axis
  FeatureIndex index = 0;
};

struct PointCandidate {
  FeatureIndex first;
  FeatureIndex second;
  std::int32_t distance2;
};

// The view's points by longitude, without those that have none. `axes` has
// the baseline as its third row.
std::vector<PolarPoint> ToPolar(const PointView& view, const Mat3& axes) {
  const Vec3 axis = axes.row(2);
  std::vector<PolarPoint> points;
  points.reserve(view.keypoints.size());
  for (std::size_t i = 0; i < view.keypoints.size(); ++i) {
    const Vec3& x = view.features.points[i];
    if (x.z() == 0 || view.keypoints[i].tilt > 1) continue;
    const Vec3 ray = axes * x.normalized();
    PolarPoint point;
    point.sine = ray.head<2>().norm();
    if (point.sine < kMinSine) continue;
    point.longitude = std::atan2(ray.y(), ray.x());
    point.colatitude = std::atan2(point.sine, ray.z());
    // A unit of angle covers 1 / cos^1.5 units of the image plane, in the mean
    // of the two directions.
    const Keypoint& keypoint = view.keypoints[i];
    point.log_size = std::log(keypoint.scale_px / view.features.focal_px) -
                     1.5 * std::log(x.norm()) - std::log(point.sine);
    const Vec2 towards = axis.head<2>() - axis.z() * x.head<2>();
    point.turn = keypoint.angle_rad - std::atan2(towards.y(), towards.x());
    point.index = static_cast<FeatureIndex>(i);
    points.push_back(point);
  }
  std::sort(points.begin(), points.end(),
            [](const PolarPoint& a, const PolarPoint& b) {
              return a.longitude != b.longitude ? a.longitude < b.longitude
                                                : a.index < b.index;
            });
  return points;
}

// Orthonormal rows, the last along `axis`.
Mat3 AxesAlong(const Vec3& axis) {
  Mat3 axes;
  axes.row(2) = axis.normalized();
  axes.row(0) = axes.row(2).transpose().unitOrthogonal();
  axes.row(1) = axes.row(2).cross(axes.row(0));
  return axes;
}

bool LooksConsistent(const PolarPoint& a, const PolarPoint& b,
                     double max_log_factor, double max_turn_rad) {
  return std::abs(a.log_size - b.log_size) <= max_log_factor &&
         std::abs(std::remainder(a.turn - b.turn, 2 * kPi)) <= max_turn_rad;
}

// All pairs within the band of the epipolar constraint and in front of both
// cameras that agree in size and orientation, with their distances.
std::vector<PointCandidate> FindCandidates(const PointView& first,
                                           const PointView& second,
                                           const RigidTransform& cam2_from_cam1,
                                           double threshold_px,
                                           const GuidedPointOptions& options) {
  std::vector<PointCandidate> candidates;
  if (!(cam2_from_cam1.translation.norm() > 0)) return candidates;
  const Mat3 axes = AxesAlong(cam2_from_cam1.translation);
  const std::vector<PolarPoint> from =
      ToPolar(first, axes * cam2_from_cam1.rotation);
  const std::vector<PolarPoint> to = ToPolar(second, axes);
  if (to.empty()) return candidates;
  double min_sine = 1;
  for (const PolarPoint& point : to) min_sine = std::min(min_sine, point.sine);
  std::vector<PointDescriptor> descriptors;
  descriptors.reserve(to.size());
  for (const PolarPoint& point : to) {
    descriptors.push_back(second.descriptors[point.index]);
  }

  const Mat3 essential = EssentialFromPose(cam2_from_cam1);
  const double focal1 = first.features.focal_px;
  const double focal2 = second.features.focal_px;
  const double at_infinity =
      std::hypot(threshold_px / focal1, threshold_px / focal2);
  const double max_log_factor = std::log(options.max_scale_factor);
  const double max_turn_rad = RadFromDeg(options.max_turn_deg);
  for (const PolarPoint& a : from) {
    const Vec3& x1 = first.features.points[a.index];
    const Vec3 line = essential * x1;
    const double line_variance = (line.head<2>() / focal2).squaredNorm();
    // No pixel spans more than 1 / focal of angle, which moves the longitude
    // the more the nearer it is to the axis.
    const double reach = std::hypot(threshold_px / (focal1 * a.sine),
                                    threshold_px / (focal2 * min_sine));
    double start = a.longitude - reach;
    if (start < -kPi) start += 2 * kPi;
    auto at = static_cast<std::size_t>(
        std::lower_bound(to.begin(), to.end(), start,
                         [](const PolarPoint& point, double longitude) {
                           return point.longitude < longitude;
                         }) -
        to.begin());
    // Once round at most: longitudes are those of a circle. The slack is for
    // rounding where the window starts.
    for (std::size_t step = 0; step < to.size(); ++step, ++at) {
      if (at >= to.size()) at = 0;
      const PolarPoint& b = to[at];
      if (std::abs(std::remainder(b.longitude - a.longitude, 2 * kPi)) >
          reach + 1e-9) {
        break;
      }
      if (b.colatitude > a.colatitude + at_infinity ||
          !LooksConsistent(a, b, max_log_factor, max_turn_rad)) {
        continue;
      }
      const Vec3& x2 = second.features.points[b.index];
      const double error = line.dot(x2);
      const double variance =
          line_variance +
          ((essential.transpose() * x2).head<2>() / focal1).squaredNorm();
      if (error * error > threshold_px * threshold_px * variance) continue;
      candidates.push_back(
          {a.index, b.index,
           SquaredDistance(first.descriptors[a.index], descriptors[at])});
    }
  }
  return candidates;
}

// The nearest candidate of every point, and the distance of the next one that
// is not the same blob once more.
struct Nearest {
  FeatureIndex index = kInvalidId;
  std::int32_t distance2 = NearestTwo::kNone;
  std::int32_t next_distance2 = NearestTwo::kNone;
};

template <class OwnIndex, class OtherIndex>
std::vector<Nearest> FindNearest(const std::vector<PointCandidate>& candidates,
                                 std::size_t count,
                                 const std::vector<Keypoint>& others,
                                 OwnIndex own, OtherIndex other) {
  std::vector<Nearest> nearest(count);
  for (const PointCandidate& c : candidates) {
    Nearest& n = nearest[own(c)];
    if (c.distance2 < n.distance2 ||
        (c.distance2 == n.distance2 && other(c) < n.index)) {
      n.index = other(c);
      n.distance2 = c.distance2;
    }
  }
  for (const PointCandidate& c : candidates) {
    Nearest& n = nearest[own(c)];
    if (c.distance2 >= n.next_distance2) continue;
    const Keypoint& best = others[n.index];
    const Keypoint& here = others[other(c)];
    if ((best.position_px - here.position_px).norm() >
        std::max(best.scale_px, here.scale_px)) {
      n.next_distance2 = c.distance2;
    }
  }
  return nearest;
}

bool PassesGuidedRatio(std::int32_t distance2, std::int32_t next_distance2,
                       double max_ratio) {
  return next_distance2 == NearestTwo::kNone ||
         distance2 < max_ratio * max_ratio * next_distance2;
}

// The matches whose first point is nearer to the second than to a sample of
// the other points of the second's image. Points are sorted by position: every
// n-th is an even sample.
std::vector<FeatureMatch> BetterThanChance(
    const std::vector<FeatureMatch>& matches,
    const std::vector<PointDescriptor>& first,
    const std::vector<PointDescriptor>& second, bool swapped,
    const GuidedPointOptions& options) {
  const std::vector<PointDescriptor>& own = swapped ? second : first;
  const std::vector<PointDescriptor>& others = swapped ? first : second;
  const std::size_t stride = std::max<std::size_t>(
      1, others.size() / static_cast<std::size_t>(options.chance_points));
  std::vector<PointDescriptor> sample, queries;
  for (std::size_t i = 0; i < others.size(); i += stride) {
    sample.push_back(others[i]);
  }
  for (const FeatureMatch& match : matches) {
    queries.push_back(own[swapped ? match.second : match.first]);
  }
  const std::vector<NearestTwo> nearest = FindNearestTwo(queries, sample);
  std::vector<FeatureMatch> kept;
  for (std::size_t m = 0; m < matches.size(); ++m) {
    const FeatureIndex partner = swapped ? matches[m].first : matches[m].second;
    const std::int32_t distance2 = SquaredDistance(queries[m], others[partner]);
    // The sample may hold the partner itself.
    const bool itself =
        nearest[m].index >= 0 && nearest[m].index * stride == partner;
    if (PassesGuidedRatio(
            distance2,
            itself ? nearest[m].second_distance2 : nearest[m].distance2,
            options.max_ratio)) {
      kept.push_back(matches[m]);
    }
  }
  return kept;
}

}  // namespace

Status GuidedPointOptions::Validate() const {
  return Require({{max_ratio > 0 && max_ratio <= 1,
                   "max_ratio of guided points must lie in (0, 1]"},
                  {chance_points >= 1, "chance_points must be at least 1"},
                  {max_scale_factor >= 1 && std::isfinite(max_scale_factor),
                   "max_scale_factor must be at least 1"},
                  {max_turn_deg > 0 && max_turn_deg <= 180,
                   "max_turn_deg must lie in (0, 180]"}});
}

std::vector<FeatureMatch> MatchPointsGuided(
    const PointView& first, const PointView& second,
    const RigidTransform& cam2_from_cam1, double threshold_px,
    const GuidedPointOptions& options) {
  const std::vector<PointCandidate> candidates =
      FindCandidates(first, second, cam2_from_cam1, threshold_px, options);
  const auto first_index = [](const PointCandidate& c) { return c.first; };
  const auto second_index = [](const PointCandidate& c) { return c.second; };
  const std::vector<Nearest> forward =
      FindNearest(candidates, first.descriptors.size(), second.keypoints,
                  first_index, second_index);
  const std::vector<Nearest> backward =
      FindNearest(candidates, second.descriptors.size(), first.keypoints,
                  second_index, first_index);
  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < forward.size(); ++i) {
    const Nearest& n = forward[i];
    if (n.index == kInvalidId || backward[n.index].index != i) continue;
    if (PassesGuidedRatio(n.distance2, n.next_distance2, options.max_ratio) &&
        PassesGuidedRatio(n.distance2, backward[n.index].next_distance2,
                          options.max_ratio)) {
      matches.push_back({static_cast<FeatureIndex>(i), n.index});
    }
  }
  for (const bool swapped : {false, true}) {
    matches = BetterThanChance(matches, first.descriptors, second.descriptors,
                               swapped, options);
  }
  return matches;
}

}  // namespace lowlap
