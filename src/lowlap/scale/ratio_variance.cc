#include "lowlap/scale/ratio_variance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace lowlap {
namespace {

// The share of the information that is left at least, however unsure the
// features.
constexpr double kLeastKept = 0.25;

double Square(double value) { return value * value; }

// The 97.5 % quantile of Student's t over that of the normal distribution
// (Abramowitz and Stegun 26.7.5).
double StudentFactor(double degrees) {
  constexpr double kLeast = 2.0;
  constexpr double z2 = 1.959964 * 1.959964;
  const double n = std::max(degrees, kLeast);
  return 1 + (z2 + 1) / (4 * n) + ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
         (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n);
}

// Sums over the features of a group; scores are derivatives of the log
// likelihood of one feature if it is right.
struct GroupSums {
  double curvature = 0;    // H
  double information = 0;  // the sum of the weights
  double count = 0;
  double wrong = 0;
  // Information between mu, log phi, and the log odds of being wrong.
  double mu_phi = 0, mu_odds = 0, phi_phi = 0, phi_odds = 0, odds_odds = 0;

  void Add(const RatioFeature& feature, double log_ratio, double noise2,
           double p, double multiplicity) {
    const double variance = noise2 * Square(feature.log_ratio_stddev);
    const double residual = feature.log_ratio - log_ratio;
    const double u = residual * residual / variance;
    const double share = 1 / multiplicity;
    const double score = residual / variance;
    const double unsure = p * (1 - p);
    curvature += share * (p - unsure * u) / variance;
    information += share * p / variance;
    count += share;
    wrong += share * (1 - p);
    mu_phi += share * score * (2 * p - unsure * (u - 1));
    mu_odds += share * score * unsure;
    phi_phi += share * (2 * p * u - unsure * Square(u - 1));
    phi_odds += share * unsure * (u - 1);
    odds_odds -= share * unsure;
  }

  void AddPriors(double prior_count, double noise2) {
    constexpr double kPriorWrong = 0.5;
    if (!(count > 0)) return;
    phi_phi += 2 * prior_count / noise2;
    odds_odds += (wrong + kPriorWrong) * (count - wrong) / count;
    curvature = std::max(curvature, kLeastKept * information);
  }

