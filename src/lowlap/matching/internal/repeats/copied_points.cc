#include "lowlap/matching/internal/repeats/copied_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>

#include "lowlap/matching/internal/points/nearest_two.h"
#include "lowlap/matching/internal/repeats/alike_places.h"

namespace lowlap {
namespace {

constexpr double kMaxByChance = 0.05;
constexpr std::size_t kSampleSize = 500;

// Points by where they are: bands of rows, each from left to right.
class PlaceIndex {
 public:
  explicit PlaceIndex(const PointView& view)
      : band_height_(kBandPx / view.features.focal_px) {
    for (std::size_t n = 0; n < view.features.points.size(); ++n) {
      const Vec3& x = view.features.points[n];
      if (x.z() != 0)
        places_.push_back({BandOf(x.y()), x.x(), static_cast<int>(n)});
    }
    std::sort(places_.begin(), places_.end());
  }

  /// Of points that are at most `reach` aside and above or below, and of some
  /// that are a band above or below.
  template <class Visit>
  void ForEachNear(const Vec3& x, double reach, const Visit& visit) const {
    if (places_.empty()) return;
    // Translations lead far out near the vanishing line.
    const double first = std::max(BandOf(x.y() - reach), places_.front().band);
    const double last = std::min(BandOf(x.y() + reach), places_.back().band);
    for (double band = first; band <= last; ++band) {
      auto place = std::lower_bound(places_.begin(), places_.end(),
                                    Place{band, x.x() - reach, 0});
      for (; place != places_.end() && place->band == band &&
             place->x <= x.x() + reach;
           ++place) {
        visit(place->point);
      }
    }
  }

 private:
  static constexpr double kBandPx = 16;

  struct Place {
    double band, x;
    int point;

    bool operator<(const Place& other) const {
      return std::tie(band, x, point) <
             std::tie(other.band, other.x, other.point);
    }
  };

  double BandOf(double y) const { return std::floor(y / band_height_); }

  double band_height_;
  std::vector<Place> places_;
};

class CopySearch {
 public:
  CopySearch(const PointView& view,
             const std::vector<ConjugateTranslation>& translations)
      : view_(view), index_(view), translations_(translations) {
    for (const ConjugateTranslation& translation : translations) {
      translations_.push_back(
          {-translation.vanishing_point, translation.vanishing_line});
    }
    // Points are sorted by place.
    const std::size_t stride =
        std::max<std::size_t>(1, view.descriptors.size() / kSampleSize);
    for (std::size_t n = 0; n < view.descriptors.size(); n += stride) {
      sample_.push_back(static_cast<int>(n));
    }
  }

  bool HasCopy(int point) const {
    std::int32_t least_distance2 = std::numeric_limits<std::int32_t>::max();
    int num_candidates = 0;
    for (const ConjugateTranslation& translation : translations_) {
      const auto place = translation.Map(view_.features.points[point]);
      if (!place) continue;
      const double reach = kMaxScaleFactor * PlaceTolerance(view_, point);
      index_.ForEachNear(*place, reach, [&](int other) {
        if (!IsAt(*place, other) || !MayBeCopies(view_, point, other)) {
          return;
        }
        ++num_candidates;
        least_distance2 = std::min(least_distance2,
                                   SquaredDistance(view_.descriptors[point],
                                                   view_.descriptors[other]));
      });
    }
    return num_candidates > 0 &&
           IsBeyondChance(point, least_distance2, num_candidates);
  }

 private:
  bool IsAt(const Vec3& place, int point) const {
    return (view_.features.points[point] - place).norm() <
           PlaceTolerance(view_, point);
  }

  bool IsBeyondChance(int point, std::int32_t distance2,
                      int num_candidates) const {
    const double most_alike =
        kMaxByChance * static_cast<double>(sample_.size()) / num_candidates;
    int num_alike = 1;  // as if the copy were in the sample
    for (const int other : sample_) {
      if (num_alike >= most_alike) return false;
      if (other == point) continue;
      if (SquaredDistance(view_.descriptors[point], view_.descriptors[other]) <=
          distance2) {
        ++num_alike;
      }
    }
    return num_alike < most_alike;
  }

  const PointView& view_;
  PlaceIndex index_;
  std::vector<ConjugateTranslation> translations_;  // either way
  std::vector<int> sample_;
};

}  // namespace

std::vector<bool> FindCopiedPoints(
    const PointView& view,
    const std::vector<ConjugateTranslation>& translations) {
  std::vector<bool> has_copy(view.features.points.size(), false);
  if (translations.empty()) return has_copy;
  const CopySearch search(view, translations);
  for (std::size_t n = 0; n < has_copy.size(); ++n) {
    has_copy[n] =
        view.features.points[n].z() != 0 && search.HasCopy(static_cast<int>(n));
  }
  return has_copy;
}

}  // namespace lowlap
