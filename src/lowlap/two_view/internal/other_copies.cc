#include "lowlap/two_view/internal/other_copies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "lowlap/robust/internal/log_combinatorics.h"
#include "lowlap/two_view/internal/evidence/repeat_evidence.h"
#include "lowlap/two_view/internal/kernels/essential_kernel.h"
#include "lowlap/two_view/internal/planes/planar_motion.h"

namespace lowlap {
namespace {

constexpr std::size_t kMinOnPlane = 10;
constexpr double kTolerancePx = 3;
constexpr double kToleranceShare = 0.1;
constexpr int kRandomPartners = 2000;
/// One pair in a thousand loses matches by chance.
constexpr double kMaxLog10Nfa = -3;

double TolerancePx(double distance_px) {
  return std::max(kTolerancePx, kToleranceShare * distance_px);
}

// What the plane makes of points of either view.
class Copies {
 public:
  Copies(const TwoViewInput& input, const PointPairs& pairs,
         const Mat3& homography)
      : input_(input),
        pairs_(pairs),
        homography_(homography),
        inverse_(homography.inverse()) {}

  /// Too far from one another to be one point of the plane.
  bool AreApart(int n) const {
    const double distance_px = DistancePx(n);
    return distance_px > 2 * TolerancePx(distance_px);
  }

  /// Whether the points n1 of view 1 and n2 of view 2 are two copies.
  bool AreCopies(int n1, int n2) const {
    const Vec3 &x1 = pairs_.x1[n1], &x2 = pairs_.x2[n2];
    return AreCopies(*input_.repeats2, x2, homography_ * x1,
                     pairs_.focal2_px) ||
           AreCopies(*input_.repeats1, x1, inverse_ * x2, pairs_.focal1_px);
  }

 private:
  // Of the match in view 2; 0 if the plane says nothing.
  double DistancePx(int n) const {
    const Vec3 expected = homography_ * pairs_.x1[n];
    if (!(expected.z() > 0)) return 0;
    return pairs_.focal2_px * (pairs_.x2[n] - expected / expected.z()).norm();
  }

  static bool AreCopies(const RepeatedPattern& repeats, const Vec3& x,
                        const Vec3& mapped, double focal_px) {
    if (!(mapped.z() > 0)) return false;
    const Vec3 expected = mapped / mapped.z();
    const double distance_px = focal_px * (x - expected).norm();
    const double tolerance_px = TolerancePx(distance_px);
    return distance_px > 2 * tolerance_px &&
           repeats.AreCopies(x, expected, tolerance_px);
  }

  const TwoViewInput& input_;
  const PointPairs& pairs_;
  const Mat3 homography_, inverse_;
};

// log10 NFA that so many of the matches off the plane are copies.
double Log10Nfa(const Copies& copies, const std::vector<int>& apart,
                std::size_t num_copies) {
  const std::size_t size = apart.size();
  double hits = 1, drawn = 1;
  for (std::size_t step = 1; step < size && drawn < kRandomPartners; ++step) {
    for (std::size_t n = 0; n < size; ++n, ++drawn) {
      hits += copies.AreCopies(apart[n], apart[(n + step) % size]) ? 1 : 0;
    }
  }
  return Log10Binomial(static_cast<int>(size), static_cast<int>(num_copies)) +
         static_cast<double>(num_copies) * std::log10(hits / drawn);
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
  const Copies copies(
      input, matches.pairs,
      pose.rotation + pose.direction * plane->normal.transpose());
  std::vector<int> apart, others;
  for (int n = 0; n < matches.pairs.size(); ++n) {
    if (std::binary_search(unrepeated->begin(), unrepeated->end(), n) ||
        !copies.AreApart(n)) {
      continue;
    }
    apart.push_back(n);
    if (copies.AreCopies(n, n)) others.push_back(n);
  }
  if (Log10Nfa(copies, apart, others.size()) > kMaxLog10Nfa) return {};
  return others;
}

}  // namespace lowlap
