#pragma once

#include <vector>

namespace lowlap {

/// One inlier's log ratio, for the refinement.
struct RatioInlier {
  double log_ratio = 0;
  double log_ratio_stddev = 0;
  /// Inliers of one group share the unknown size of their noise.
  int group = 0;
  /// How many inliers repeat the same measurement (a line occurs in several
  /// pairs); the weight is divided by it.
  double multiplicity = 1;
  /// Where in the image it is; inliers of one cell may err together.
  int cell = 0;
};

struct RefinedRatio {
  double log_ratio = 0;
  double log_ratio_stddev = 0;
  /// phi of every group, 1 where it is unknown.
  std::vector<double> group_noise;
};

/// The robust weighted mean of the inliers' log ratios: to first order the
/// least squares solution of their pixel residuals in log tau.
///
/// IRLS from `initial` with the weights of Cauchy's loss,
///   w = c / (phi_g^2 s^2 m),  c = 1 / (1 + (r / (kCauchy phi_g s))^2),
/// where s is the inlier's standard deviation, m its multiplicity, and phi_g
/// the noise of its group in units of s, estimated from the median of |r| / s
/// and drawn towards 1 as if by two more inliers. The variance is
/// 1 / sum w, which for normal residuals is some 10 % on the safe side, or that
/// of the sums over cells, sum over cells (sum w r)^2 / (sum w)^2, if it is
/// larger: errors of the two-view step or of the lens are the same for
/// neighbours, and do not fall with the number of features.
/// Without inliers: `initial`, with an infinite standard deviation.
RefinedRatio RefineRatio(const std::vector<RatioInlier>& inliers,
                         double initial);

}  // namespace lowlap
