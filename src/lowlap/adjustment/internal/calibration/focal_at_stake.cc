#include "lowlap/adjustment/internal/calibration/focal_at_stake.h"

#include <algorithm>
#include <cmath>

#include "lowlap/adjustment/internal/calibration/calibration_score.h"

namespace lowlap {
namespace {

constexpr double kMaxChange = 0.5;

}  // namespace

std::vector<double> FocalFactorsAtStake(const AdjustmentOptions& options,
                                        const NoiseLevels& noise,
                                        const Scene& scene,
                                        const CameraSet& cameras,
                                        const StructureState& state) {
  std::vector<double> factors(cameras.intrinsics.size(), 1);
  const auto score = ScoreCalibration(options, noise, scene, cameras, state);
  if (!score) return factors;
  for (const HeldPart& part : score->parts) {
    if (part.part != &IntrinsicRefinement::focal) continue;
    const double statistic = score->Statistic({part.first}, {});
    if (!(statistic > 1)) continue;
    const double change =
        std::sqrt(1 - 1 / statistic) * score->Change({part.first})(part.first);
    for (const int intrinsic : score->groups[part.group].intrinsics) {
      factors[intrinsic] = 1 + std::clamp(change, -kMaxChange, kMaxChange);
    }
  }
  return factors;
}

}  // namespace lowlap
