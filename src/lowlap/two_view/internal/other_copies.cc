#include "lowlap/two_view/internal/other_copies.h"

#include <algorithm>
#include <optional>

#include "lowlap/two_view/internal/kernels/essential_kernel.h"
#include "lowlap/two_view/internal/planes/planar_motion.h"
#include "lowlap/two_view/internal/repeat_evidence.h"

namespace lowlap {
namespace {

constexpr std::size_t kMinOnPlane = 10;
constexpr double kTolerancePx = 3;
constexpr double kToleranceShare = 0.1;

// Whether `x` and `expected` (z = 1) are apart, and copies of one another.
bool IsOtherCopy(const RepeatedPattern& repeats, const Vec3& x,
                 const Vec3& expected, double focal_px) {
  const double distance_px = focal_px * (x - expected).norm();
  const double tolerance_px =
      std::max(kTolerancePx, kToleranceShare * distance_px);
  return distance_px > 2 * tolerance_px &&
         repeats.AreCopies(x, expected, tolerance_px);
}

}  // namespace

std::vector<int> MatchesOfOtherCopies(const TwoViewInput& input,
                                      const ShuffledMatches& matches,
                                      const RelativePose& pose,
                                      Random& random) {
  const auto unrepeated = MatchesBeyondRepeats(input, matches);
  if (!unrepeated) return {};
  const PointPairs pairs = SomeOf(matches, *unrepeated).pairs;
  const double threshold_px = pose.point_threshold_px / PixelUnit(input);
  const RigidTransform cam2_from_cam1 = pose.Cam2FromCam1();
  const EssentialKernel kernel(pairs);
  const std::optional<ScenePlane> plane =
      DominantPlane(cam2_from_cam1, pairs,
                    kernel.VisibleWithinThreshold(cam2_from_cam1, threshold_px),
                    threshold_px, random);
  if (!plane || plane->inliers.size() < kMinOnPlane) return {};
  const Mat3 homography =
      pose.rotation + pose.direction * plane->normal.transpose();
  const Mat3 inverse = homography.inverse();
  std::vector<int> others;
  for (int n = 0; n < matches.pairs.size(); ++n) {
    if (std::binary_search(unrepeated->begin(), unrepeated->end(), n)) continue;
    const Vec3 &x1 = matches.pairs.x1[n], &x2 = matches.pairs.x2[n];
    const Vec3 mapped1 = homography * x1, mapped2 = inverse * x2;
    if (!(mapped1.z() > 0) || !(mapped2.z() > 0)) continue;
    if (IsOtherCopy(*input.repeats2, x2, mapped1 / mapped1.z(),
                    matches.pairs.focal2_px) ||
        IsOtherCopy(*input.repeats1, x1, mapped2 / mapped2.z(),
                    matches.pairs.focal1_px)) {
      others.push_back(n);
    }
  }
  return others;
}

}  // namespace lowlap
