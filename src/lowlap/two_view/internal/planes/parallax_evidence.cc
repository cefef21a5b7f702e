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

double ParallaxEvidence(const RigidTransform& cam2_from_cam1,
                        const ScenePlane& plane, const PointPairs& pairs,
                        double threshold_px) {
  const TransferResidual displacement(cam2_from_cam1, plane.normal, pairs);
  const SampsonResidual across(cam2_from_cam1, pairs);
  int num_off = 0;
  int num_along = 0;
  double expected = 0;
  for (int i = 0; i < pairs.size(); ++i) {
    const std::optional<Vec2> m = displacement(i);
    if (!m || !(m->norm() > 2 * threshold_px)) continue;
    ++num_off;
    expected += 2 / kPi * std::asin(threshold_px / m->norm());
    if (std::abs(across(i)) <= threshold_px) ++num_along;
  }
  if (num_along <= 2) return 0;
  const double n = num_off;
  return std::log10(n * (n - 1) / 2) +
         Log10Tail(n - 2, (num_along - 2) / (n - 2), expected / n);
}

}  // namespace lowlap
