#include "lowlap/matching/internal/repeats/repeated_pattern.h"

#include <algorithm>
#include <limits>

#include "lowlap/matching/internal/repeats/alike_places.h"
#include "lowlap/matching/internal/repeats/copied_points.h"
#include "lowlap/matching/internal/repeats/translation_search.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxPoints = 2000;
constexpr int kMaxTranslations = 30;
/// Of the rays with z = 1 those of the largest scales, ascending.
std::vector<int> LargestPoints(const PointView& view) {
  std::vector<int> points;
  for (std::size_t n = 0; n < view.keypoints.size(); ++n) {
    // What tilted images show besides would count places several times.
    if (view.features.points[n].z() != 0 && view.keypoints[n].tilt == 1) {
      points.push_back(static_cast<int>(n));
    }
  }
  if (points.size() > kMaxPoints) {
    std::stable_sort(points.begin(), points.end(), [&](int a, int b) {
      return view.keypoints[a].scale_px > view.keypoints[b].scale_px;
    });
    points.resize(kMaxPoints);
    std::sort(points.begin(), points.end());
  }
  return points;
}

}  // namespace

RepeatedPattern RepeatedPattern::Find(const PointView& view) {
  RepeatedPattern pattern;
  TranslationSearch search(FindAlikePlaces(view, LargestPoints(view)));
  std::vector<int> repeated;
  for (int n = 0; n < kMaxTranslations; ++n) {
    const auto translation = search.Best();
    if (!translation) break;
    pattern.translations_.push_back(*translation);
    const std::vector<AlikePlaces> explained = search.Explained(*translation);
    for (const AlikePlaces& places : explained) {
      repeated.insert(repeated.end(), {places.first, places.second});
    }
    search.Remove(explained);
  }
  std::sort(repeated.begin(), repeated.end());
  repeated.erase(std::unique(repeated.begin(), repeated.end()), repeated.end());
  pattern.focal_px_ = view.features.focal_px;
  for (const int point : repeated) {
    pattern.members_.push_back(
        {pattern.focal_px_ * view.features.points[point].hnormalized(),
         view.keypoints[point].scale_px});
  }
  pattern.has_point_ = FindCopiedPoints(view, pattern.translations_);
  for (std::size_t n = 0; n < view.keypoints.size(); ++n) {
    const Vec3& x = view.features.points[n];
    if (x.z() == 0 || pattern.has_point_[n]) continue;
    pattern.has_point_[n] = pattern.Covers(x, view.keypoints[n].scale_px);
  }
  return pattern;
}

bool RepeatedPattern::Covers(const Vec3& x, double scale_px) const {
  const Vec2 place_px = focal_px_ * x.hnormalized();
  return std::any_of(members_.begin(), members_.end(),
                     [&](const Member& member) {
                       const double window_px =
                           kWindowScales * std::min(scale_px, member.scale_px);
                       return (place_px - member.place_px).squaredNorm() <
                              window_px * window_px;
                     });
}

bool RepeatedPattern::HasSegment(const NormalizedSegment& segment) const {
  // Its ends have no window of their own.
  constexpr double kScalePx = std::numeric_limits<double>::infinity();
  return segment.IsValid() && Covers(segment.start, kScalePx) &&
         Covers(segment.end, kScalePx);
}

bool RepeatedPattern::AreCopies(const Vec3& x, const Vec3& other,
                                double tolerance_px) const {
  const double tolerance = tolerance_px / focal_px_;
  for (ConjugateTranslation translation : translations_) {
    const Vec3 step = translation.vanishing_point;
    for (const int times : {1, -1, 2, -2, 3, -3}) {
      translation.vanishing_point = times * step;
      const auto copy = translation.Map(x);
      if (copy && (*copy - other).norm() < tolerance) return true;
    }
  }
  return false;
}

}  // namespace lowlap
