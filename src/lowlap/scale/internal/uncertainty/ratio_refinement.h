#pragma once

#include <array>
#include <vector>

namespace lowlap {

/// One feature's log ratio, for the refinement.
struct RatioFeature {
  double log_ratio = 0;
  double log_ratio_stddev = 0;
  /// Features of one group share the unknown size of their noise and the
  /// density of wrong ones.
  int group = 0;
  /// Where in the image it is; features of one cell may err together.
  int cell = 0;
  /// Of a pair: which units it joins (counted from 0 on either side), and how
  /// their noise moves the log ratio, see CandidateDetail.
  std::array<int, 2> units = {-1, -1};
  std::array<std::array<double, 4>, 2> moves{};

  bool IsPair() const { return units[0] >= 0; }
};

/// What is known of a group beforehand.
struct RatioGroup {
  /// All features of the group, those that are far from the ratio included, and
  /// the sum of their standard deviations.
  int count = 0;
  double sum_of_stddevs = 0;
  /// Where the iteration starts: the noise in units of the features' standard
  /// deviations.
  double noise = 1;
  /// How many features a noise of 1 counts as, beforehand; small where the unit
  /// of the standard deviations is nominal.
  double prior_count = 2;
};

struct RefinedRatio {
  double log_ratio = 0;
  /// log_ratio +- 1.96 of them is an interval of 95 %.
  double log_ratio_stddev = 0;
  /// By feature: the probability of being right, and the weight in the mean.
  std::vector<double> probability;
  std::vector<double> weight;
  /// By group: phi, 1 where it is unknown, and the share of the information.
  std::vector<double> group_noise;
  std::vector<double> information_share;
};

/// How far from the ratio a feature may be, in units of its group's initial
/// noise and its standard deviation, to take part.
inline constexpr double kRefinementReach = 6.0;

/// The most likely log ratio mu of a mixture: a feature of group g is right,
/// with the density N(mu, phi_g^2 s^2), or wrong, with a density that is even
/// within reach. By expectation maximisation over mu, phi_g, and the density
/// and number of wrong features (half a wrong one is there beforehand), from
/// `initial`. Of `features`, those within kRefinementReach of it. No feature is
/// cut off, so that nothing makes the noise look smaller than it is; a group
/// without any close to `initial` starts as if half of one were right.
///
/// A right feature has the weight p / (phi_g^2 s^2 m) in the mean, p its
/// probability; m = 1 but for pairs, which share the noise of their units: the
/// mean of the numbers of right pairs of the two units, so that n_a units all
/// paired with n_b others count as the harmonic mean of n_a and n_b.
/// The standard deviation is that of ratio_variance.h.
/// Without features: `initial`, with an infinite standard deviation.
RefinedRatio RefineRatio(const std::vector<RatioFeature>& features,
                         const std::vector<RatioGroup>& groups, double initial);

}  // namespace lowlap
