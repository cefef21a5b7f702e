#include "lowlap/matching/internal/repeats/translation_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr int kSamples = 1000;  // for each translation
/// Of the alike places, in random order, so many judge a sample first, and so
/// many what is refined on them.
constexpr std::size_t kProbe = 1000;
constexpr std::size_t kScored = 4000;
/// Places with a partner drawn at random, for the share of chance.
constexpr int kRandomPartners = 5000;

// `places` with the partner of others.
AlikePlaces WithPartnerOf(AlikePlaces places, const AlikePlaces& others) {
  places.to = others.to;
  places.tolerance = others.tolerance;
  return places;
}

}  // namespace

TranslationSearch::TranslationSearch(std::vector<AlikePlaces> places)
    : places_(std::move(places)) {
  for (std::size_t n = places_.size(); n > 1; --n) {
    std::swap(places_[n - 1],
              places_[random_.Index(static_cast<std::uint32_t>(n))]);
  }
}

std::optional<ConjugateTranslation> TranslationSearch::Best() {
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

std::vector<AlikePlaces> TranslationSearch::Explained(
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

void TranslationSearch::Remove(const std::vector<AlikePlaces>& explained) {
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

const AlikePlaces& TranslationSearch::Any() {
  return places_[random_.Index(static_cast<std::uint32_t>(places_.size()))];
}

// Of two neighbours of about the same step, as a pattern has them; or, where
// planes are known, of one place on one of them.
std::optional<ConjugateTranslation> TranslationSearch::Sample() {
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

std::optional<ConjugateTranslation> TranslationSearch::Refined(
    ConjugateTranslation translation, std::size_t most,
    std::initializer_list<double> tolerance_factors) const {
  for (const double factor : tolerance_factors) {
    const auto refined = translation.Refined(places_, most, factor);
    if (!refined) return std::nullopt;
    translation = *refined;
  }
  return translation;
}

// By how many deviations more of the first `most` places agree than do with
// the partner of the next: where points crowd, many agree by chance.
double TranslationSearch::Excess(const ConjugateTranslation& translation,
                                 std::size_t most) const {
  int count = 0, by_chance = 0;
  for (std::size_t n = 0; n < std::min(most, places_.size()); ++n) {
    const AlikePlaces& next = places_[(n + 1) % places_.size()];
    count += translation.Explains(places_[n]) ? 1 : 0;
    by_chance += translation.Explains(WithPartnerOf(places_[n], next)) ? 1 : 0;
  }
  return (count - by_chance) / std::sqrt(by_chance + 1.0);
}

double TranslationSearch::Log10Nfa(const ConjugateTranslation& translation) {
  double hits = 1, drawn = 1;
  for (; drawn < kRandomPartners; ++drawn) {
    // One after the other: arguments are evaluated in any order.
    const AlikePlaces& others = Any();
    const AlikePlaces& places = Any();
    hits += translation.Explains(WithPartnerOf(places, others)) ? 1 : 0;
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

}  // namespace lowlap
