#include "lowlap/matching/internal/lines/line_transfer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/geometry/plucker_line.h"

namespace lowlap {
namespace {

// Where the viewing rays of a segment's end points meet the plane through the
// other camera and its segment: the end points in space, in the frame of the
// segment's own camera.
struct Ends {
  Vec3 start;
  Vec3 end;
};

// nullopt: behind the camera, or a ray parallel to the plane.
std::optional<Ends> IntersectRays(const NormalizedSegment& segment,
                                  const Vec3& plane, double offset) {
  const double start_depth = offset / plane.dot(segment.start);
  const double end_depth = offset / plane.dot(segment.end);
  if (!(start_depth > 0 && end_depth > 0 && std::isfinite(start_depth) &&
        std::isfinite(end_depth))) {
    return std::nullopt;
  }
  return Ends{start_depth * segment.start, end_depth * segment.end};
}

// `common`: length of the common part in the image of the segment.
double ShareWithSlack(const NormalizedSegment& segment, double common,
                      double epipolar_sine, double slack) {
  const double length = (segment.end - segment.start).norm();
  const double slide = slack > 0 ? slack / epipolar_sine : 0;
  return std::min(1.0, (common + slide) / length);
}

}  // namespace

double EpipolarSine(const NormalizedSegment& segment, const Vec3& epipole) {
  const Vec3 middle = 0.5 * (segment.start + segment.end);
  const Vec2 along = (segment.end - segment.start).head<2>();
  const Vec2 epipolar = epipole.head<2>() - epipole.z() * middle.head<2>();
  const double norms = along.norm() * epipolar.norm();
  if (!(norms > 0)) return 0;
  return std::abs(along.x() * epipolar.y() - along.y() * epipolar.x()) / norms;
}

std::optional<LineTransfer> TransferLine(const NormalizedSegment& first,
                                         const NormalizedSegment& second,
                                         const RigidTransform& cam2_from_cam1,
                                         double min_epipolar_sine,
                                         double epipolar_slack) {
  if (!first.IsValid() || !second.IsValid()) return std::nullopt;
  const RigidTransform cam1_from_cam2 = cam2_from_cam1.Inverse();
  LineTransfer transfer;
  transfer.plane = cam2_from_cam1.rotation.transpose() * second.normal;
  transfer.offset = -second.normal.dot(cam2_from_cam1.translation);
  const auto ends1 = IntersectRays(first, transfer.plane, transfer.offset);
  if (!ends1) return std::nullopt;
  const auto ends2 =
      IntersectRays(second, cam2_from_cam1.rotation * first.normal,
                    -first.normal.dot(cam1_from_cam2.translation));
  if (!ends2) return std::nullopt;
  const double sine1 = EpipolarSine(first, cam1_from_cam2.translation);
  const double sine2 = EpipolarSine(second, cam2_from_cam1.translation);
  if (std::min(sine1, sine2) < min_epipolar_sine) return std::nullopt;
  const auto line =
      LineFromTwoViews(cam2_from_cam1, first.normal, second.normal);
  if (!line) return std::nullopt;

  // The two segments as intervals of the line, in camera 1.
  const double start1 = line->direction.dot(ends1->start);
  const double end1 = line->direction.dot(ends1->end);
  const double start2 = line->direction.dot(cam1_from_cam2 * ends2->start);
  const double end2 = line->direction.dot(cam1_from_cam2 * ends2->end);
  const double low = std::max(std::min(start1, end1), std::min(start2, end2));
  const double high = std::min(std::max(start1, end1), std::max(start2, end2));
  transfer.same_polarity = (start1 < end1) == (start2 < end2);
  // The overlap is a part of both segments, hence in front of both cameras; a
  // gap between them counts as negative.
  const Vec3 a = line->FootPoint() + low * line->direction;
  const Vec3 b = line->FootPoint() + high * line->direction;
  const Vec3 a2 = cam2_from_cam1 * a, b2 = cam2_from_cam1 * b;
  if (!(std::min({a.z(), b.z(), a2.z(), b2.z()}) > 0)) return std::nullopt;
  const double sign = low < high ? 1 : -1;
  const double share1 = ShareWithSlack(
      first, sign * (a / a.z() - b / b.z()).norm(), sine1, epipolar_slack);
  const double share2 = ShareWithSlack(
      second, sign * (a2 / a2.z() - b2 / b2.z()).norm(), sine2, epipolar_slack);
  if (!(std::max(share1, share2) > 0)) return std::nullopt;
  transfer.overlap_of_shorter = std::max(share1, share2);
  transfer.overlap_of_longer = std::max(0.0, std::min(share1, share2));
  return transfer;
}

Status LineFilterOptions::Validate() const {
  return Require({{min_overlap >= 0 && min_overlap <= 1,
                   "min_overlap of lines must lie in [0, 1]"},
                  {min_epipolar_angle_deg >= 0 && min_epipolar_angle_deg < 90,
                   "min_epipolar_angle_deg must lie in [0, 90)"}});
}

std::vector<FeatureMatch> FilterLineMatches(
    const std::vector<FeatureMatch>& matches, const NormalizedFeatures& first,
    const NormalizedFeatures& second, const RigidTransform& cam2_from_cam1,
    const LineFilterOptions& options) {
  const double min_sine = std::sin(RadFromDeg(options.min_epipolar_angle_deg));
  std::vector<FeatureMatch> kept;
  for (const FeatureMatch& match : matches) {
    if (match.first >= first.segments.size() ||
        match.second >= second.segments.size()) {
      continue;
    }
    const auto transfer =
        TransferLine(first.segments[match.first], second.segments[match.second],
                     cam2_from_cam1, min_sine, 0);
    if (transfer && transfer->overlap_of_shorter >= options.min_overlap) {
      kept.push_back(match);
    }
  }
  return kept;
}

}  // namespace lowlap