  // The Schur complement's part.
  double Lost() const {
    if (!(phi_phi > 0)) return 0;
    const double determinant = phi_phi * odds_odds - Square(phi_odds);
    if (!(determinant > 1e-9 * Square(phi_phi))) {
      return Square(mu_phi) / phi_phi;
    }
    return (Square(mu_phi) * odds_odds - 2 * mu_phi * mu_odds * phi_odds +
            Square(mu_odds) * phi_phi) /
           determinant;
  }
};

using Moves = std::array<double, 4>;

// The variance of the sum of w r over pairs, counting the noise of a line once.
double PairVariance(const std::vector<RatioFeature>& features,
                    const std::vector<int>& pairs,
                    const RatioMixture& mixture) {
  // What the noise of a line does, by first and last lines.
  std::vector<std::pair<int, Moves>> moves;
  moves.reserve(pairs.size());
  double variance = 0;
  for (const bool is_first : {true, false}) {
    moves.clear();
    for (const int n : pairs) {
      const RatioFeature& pair = features[n];
      Moves of_pair = is_first ? pair.by_first : pair.by_last;
      const double scale =
          mixture.weight[n] * std::sqrt(mixture.noise2[pair.group]);
      for (double& move : of_pair) move *= scale;
      moves.emplace_back(is_first ? pair.first_line : pair.last_line, of_pair);
    }
    std::stable_sort(
        moves.begin(), moves.end(),
        [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t begin = 0, end = 0; begin < moves.size(); begin = end) {
      Moves sum{};
      for (; end < moves.size() && moves[end].first == moves[begin].first;
           ++end) {
        for (std::size_t m = 0; m < sum.size(); ++m) {
          sum[m] += moves[end].second[m];
        }
      }
      for (const double move : sum) variance += move * move;
    }
  }
  return variance;
}

// That of a group's pairs over what independent ones of the same weights would
// give; 1 for other features.
double LineFactor(const std::vector<RatioFeature>& features,
                  const RatioMixture& mixture, int group) {
  std::vector<int> pairs;
  double sum_of_weights = 0;
  for (std::size_t n = 0; n < features.size(); ++n) {
    if (features[n].group != group || !features[n].IsPair()) continue;
    pairs.push_back(static_cast<int>(n));
    sum_of_weights += mixture.weight[n];
  }
  return sum_of_weights > 0
             ? PairVariance(features, pairs, mixture) / sum_of_weights
             : 1.0;
}

// How much the sums over cells vary over how much they should.
double CellFactor(const std::vector<RatioFeature>& features,
                  const RatioMixture& mixture, double information) {
  constexpr double kPriorCells = 8.0;
  struct Cell {
    double sum = 0;
    double variance = 0;
    double weight = 0;
    std::vector<int> pairs;
  };
  std::map<int, Cell> cells;
  for (std::size_t n = 0; n < features.size(); ++n) {
    Cell& cell = cells[features[n].cell];
    const double weight = mixture.weight[n];
    cell.sum += weight * (features[n].log_ratio - mixture.log_ratio);
    cell.weight += weight;
    if (features[n].IsPair()) {
      cell.pairs.push_back(static_cast<int>(n));
    } else {
      cell.variance += weight;
    }
  }
  double observed = 0, expected = 0, expected2 = 0;
  for (const auto& [number, cell] : cells) {
    // The mean follows the cell.
    const double variance =
        (cell.variance + PairVariance(features, cell.pairs, mixture)) *
        std::max(0.0, 1 - cell.weight / information);
    observed += cell.sum * cell.sum;
    expected += variance;
    expected2 += variance * variance;
  }
  if (!(expected > 0)) return 1.0;
  const double num_cells = std::max(0.0, Square(expected) / expected2 - 1);
  return (kPriorCells + num_cells * observed / expected) /
         (kPriorCells + num_cells);
}

}  // namespace

RatioVariance FindRatioVariance(const std::vector<RatioFeature>& features,
                                const std::vector<RatioGroup>& groups,
                                const RatioMixture& mixture) {
  const std::size_t num_groups = groups.size();
  std::vector<GroupSums> sums(num_groups);
  for (std::size_t n = 0; n < features.size(); ++n) {
    const int group = features[n].group;
    sums[group].Add(features[n], mixture.log_ratio, mixture.noise2[group],
                    mixture.probability[n], mixture.multiplicity[n]);
  }
  double curvature = 0, information = 0, lost = 0;
  for (std::size_t g = 0; g < num_groups; ++g) {
    sums[g].AddPriors(groups[g].prior_count, mixture.noise2[g]);
    curvature += sums[g].curvature;
    information += sums[g].information;
    lost += sums[g].Lost();
  }
  RatioVariance result;
  result.information_share.assign(num_groups, 0.0);
  if (!(information > 0)) {
    result.stddev = std::numeric_limits<double>::infinity();
    return result;
  }
  // The variance of the score, the sum of its parts squared over their degrees
  // of freedom, and Meier's factor.
  double variance = 0, spread = 0, meier = 1;
  for (std::size_t g = 0; g < num_groups; ++g) {
    if (!(sums[g].curvature > 0)) continue;
    const double of_group =
        sums[g].curvature * LineFactor(features, mixture, static_cast<int>(g));
    const double share = sums[g].curvature / curvature;
    variance += of_group;
    spread += Square(of_group) / mixture.degrees[g];
    meier += 2 * share * (1 - share) / mixture.degrees[g];
    result.information_share[g] = share;
  }
  const double kept =
      std::max(curvature - lost, kLeastKept * curvature) / curvature;
  result.stddev = StudentFactor(Square(variance) / spread) *
                  std::sqrt(variance * meier / kept *
                            CellFactor(features, mixture, information)) /
                  curvature;
  return result;
}

}  // namespace lowlap
