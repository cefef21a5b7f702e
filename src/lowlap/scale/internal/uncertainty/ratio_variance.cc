#include "lowlap/scale/internal/uncertainty/ratio_variance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace lowlap {
namespace {

// The share of the information that is left at least, however unsure the
// features.
constexpr double kLeastKept = 0.25;

// The 97.5 % quantile of Student's t over that of the normal distribution
// (Abramowitz and Stegun 26.7.5).
double StudentFactor(double degrees) {
  constexpr double kLeast = 2.0;
  constexpr double kZ2 = 1.959964 * 1.959964;
  const double n = std::max(degrees, kLeast);
  return 1 + (kZ2 + 1) / (4 * n) + ((5 * kZ2 + 16) * kZ2 + 3) / (96 * n * n) +
         (((3 * kZ2 + 19) * kZ2 + 17) * kZ2 - 15) / (384 * n * n * n);
}

// (r / (phi s))^2.
double SquaredDeviation(const RatioFeature& feature, double log_ratio,
                        double noise2) {
  return Square((feature.log_ratio - log_ratio) / feature.log_ratio_stddev) /
         noise2;
}

// By feature, how fast its part of the sum w r falls with mu; they add up to H.
std::vector<double> Slopes(const std::vector<RatioFeature>& features,
                           const RatioMixture& mixture) {
  std::vector<double> slopes;
  slopes.reserve(features.size());
  for (std::size_t n = 0; n < features.size(); ++n) {
    const double u = SquaredDeviation(features[n], mixture.log_ratio,
                                      mixture.noise2[features[n].group]);
    slopes.push_back(mixture.weight[n] *
                     (1 - (1 - mixture.probability[n]) * u));
  }
  return slopes;
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
  std::vector<int> pairs;

  void Add(const RatioFeature& feature, double log_ratio, double noise2,
           double p, double multiplicity) {
    const double u = SquaredDeviation(feature, log_ratio, noise2);
    const double score = (feature.log_ratio - log_ratio) /
                         (noise2 * Square(feature.log_ratio_stddev));
    const double unsure = p * (1 - p);
    count += 1;
    wrong += 1 - p;
    mu_phi += score * (2 * p - unsure * (u - 1)) / multiplicity;
    mu_odds += score * unsure / multiplicity;
    phi_phi += 2 * p * u - unsure * Square(u - 1);
    phi_odds += unsure * (u - 1);
    odds_odds -= unsure;
  }

  void AddPriors(double prior_count, double noise2) {
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

  // Half the information on log phi, the share of wrong features unknown. A
  // variance with n degrees of freedom has n / 2 on its logarithm, so 2 n on
  // that of its root. At most `if_sure`, that of features known to be right.
  double Degrees(double if_sure) const {
    double information_on_phi = phi_phi;
    if (odds_odds > 1e-9 * phi_phi) {
      information_on_phi -= Square(phi_odds) / odds_odds;
    }
    return std::clamp(0.5 * information_on_phi, kLeastKept * if_sure, if_sure);
  }
};

using Moves = std::array<double, 4>;

// Calls visit(begin, end) for the pairs of every line of one side, `pairs`
// being sorted by it.
template <class Visit>
void VisitUnits(const std::vector<RatioFeature>& features, int side,
                std::vector<int>* pairs, const Visit& visit) {
  const auto unit_of = [&](int n) { return features[n].units[side]; };
  std::stable_sort(pairs->begin(), pairs->end(),
                   [&](int a, int b) { return unit_of(a) < unit_of(b); });
  for (auto begin = pairs->begin(), end = begin; begin != pairs->end();
       begin = end) {
    while (end != pairs->end() && unit_of(*end) == unit_of(*begin)) ++end;
    visit(begin, end);
  }
}

// The variance of the sum of w r over pairs, counting the noise of a line once.
// That of one pair is its slope / m (the information identity); two that share
// a line covary by the product of their slopes and of what its noise does to
// them (to first order in the correlation, Price 1958).
double PairVariance(const std::vector<RatioFeature>& features,
                    std::vector<int> pairs, const RatioMixture& mixture,
                    const std::vector<double>& slopes) {
  double variance = 0;
  for (const int n : pairs) {
    variance += slopes[n] / mixture.multiplicity[n] -
                Square(slopes[n] * features[n].log_ratio_stddev) *
                    mixture.noise2[features[n].group];
  }
  for (const int side : {0, 1}) {
    VisitUnits(features, side, &pairs, [&](auto begin, auto end) {
      Moves sum{};
      for (; begin != end; ++begin) {
        const RatioFeature& pair = features[*begin];
        const Moves& moves = pair.moves[side];
        const double scale =
            slopes[*begin] * std::sqrt(mixture.noise2[pair.group]);
        for (std::size_t m = 0; m < sum.size(); ++m) sum[m] += scale * moves[m];
      }
      for (const double move : sum) variance += move * move;
    });
  }
  return std::max(variance, 0.0);
}

// The sum of p p' rho^2 over right pairs that share a line, rho the correlation
// of their noise: that of its squares is rho^2.
double SharedSquares(const std::vector<RatioFeature>& features,
                     std::vector<int> pairs, const RatioMixture& mixture) {
  double shared = 0;
  for (const int side : {0, 1}) {
    VisitUnits(features, side, &pairs, [&](auto begin, auto end) {
      // The squared norm of the sum of p a a^T, a the moves in standard
      // deviations of the pair, without what every pair has with itself.
      std::array<Moves, 4> sum{};
      for (; begin != end; ++begin) {
        const RatioFeature& pair = features[*begin];
        const Moves& moves = pair.moves[side];
        const double scale =
            mixture.probability[*begin] / Square(pair.log_ratio_stddev);
        double own = 0;
        for (std::size_t k = 0; k < sum.size(); ++k) {
          own += scale * moves[k] * moves[k];
          for (std::size_t m = 0; m < sum.size(); ++m) {
            sum[k][m] += scale * moves[k] * moves[m];
          }
        }
        shared -= own * own;
      }
      for (const Moves& row : sum) {
        for (const double value : row) shared += value * value;
      }
    });
  }
  return std::max(shared, 0.0);
}

struct CellSpread {
  double factor = 1;
  double relative_variance = 0;  // of the factor, over 2
};

// How much the sums over cells vary over how much they should.
CellSpread FindCellSpread(const std::vector<RatioFeature>& features,
                          const RatioMixture& mixture,
                          const std::vector<double>& slopes,
                          double information) {
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
      cell.variance += slopes[n];
    }
  }
  double observed = 0, expected = 0, expected2 = 0;
  for (const auto& [number, cell] : cells) {
    // The mean follows the cell.
    const double variance =
        (cell.variance + PairVariance(features, cell.pairs, mixture, slopes)) *
        std::max(0.0, 1 - cell.weight / information);
    observed += cell.sum * cell.sum;
    expected += variance;
    expected2 += variance * variance;
  }
  if (!(expected > 0)) return {};
  const double num_cells = std::max(0.0, Square(expected) / expected2 - 1);
  return {(kPriorCells + num_cells * observed / expected) /
              (kPriorCells + num_cells),
          num_cells / Square(kPriorCells + num_cells)};
}

}  // namespace

