#include "lowlap/two_view/chance_support.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The rotation that takes the bearings x1 closest to x2, with Cauchy weights
/// (iterated orthogonal Procrustes).
Mat3 FitRotation(const PointPairs& pairs, const std::vector<int>& indices,
                 const Mat3& start, double scale_rad) {
  Mat3 rotation = start;
  for (int iteration = 0; iteration < 10; ++iteration) {
    Mat3 correlation = Mat3::Zero();
    for (const int i : indices) {
      const Vec3 a = pairs.x1[i].normalized();
      const Vec3 b = pairs.x2[i].normalized();
      const double ratio = (rotation * a - b).norm() / scale_rad;
      correlation += b * a.transpose() / (1 + ratio * ratio);
    }
    rotation = NearestRotation(correlation);
  }
  return rotation;
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

TranslationEvidence TestTranslation(const PointPairs& pairs,
                                    const RigidTransform& cam2_from_cam1,
                                    const std::vector<int>& inliers,
                                    double threshold_px) {
  TranslationEvidence evidence;
  const double scale = 3 * threshold_px / pairs.focal2_px;
  const Mat3 rotation =
      FitRotation(pairs, inliers, cam2_from_cam1.rotation, scale);
  for (const int i : inliers) {
    if (AngleBetween(rotation * pairs.x1[i], pairs.x2[i]) <= scale) {
      ++evidence.num_rotation_inliers;
    }
  }
  if (2 * evidence.num_rotation_inliers < static_cast<int>(inliers.size())) {
    evidence.log10_nfa = -std::numeric_limits<double>::infinity();
    return evidence;
  }
  const int n = pairs.size();
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
  evidence.log10_nfa = ladder.WithBackground(background).Best(counts).log10_nfa;
  return evidence;
}

}  // namespace lowlap
