#include "lowlap/matching/internal/repeats/repeated_pattern.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <optional>

#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/repeats/alike_places.h"
#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxPoints = 2000;
constexpr int kMaxTranslations = 30;
constexpr int kSamples = 1000;  // for each translation
/// Of the alike places, in random order, so many judge a sample first, and so
/// many what is refined on them.
constexpr std::size_t kProbe = 1000;
constexpr std::size_t kScored = 4000;
/// Points are along a line if they spread across it by less than this share.
constexpr double kThin = 0.03;
/// Places with a partner drawn at random, for the share of chance.
constexpr int kRandomPartners = 5000;

/// Of the rays with z = 1 those of the largest scales, ascending.
std::vector<int> LargestPoints(const PointView& view) {
  std::vector<int> points;
  for (std::size_t n = 0; n < view.keypoints.size(); ++n) {
    if (view.features.points[n].z() != 0) points.push_back(static_cast<int>(n));
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

bool IsThin(const std::vector<Vec2>& places) {
  Vec2 mean = Vec2::Zero();
  for (const Vec2& place : places) mean += place;
  mean /= static_cast<double>(places.size());
  Mat2 scatter = Mat2::Zero();
  for (const Vec2& place : places) {
    scatter += (place - mean) * (place - mean).transpose();
  }
  const Vec2 squared =
      Eigen::SelfAdjointEigenSolver<Mat2>(scatter).eigenvalues();
  return squared[0] < kThin * kThin * squared[1];
}

class TranslationSearch {
 public:
  TranslationSearch(std::vector<AlikePlaces> places, Random* random)
      : places_(std::move(places)), random_(*random) {
    Shuffle();
  }

  /// The translation of least NFA; nullopt: none is meaningful.
  std::optional<ConjugateTranslation> Best() {
    std::optional<ConjugateTranslation> best;
    double least_log10_nfa = 0, most = 0, most_of_probe = 0;
    for (int n = 0; n < kSamples && places_.size() > 2; ++n) {
      const auto translation = Sample();
      if (!translation) continue;
      const auto sharper = Refined(*translation, kProbe, {8, 4, 2});
      if (!sharper || 2 * Excess(*sharper, kProbe) < most_of_probe) continue;
      const auto refined = Refined(*sharper, kScored, {2, 1});
      if (!refined) continue;
      const double excess = Excess(*refined, kScored);
      if (!(excess > most)) continue;
      const double log10_nfa = Log10Nfa(*refined);
      if (!(log10_nfa < least_log10_nfa)) continue;
      least_log10_nfa = log10_nfa;
      most = excess;
      most_of_probe = Excess(*refined, kProbe);
      best = refined;
    }
    if (best) lines_.push_back(best->vanishing_line);
    return best;
  }

  /// The places that agree, one of each point.
  std::vector<AlikePlaces> Explained(
      const ConjugateTranslation& translation) const {
    std::vector<AlikePlaces> result;
    for (const AlikePlaces& places : places_) {
      if (translation.Explains(places)) result.push_back(places);
    }
    std::sort(result.begin(), result.end(),
              [](const AlikePlaces& a, const AlikePlaces& b) {
                return a.first != b.first ? a.first < b.first
                                          : a.second < b.second;
              });
    result.erase(std::unique(result.begin(), result.end(),
                             [](const AlikePlaces& a, const AlikePlaces& b) {
                               return a.first == b.first;
                             }),
                 result.end());
    return result;
  }

  /// Leaves out all places of the points of `explained` (ascending).
  void Remove(const std::vector<AlikePlaces>& explained) {
    places_.erase(
        std::remove_if(places_.begin(), places_.end(),
                       [&](const AlikePlaces& places) {
                         return std::binary_search(
                             explained.begin(), explained.end(), places,
                             [](const AlikePlaces& a, const AlikePlaces& b) {
                               return a.first < b.first;
                             });
                       }),
        places_.end());
  }

 private:
  void Shuffle() {
    for (std::size_t n = places_.size(); n > 1; --n) {
      std::swap(places_[n - 1],
                places_[random_.Index(static_cast<std::uint32_t>(n))]);
    }
  }

  const AlikePlaces& Any() {
    return places_[random_.Index(static_cast<std::uint32_t>(places_.size()))];
  }

  // Of two neighbours of about the same step, as a pattern has them; or, where
  // planes are known, of one place on one of them.
  std::optional<ConjugateTranslation> Sample() {
    constexpr int kTrials = 400;
    const AlikePlaces& a = Any();
    if (!lines_.empty() && random_.Index(2) == 0) {
      const auto n = random_.Index(static_cast<std::uint32_t>(lines_.size()));
      return ConjugateTranslation::FromOne(a, lines_[n]);
    }
    const Vec3 step = a.to - a.from;
    for (int trial = 0; trial < kTrials; ++trial) {
      const AlikePlaces& b = Any();
      const double apart = (b.from - a.from).norm();
      if (b.first != a.first && b.second != a.second && b.first != a.second &&
          apart > 0.3 * step.norm() && apart < 2 * step.norm() &&
          (b.to - b.from - step).norm() < 0.25 * step.norm()) {
        return ConjugateTranslation::FromTwo(a, b);
      }
    }
    return std::nullopt;
  }

  std::optional<ConjugateTranslation> Refined(
      ConjugateTranslation translation, std::size_t most,
      std::initializer_list<double> tolerance_factors) const {
    for (const double factor : tolerance_factors) {
      const auto refined = translation.Refined(places_, most, factor);
      if (!refined) return std::nullopt;
      translation = *refined;
    }
    return translation;
  }

  /// `places` with the partner of others.
  static AlikePlaces WithPartnerOf(AlikePlaces places,
                                   const AlikePlaces& others) {
    places.to = others.to;
    places.tolerance = others.tolerance;
    return places;
  }

  // By how many deviations more of the first `most` places agree than do with
  // the partner of the next: where points crowd, many agree by chance.
  double Excess(const ConjugateTranslation& translation,
                std::size_t most) const {
    int count = 0, by_chance = 0;
    for (std::size_t n = 0; n < std::min(most, places_.size()); ++n) {
      const AlikePlaces& next = places_[(n + 1) % places_.size()];
      count += translation.Explains(places_[n]) ? 1 : 0;
      by_chance +=
          translation.Explains(WithPartnerOf(places_[n], next)) ? 1 : 0;
    }
    return (count - by_chance) / std::sqrt(by_chance + 1.0);
  }

  double Log10Nfa(const ConjugateTranslation& translation) {
    double hits = 1, drawn = 1;
    for (; drawn < kRandomPartners; ++drawn) {
      hits += translation.Explains(WithPartnerOf(Any(), Any())) ? 1 : 0;
    }
    std::vector<int> points;
    for (const AlikePlaces& places : places_) points.push_back(places.first);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const int n = static_cast<int>(points.size());
    const int k = static_cast<int>(Explained(translation).size());
    if (k <= 2) return HUGE_VAL;
    const auto num_places = static_cast<double>(places_.size());
    const double share = std::min(1.0, hits / drawn * num_places / n);
    return 2 * std::log10(num_places) + Log10Binomial(n, k) +
           Log10Binomial(k, 2) + (k - 2) * std::log10(share);
  }

  std::vector<AlikePlaces> places_;  // in random order
  std::vector<Vec3> lines_;          // vanishing lines of what was found
  Random& random_;
};

}  // namespace

RepeatedPattern RepeatedPattern::Find(const PointView& view) {
  RepeatedPattern pattern;
  Random random(0);  // what repeats is a matter of the photograph alone
  TranslationSearch search(FindAlikePlaces(view, LargestPoints(view)), &random);
  std::vector<int> repeated;
  for (int n = 0; n < kMaxTranslations; ++n) {
    const auto translation = search.Best();
    if (!translation) break;
    const std::vector<AlikePlaces> explained = search.Explained(*translation);
    std::vector<Vec2> images;
    for (const AlikePlaces& places : explained) {
      images.push_back(places.from.hnormalized());
    }
    if (!IsThin(images)) {
      for (const AlikePlaces& places : explained) {
        repeated.insert(repeated.end(), {places.first, places.second});
      }
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
  for (std::size_t n = 0; n < view.keypoints.size(); ++n) {
    const Vec3& x = view.features.points[n];
    pattern.has_point_.push_back(x.z() != 0 &&
                                 pattern.Covers(x, view.keypoints[n].scale_px));
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

}  // namespace lowlap
