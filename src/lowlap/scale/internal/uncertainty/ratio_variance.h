#pragma once

#include <vector>

#include "lowlap/scale/internal/uncertainty/ratio_refinement.h"

namespace lowlap {

/// Candidates that are taken as wrong beforehand, of each kind.
inline constexpr double kPriorWrong = 0.5;

inline double Square(double value) { return value * value; }

/// Where the expectation maximisation of RefineRatio ends.
struct RatioMixture {
  double log_ratio = 0;
  /// By feature.
  std::vector<double> probability;
  std::vector<double> weight;
  std::vector<double> multiplicity;
  /// By group: phi^2, and the degrees of freedom that it would have if right
  /// and wrong were known and all noise were independent: right features, less
  /// what the mean follows them, with those that count beforehand.
  std::vector<double> noise2;
  std::vector<double> degrees;
};

struct RatioVariance {
  /// Of the interval of 95 %: half its length / 1.96.
  double stddev = 0;
  std::vector<double> information_share;  // by group
};

/// The standard deviation of the log ratio mu of a mixture.
///
/// var = J / H^2 * H / (H - C) * M * F, and Student's t:
///   H = sum w (1 - (1 - p) u), u = r^2 / (phi^2 s^2): the information on mu,
///     less what is missing since right and wrong are not known (Louis 1982);
///   J, the variance of sum w r: H, but of pairs with the noise of every end
///     point of a line counted once, however many pairs the line is part of
///     (Godambe 1960 on estimating equations: var = J / H^2);
///   C, what is lost since the noise and share of right features of each group
///     are not known either (Schur complement of their information);
///   M = 1 + 2 sum h_g (1 - h_g) / n_g, h_g the group's share of H and n_g its
///     degrees of freedom: groups whose noise comes out too small by chance get
///     too much weight (Meier 1953; the other half of his term is C);
///   F: how much the sums w r over cells of the image vary, over how much they
///     should; errors of the two-view step or of the lens are the same for
///     neighbours, and do not fall with the number of features. As if 8 more
///     cells varied as they should.
/// Degrees of freedom: n_g = I_g^2 / (I_g + S_g), with I_g half the information
/// on log phi_g, less what is missing as in H and what the unknown share of
/// wrong features takes, and S_g the sum of the squared correlations of pairs
/// that share a line. F has (8 + m)^2 / m, m the number of cells. Student's t
/// has those of Welch (1947) and Satterthwaite (1946), the relative variances
/// of J and F adding up.
RatioVariance FindRatioVariance(const std::vector<RatioFeature>& features,
                                const std::vector<RatioGroup>& groups,
                                const RatioMixture& mixture);

}  // namespace lowlap
