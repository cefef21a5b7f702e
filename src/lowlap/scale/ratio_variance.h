#pragma once

#include <vector>

#include "lowlap/scale/ratio_refinement.h"

namespace lowlap {

/// Where the expectation maximisation of RefineRatio ends.
struct RatioMixture {
  double log_ratio = 0;
  /// By feature.
  std::vector<double> probability;
  std::vector<double> weight;
  std::vector<double> multiplicity;
  /// By group: phi^2, and its degrees of freedom: right features, less the
  /// group's share of the mean, with those that count beforehand.
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
///     point of a line counted once, however many pairs the line is part of;
///   C, what is lost since the noise and share of right features of each group
///     are not known either (Schur complement of their information);
///   M = 1 + 2 sum h_g (1 - h_g) / n_g, h_g the group's share of H and n_g its
///     degrees of freedom: groups whose noise comes out too small by chance get
///     too much weight (Meier 1953; the other half of his term is C);
///   F: how much the sums w r over cells of the image vary, over how much they
///     should; errors of the two-view step or of the lens are the same for
///     neighbours, and do not fall with the number of features. As if 8 more
///     cells varied as they should.
/// Student's t has the degrees of freedom of Welch (1947) and Satterthwaite.
RatioVariance FindRatioVariance(const std::vector<RatioFeature>& features,
                                const std::vector<RatioGroup>& groups,
                                const RatioMixture& mixture);

}  // namespace lowlap
