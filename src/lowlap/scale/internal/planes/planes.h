#pragma once

#include <utility>
#include <vector>

#include "lowlap/scale/internal/planes/plane_samples.h"

namespace lowlap {

/// A plane seen by a pair, in the frame of the middle camera at unit baseline:
/// the points X with p . X = 1, so that a ray x (z = 1) of the middle view
/// meets it at the inverse depth rho(x) = p . x.
struct PairPlane {
  Vec3 parameters = Vec3::Zero();      // p
  Mat3 covariance = Mat3::Identity();  // of p
  std::vector<int> samples;            // indices of its inliers, sorted
  std::vector<Vec2> hull;              // convex, of their rays; its extent
  double threshold_px = 0;             // of its inliers
  double log10_nfa = 0;

  double InverseDepth(const Vec3& ray) const { return parameters.dot(ray); }
  double Stddev(const Vec3& ray) const;
};

/// The planes of a pair are found on at most so many samples.
inline constexpr std::size_t kMaxPlaneSamples = 500;

struct PairPlanes {
  /// At most kMaxPlaneSamples of those given (evenly spaced), from left to
  /// right in the middle view; those of one place and depth once.
  std::vector<DepthSample> samples;
  std::vector<PairPlane> planes;
  std::vector<int> plane_of_sample;  // kNoPlane: on none

  /// The features of all samples, sorted: (is_line, feature).
  std::vector<std::pair<bool, FeatureIndex>> matched;

  static constexpr int kNoPlane = -1;

  /// Whether the pair matches the feature of a sample of another pair.
  bool Matches(const DepthSample& sample) const;

  /// The plane in whose extent a ray of the middle view lies: inside the convex
  /// hull of its inliers, and three of the four nearest samples are on it, so
  /// that what stands in front of a wall is not taken for it. kNoPlane if there
  /// is none.
  int PlaneAt(const Vec3& ray) const;
};

/// The planes of a pair, one after the other, each grown from the seed whose
/// surroundings fit a plane best, over samples that are neighbours in the
/// middle view.
///
/// A sample's residual is |rho - p . x| times its speed: the distance, in
/// pixels of the neighbour, from the transfer through the plane's homography
/// R + t p^T to the observation. A plane with k inliers among the m samples of
/// its surroundings (inliers and their neighbours) at threshold e has
///   NFA = N T C(m - 3, k - 3) alpha(e)^(k - 3),  alpha = 2 e / D,
/// N the number of seeds, T that of thresholds, D the largest disparity (in
/// pixels, 95th percentile of rho times speed): under the background law a
/// sample's depth is any, from infinity to the nearest. Planes with NFA < 1
/// are kept. p is the robust least squares fit to the inliers (Cauchy), and
/// its covariance is scaled by their residuals where these are larger than
/// their stated deviations.
PairPlanes FindPlanes(std::vector<DepthSample> samples);

}  // namespace lowlap
