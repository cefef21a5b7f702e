#include "lowlap/two_view/chance_support.h"

#include <algorithm>
#include <cmath>

#include "lowlap/geometry/rotation.h"
#include "lowlap/two_view/refine_relative_pose.h"

namespace lowlap {
namespace {

/// Permutations are added until they give about this many wrong matches.
constexpr int kNumWrongMatches = 20000;

int NumShifts(int num_data) {
  return std::clamp(kNumWrongMatches / std::max(1, num_data), 1, num_data - 1);
}

class StepOfMatch {
 public:
  StepOfMatch(const PointPairs& pairs, const AContrarioLadder& ladder,
              const RigidTransform& pose)
      : pairs_(pairs),
        ladder_(ladder),
        pose_(pose),
        residual_(pose, pairs.focal1_px, pairs.focal2_px) {}

  int operator()(int first, int second) const {
    const Vec3& x1 = pairs_.x1[first];
    const Vec3& x2 = pairs_.x2[second];
    const double r = residual_(x1, x2);
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

/// Angle between the motion of a point relative to pure rotation and its
/// epipolar direction, in [0, pi].
double MotionAngle(const RigidTransform& pose, const Vec3& x1, const Vec3& x2) {
  const Vec3 p = pose.rotation * x1;
  if (p.z() <= 1e-6 * p.norm()) return kPi;
  const Vec3& t = pose.translation;
  const Vec2 epipolar = t.head<2>() * p.z() - p.head<2>() * t.z();
  const Vec2 motion = x2.head<2>() / x2.z() - p.head<2>() / p.z();
  const double cross = epipolar.x() * motion.y() - epipolar.y() * motion.x();
  return std::atan2(std::abs(cross), epipolar.dot(motion));
}

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

double DirectionLog10Nfa(const PointPairs& pairs,
                         const RigidTransform& cam2_from_cam1) {
  const int n = pairs.size();
  if (n < 2) return 0;
  // Five: the pose was fitted to the matches.
  const AContrarioLadder ladder(n, 5, 1, {1 / kPi, 1}, 1e-3, kPi / 2);
  const auto count = [&](int shift, std::vector<int>& counts) {
    for (int i = 0; i < n; ++i) {
      const double angle =
          MotionAngle(cam2_from_cam1, pairs.x1[i], pairs.x2[(i + shift) % n]);
      ++counts[ladder.Step(static_cast<float>(angle * angle))];
    }
  };
  std::vector<int> background(ladder.NumSteps() + 1, 0);
  for (int shift = 1; shift <= NumShifts(n); ++shift) {
    count(shift, background);
  }
  std::vector<int> counts(ladder.NumSteps() + 1, 0);
  count(0, counts);
  return ladder.WithBackground(background).Best(counts).log10_nfa;
}

}  // namespace lowlap