RatioVariance FindRatioVariance(const std::vector<RatioFeature>& features,
                                const std::vector<RatioGroup>& groups,
                                const RatioMixture& mixture) {
  const std::size_t num_groups = groups.size();
  const std::vector<double> slopes = Slopes(features, mixture);
  std::vector<GroupSums> sums(num_groups);
  for (std::size_t n = 0; n < features.size(); ++n) {
    const int group = features[n].group;
    sums[group].Add(features[n], mixture.log_ratio, mixture.noise2[group],
                    mixture.probability[n], mixture.multiplicity[n]);
    sums[group].curvature += slopes[n];
    sums[group].information += mixture.weight[n];
    if (features[n].IsPair()) {
      sums[group].pairs.push_back(static_cast<int>(n));
    }
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
    double of_group = sums[g].curvature;
    double degrees = sums[g].Degrees(mixture.degrees[g]);
    if (!sums[g].pairs.empty()) {
      of_group =
          std::max(PairVariance(features, sums[g].pairs, mixture, slopes),
                   kLeastKept * of_group);
      degrees *=
          degrees / (degrees + SharedSquares(features, sums[g].pairs, mixture));
    }
    const double share = sums[g].curvature / curvature;
    variance += of_group;
    spread += Square(of_group) / degrees;
    meier += 2 * share * (1 - share) / degrees;
    result.information_share[g] = share;
  }
  const double kept =
      std::max(curvature - lost, kLeastKept * curvature) / curvature;
  const CellSpread cells =
      FindCellSpread(features, mixture, slopes, information);
  const double degrees =
      1 / (spread / Square(variance) + cells.relative_variance);
  result.stddev = StudentFactor(degrees) *
                  std::sqrt(variance * meier / kept * cells.factor) / curvature;
  return result;
}

}  // namespace lowlap
