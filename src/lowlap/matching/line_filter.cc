#include "lowlap/matching/line_filter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lowlap/geometry/plucker_line.h"

namespace lowlap {
namespace {

// Sine of the angle in the image between a segment and the epipolar line of
// its midpoint. `epipole` is the other camera's centre, homogeneous.
double EpipolarSine(const NormalizedSegment& segment, const Vec3& epipole) {
  const Vec3 middle = 0.5 * (segment.start + segment.end);
  const Vec2 along = (segment.end - segment.start).head<2>();
  const Vec2 epipolar = epipole.head<2>() - epipole.z() * middle.head<2>();
  const double norms = along.norm() * epipolar.norm();
  if (!(norms > 0)) return 0;
  return std::abs(along.x() * epipolar.y() - along.y() * epipolar.x()) / norms;
}

// Where the viewing rays of a segment's end points meet the plane through the
// other camera and its segment: the end points in space, in the frame of the
// segment's own camera. nullopt: behind that camera, or a ray parallel to the
// plane. `to_other` maps this frame into the other camera's.
struct Ends {
  Vec3 start;
  Vec3 end;
};

std::optional<Ends> IntersectRays(const NormalizedSegment& segment,
                                  const RigidTransform& to_other,
                                  const Vec3& other_normal) {
  const Vec3 plane = to_other.rotation.transpose() * other_normal;
  const double offset = other_normal.dot(to_other.translation);
  const double start_depth = -offset / plane.dot(segment.start);
  const double end_depth = -offset / plane.dot(segment.end);
  if (!(start_depth > 0 && end_depth > 0 && std::isfinite(start_depth) &&
        std::isfinite(end_depth))) {
    return std::nullopt;
  }
  return Ends{start_depth * segment.start, end_depth * segment.end};
}

// Share of the segment's length in its image that lies between two points of
// space, given in the segment's camera and in front of it.
double ImageShare(const NormalizedSegment& segment, const Vec3& a,
                  const Vec3& b) {
  const double length = (segment.end - segment.start).norm();
  return (a / a.z() - b / b.z()).norm() / length;
}

bool IsPlausible(const NormalizedSegment& first,
                 const NormalizedSegment& second,
                 const RigidTransform& cam2_from_cam1,
                 const LineFilterOptions& options) {
  if (!first.IsValid() || !second.IsValid()) return false;
  const RigidTransform cam1_from_cam2 = cam2_from_cam1.Inverse();
  const double min_sine = std::sin(RadFromDeg(options.min_epipolar_angle_deg));
  if (EpipolarSine(first, cam1_from_cam2.translation) < min_sine ||
      EpipolarSine(second, cam2_from_cam1.translation) < min_sine) {
    return false;
  }
  const auto line =
      LineFromTwoViews(cam2_from_cam1, first.normal, second.normal);
  const auto ends1 = IntersectRays(first, cam2_from_cam1, second.normal);
  const auto ends2 = IntersectRays(second, cam1_from_cam2, first.normal);
  if (!line || !ends1 || !ends2) return false;

  // The two segments as intervals of the line, in camera 1.
  const auto interval = [&](const Vec3& a, const Vec3& b) {
    const double pa = line->direction.dot(a), pb = line->direction.dot(b);
    return std::minmax({pa, pb});
  };
  const auto [low1, high1] = interval(ends1->start, ends1->end);
  const auto [low2, high2] =
      interval(cam1_from_cam2 * ends2->start, cam1_from_cam2 * ends2->end);
  const double low = std::max(low1, low2);
  const double high = std::min(high1, high2);
  if (!(low < high)) return false;
  // The overlap is a part of both segments, hence in front of both cameras.
  const Vec3 a = line->FootPoint() + low * line->direction;
  const Vec3 b = line->FootPoint() + high * line->direction;
  const double share =
      std::max(ImageShare(first, a, b),
               ImageShare(second, cam2_from_cam1 * a, cam2_from_cam1 * b));
  return share >= options.min_overlap;
}

}  // namespace

Status LineFilterOptions::Validate() const {
  if (!(min_overlap >= 0 && min_overlap <= 1)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "min_overlap of lines must lie in [0, 1]");
  }
  if (!(min_epipolar_angle_deg >= 0 && min_epipolar_angle_deg < 90)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "min_epipolar_angle_deg must lie in [0, 90)");
  }
  return {};
}

std::vector<FeatureMatch> FilterLineMatches(
    const std::vector<FeatureMatch>& matches, const NormalizedFeatures& first,
    const NormalizedFeatures& second, const RigidTransform& cam2_from_cam1,
    const LineFilterOptions& options) {
  std::vector<FeatureMatch> kept;
  for (const FeatureMatch& match : matches) {
    if (match.first < first.segments.size() &&
        match.second < second.segments.size() &&
        IsPlausible(first.segments[match.first], second.segments[match.second],
                    cam2_from_cam1, options)) {
      kept.push_back(match);
    }
  }
  return kept;
}

}  // namespace lowlap
