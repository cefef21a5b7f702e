#include "lowlap/two_view/internal/search/chance_support.h"

#include <algorithm>
#include <cmath>

#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {
namespace {

/// Permutations are added until they give about this many wrong matches. Of few
/// hundred matches these are all there are, in whatever order they come; the
/// NFA of hundreds of inliers turns the error of a rate into digits.
constexpr int kNumWrongMatches = 200000;

int NumShifts(int num_data) {
  return std::clamp(kNumWrongMatches / std::max(1, num_data), 1,
                    std::max(1, num_data - 1));
}

class StepOfMatch {
 public:
  StepOfMatch(const PointPairs& pairs, const AContrarioLadder& ladder,
              const RigidTransform& pose)
      : pairs_(pairs), ladder_(ladder), pose_(pose), residual_(pose, pairs) {}

  int operator()(int first, int second) const {
    const Vec3& x1 = pairs_.x1[first];
    const Vec3& x2 = pairs_.x2[second];
    const double r = residual_.Between(first, second);
    const int step = ladder_.Step(static_cast<float>(r * r));
    if (step == ladder_.NumSteps()) return step;
    const double noise_rad = NoiseAngle(pairs_, ladder_.Threshold(step));
    return CheckVisibility(pose_, x1, x2, noise_rad) == Visibility::kBehind
               ? ladder_.NumSteps()
               : step;
  }

 private:
  const PointPairs& pairs_;
  const AContrarioLadder& ladder_;
  const RigidTransform& pose_;
  SampsonResidual residual_;
};

}  // namespace

std::vector<int> VisibleSteps(const EssentialKernel& kernel,
                              const AContrarioLadder& ladder,
                              const RigidTransform& cam2_from_cam1) {
  const StepOfMatch step_of_match(kernel.pairs(), ladder, cam2_from_cam1);
  std::vector<int> steps(kernel.NumData());
  for (int i = 0; i < kernel.NumData(); ++i) steps[i] = step_of_match(i, i);
  return steps;
}

AContrarioScore ScoreAgainstChance(const EssentialKernel& kernel,
                                   const AContrarioLadder& ladder,
                                   const RigidTransform& cam2_from_cam1) {
  const int n = kernel.NumData();
  const StepOfMatch step_of_match(kernel.pairs(), ladder, cam2_from_cam1);
  std::vector<int> background(ladder.NumSteps() + 1, 0);
  for (int shift = 1; shift <= NumShifts(n); ++shift) {
    for (int i = 0; i < n; ++i) {
      ++background[step_of_match(i, (i + shift) % n)];
    }
  }
  std::vector<int> counts(ladder.NumSteps() + 1, 0);
  for (const int step : VisibleSteps(kernel, ladder, cam2_from_cam1)) {
    ++counts[step];
  }
  return ladder.WithBackground(background).Best(counts);
}

double ChanceShare(const PointPairs& pairs,
                   const RigidTransform& cam2_from_cam1, double threshold_px) {
  const SampsonResidual residual(cam2_from_cam1, pairs);
  const double noise_rad = NoiseAngle(pairs, threshold_px);
  const int n = pairs.size();
  const int num_shifts = NumShifts(n);
  int count = 0;
  for (int shift = 1; shift <= num_shifts; ++shift) {
    for (int i = 0; i < n; ++i) {
      const int other = (i + shift) % n;
      count += std::abs(residual.Between(i, other)) <= threshold_px &&
               CheckVisibility(cam2_from_cam1, pairs.x1[i], pairs.x2[other],
                               noise_rad) != Visibility::kBehind;
    }
  }
  // Plus one, so that none is impossible.
  return (count + 1.0) / (static_cast<double>(num_shifts) * n + 1);
}

}  // namespace lowlap
