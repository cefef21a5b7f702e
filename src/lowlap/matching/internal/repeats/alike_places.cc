#include "lowlap/matching/internal/repeats/alike_places.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "lowlap/matching/internal/points/nearest_two.h"

namespace lowlap {
namespace {

constexpr int kColumns = 12;  // parts of the image
constexpr int kRows = 9;
constexpr std::size_t kMaxPartners = 8;
constexpr double kMaxDistanceRatio = 1.5;
/// A place is known to this many scales of its keypoint.
constexpr double kToleranceScales = 1.5;

struct Candidate {
  std::int32_t distance2;
  int partner;  // in `points`

  bool operator<(const Candidate& other) const {
    return std::tie(distance2, partner) <
           std::tie(other.distance2, other.partner);
  }
};

/// Members of `points` by the part of the image that they lie in.
std::vector<std::vector<int>> Parts(const PointView& view,
                                    const std::vector<int>& points) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const int point : points) {
    low = low.cwiseMin(view.features.points[point]);
    high = high.cwiseMax(view.features.points[point]);
  }
  std::vector<std::vector<int>> parts(kColumns * kRows);
  const auto cell = [&](int axis, double value, int count) {
    const double share = (value - low[axis]) / (high[axis] - low[axis]);
    return share > 0 ? std::min(count - 1, static_cast<int>(share * count)) : 0;
  };
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Vec3& x = view.features.points[points[n]];
    parts[cell(1, x.y(), kRows) * kColumns + cell(0, x.x(), kColumns)]
        .push_back(static_cast<int>(n));
  }
  return parts;
}

}  // namespace

bool MayBeCopies(const PointView& view, int first, int second) {
  const Keypoint& a = view.keypoints[first];
  const Keypoint& b = view.keypoints[second];
  const double apart_px =
      (view.features.points[first] - view.features.points[second]).norm() *
      view.features.focal_px;
  const double larger = std::max(a.scale_px, b.scale_px);
  return apart_px > kWindowScales * larger &&
         larger < kMaxScaleFactor * std::min(a.scale_px, b.scale_px);
}

double PlaceTolerance(const PointView& view, int point) {
  return kToleranceScales * view.keypoints[point].scale_px /
         view.features.focal_px;
}

std::vector<AlikePlaces> FindAlikePlaces(const PointView& view,
                                         const std::vector<int>& points) {
  const auto descriptors_of = [&](const std::vector<int>& members) {
    std::vector<PointDescriptor> descriptors;
    descriptors.reserve(members.size());
    for (const int n : members) {
      descriptors.push_back(view.descriptors[points[n]]);
    }
    return descriptors;
  };
  std::vector<PointDescriptor> queries;
  queries.reserve(points.size());
  for (const int point : points) queries.push_back(view.descriptors[point]);
  std::vector<std::vector<Candidate>> candidates(points.size());
  for (const std::vector<int>& part : Parts(view, points)) {
    if (part.empty()) continue;
    const auto nearest = FindNearestTwo(queries, descriptors_of(part));
    for (std::size_t n = 0; n < points.size(); ++n) {
      const int partner = part[nearest[n].index];
      if (MayBeCopies(view, points[n], points[partner])) {
        candidates[n].push_back({nearest[n].distance2, partner});
      }
    }
  }
  std::vector<AlikePlaces> result;
  for (std::size_t n = 0; n < points.size(); ++n) {
    std::vector<Candidate>& nearest = candidates[n];
    std::sort(nearest.begin(), nearest.end());
    nearest.resize(std::min(nearest.size(), kMaxPartners));
    for (const Candidate& candidate : nearest) {
      if (candidate.distance2 >
          kMaxDistanceRatio * kMaxDistanceRatio * nearest[0].distance2) {
        break;
      }
      AlikePlaces places;
      places.first = points[n];
      places.second = points[candidate.partner];
      places.from = view.features.points[places.first];
      places.to = view.features.points[places.second];
      places.tolerance = PlaceTolerance(view, places.second);
      result.push_back(places);
    }
  }
  return result;
}

}  // namespace lowlap
