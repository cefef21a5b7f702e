#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/core/internal/random.h"

namespace lowlap {

/// What a track must satisfy to become a landmark.
struct TriangulationLimits {
  double threshold_px = std::numeric_limits<double>::infinity();
  /// Of one coordinate of a point, or of an end point's distance from a line;
  /// for the uncertainty.
  double noise_px = 1;
  double max_relative_depth_stddev = 0.3;
  double min_two_view_overlap = 0.2;  // of lines
};

/// The candidates that agree with a landmark.
struct Agreement {
  std::vector<char> used;
  int count = 0;
  double squares = 0;

  /// Two segments fit their line exactly: what rounding leaves decides nothing.
  bool BetterThan(const Agreement& other) const {
    constexpr double kRounding = 1e-9;
    return count != other.count ? count > other.count
                                : squares + kRounding < other.squares;
  }
};

/// Pairs (a < b) of `count` observations: all up to ten observations, else 45
/// of them drawn with a generator of the track's own, so that the result does
/// not depend on the order in which tracks are worked on.
inline std::vector<std::pair<std::size_t, std::size_t>> SamplePairs(
    std::size_t count, std::uint32_t track_id) {
  constexpr std::size_t kMaxPairs = 45;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (count * (count - 1) / 2 <= kMaxPairs) {
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) pairs.emplace_back(a, b);
    }
    return pairs;
  }
  Random random(0, track_id);
  std::set<std::pair<std::size_t, std::size_t>> drawn;
  while (drawn.size() < kMaxPairs) {
    std::size_t a = random.Index(static_cast<std::uint32_t>(count));
    std::size_t b = random.Index(static_cast<std::uint32_t>(count));
    if (a == b) continue;
    if (a > b) std::swap(a, b);
    drawn.emplace(a, b);
  }
  pairs.assign(drawn.begin(), drawn.end());
  return pairs;
}

/// The landmark of the pair of candidates that most others agree with, refined
/// on all that agree; nullopt if no two do. A Model knows the candidates of one
/// track:
///   struct Place;
///   static constexpr bool kAllEndSearch;  a landmark that all agree with does
///   std::size_t size() const;
///   std::optional<Place> FromPair(std::size_t a, std::size_t b);
///   std::optional<Place> Refine(const std::vector<char>& used,
///                                  const Place&) const;
///   double ErrorPx(std::size_t candidate, const Place&) const;
template <class Model>
std::optional<typename Model::Place> FitLandmark(std::uint32_t track_id,
                                                 double threshold_px,
                                                 Model* model,
                                                 Agreement* best) {
  using Place = typename Model::Place;
  const auto agree_on = [&](const Place& landmark) {
    Agreement agreement;
    for (std::size_t n = 0; n < model->size(); ++n) {
      const double error = model->ErrorPx(n, landmark);
      const bool agrees = error <= threshold_px && error != kInfinity;
      agreement.used.push_back(agrees);
      if (!agrees) continue;
      ++agreement.count;
      agreement.squares += error * error;
    }
    return agreement;
  };
  std::optional<Place> landmark;
  for (const auto& [a, b] : SamplePairs(model->size(), track_id)) {
    const std::optional<Place> of_pair = model->FromPair(a, b);
    if (!of_pair) continue;
    Agreement agreement = agree_on(*of_pair);
    if (agreement.count < 2 || !agreement.BetterThan(*best)) continue;
    *best = std::move(agreement);
    landmark = of_pair;
    if (Model::kAllEndSearch &&
        best->count == static_cast<int>(model->size())) {
      break;
    }
  }
  if (!landmark) return std::nullopt;
  // Refining on all that agree lets others agree, or some not.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const std::optional<Place> refined = model->Refine(best->used, *landmark);
    if (!refined) break;
    Agreement next = agree_on(*refined);
    if (next.count < 2 || best->BetterThan(next)) break;
    const bool settled = next.used == best->used;
    landmark = refined;
    *best = std::move(next);
    if (settled) break;
  }
  return landmark;
}

}  // namespace lowlap
