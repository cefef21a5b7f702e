#include "lowlap/two_view/internal/planes/parallax_evidence.h"

#include <cmath>
#include <optional>

#include "lowlap/two_view/internal/planes/transfer_residual.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {
namespace {

// log10 of Hoeffding's bound for a mean of at least `share` where p is
// expected, of n.
double Log10Tail(double n, double share, double p) {
  if (!(share > p)) return 0;
  double divergence = share * std::log10(share / p);
  if (share < 1) {
    divergence += (1 - share) * std::log10((1 - share) / (1 - p));
  }
  return -n * divergence;
}

}  // namespace

std::vector<DisplacedMatch> DisplacedMatches(
    const RigidTransform& cam2_from_cam1, const ScenePlane& plane,
    const PointPairs& pairs, double threshold_px) {
  const TransferResidual residual(cam2_from_cam1, plane.normal, pairs);
  std::vector<DisplacedMatch> displaced;
  for (int i = 0; i < pairs.size(); ++i) {
    const std::optional<Vec2> m = residual(i);
    if (!m || !(m->norm() > 2 * threshold_px)) continue;
    displaced.push_back({i, m->norm()});
  }
  return displaced;
}

double ParallaxEvidence(const RigidTransform& cam2_from_cam1,
                        const ScenePlane& plane, const PointPairs& pairs,
                        double threshold_px) {
  const SampsonResidual across(cam2_from_cam1, pairs);
  const std::vector<DisplacedMatch> displaced =
      DisplacedMatches(cam2_from_cam1, plane, pairs, threshold_px);
  int num_along = 0;
  double expected = 0;
  for (const DisplacedMatch& match : displaced) {
    expected += 2 / kPi * std::asin(threshold_px / match.displacement_px);
    if (std::abs(across(match.pair)) <= threshold_px) ++num_along;
  }
  if (num_along <= 2) return 0;
  const auto n = static_cast<double>(displaced.size());
  return std::log10(n * (n - 1) / 2) +
         Log10Tail(n - 2, (num_along - 2) / (n - 2), expected / n);
}

}  // namespace lowlap
