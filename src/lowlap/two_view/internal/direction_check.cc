#include "lowlap/two_view/internal/direction_check.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/matching/internal/lines/line_transfer.h"
#include "lowlap/robust/internal/a_contrario_ransac.h"
#include "lowlap/two_view/internal/evidence/translation_evidence.h"
#include "lowlap/two_view/internal/kernels/two_point_kernel.h"
#include "lowlap/two_view/internal/search/chance_support.h"
#include "lowlap/two_view/internal/search/pose_search.h"
#include "lowlap/two_view/internal/shuffled_matches.h"

namespace lowlap {
namespace {

/// More matches do not change a verdict.
constexpr int kMaxMatches = 300;

PointPairs FirstOf(PointPairs pairs, int count) {
  const auto size = static_cast<std::size_t>(std::min(count, pairs.size()));
  pairs.x1.resize(size);
  pairs.x2.resize(size);
  pairs.covariance1.resize(size);
  pairs.covariance2.resize(size);
  return pairs;
}

// Whether matches that all fit perfectly would bear a given direction out.
bool CanTell(const AContrarioLadder& ladder, const EssentialKernel& kernel) {
  const int n = kernel.NumData();
  if (n < 2) return false;
  // As many wrong matches as n matches make, none of which passes.
  std::vector<int> background(ladder.NumSteps() + 1, 0);
  background.back() = n * (n - 1);
  return ladder.WithBackground(background).Log10Nfa(n, 0) < 0;
}

}  // namespace

DirectionCheck CheckDirection(const TwoViewInput& input,
                              const RelativePose& pose, double same_rad,
                              std::uint64_t seed) {
  Random random(seed);
  const PointPairs pairs =
      FirstOf(ShuffleMatches(input, random).pairs, kMaxMatches);
  const EssentialKernel kernel(pairs);
  const BackgroundLaw law = SampsonLaw(input);
  const auto ladder_for = [&](int sample_size) {
    // Up to where chance alone would pass: a rough pose is not a wrong one.
    return AContrarioLadder(pairs.size(), sample_size, 1, law,
                            PoseSearch::kMinThresholdPx, 1 / law.coefficient);
  };
  DirectionCheck check;
  const AContrarioLadder for_given = ladder_for(0);
  if (!CanTell(for_given, kernel)) return check;

  const TwoPointKernel directions(kernel, pose.rotation, {});
  const AContrarioLadder for_sample = ladder_for(TwoPointKernel::kSampleSize);
  AContrarioRansacOptions ransac;
  ransac.max_samples = 1000;
  ransac.max_refinements = 0;  // what is fitted beyond the sample is not paid
  const auto search = AContrarioRansac(directions, for_sample, ransac, random);
  const std::optional<RigidTransform>& found = search.model;
  if (found &&
      !TestTranslation(
           pairs, *found,
           kernel.VisibleWithinThreshold(*found, search.score.threshold),
           search.score.threshold, PoseSearch::kMinThresholdPx)
           .IsSeen()) {
    return check;
  }
  check.verdict = DirectionVerdict::kBorneOut;
  if (found && AngleBetween(found->translation, pose.direction) <= same_rad) {
    return check;
  }
  const double given =
      ScoreAgainstChance(kernel, for_given, pose.Cam2FromCam1()).log10_nfa;
  AContrarioScore other;
  if (found) other = ScoreAgainstChance(kernel, for_sample, *found);
  if (given < 0 && given <= other.log10_nfa) return check;
  if (!(other.log10_nfa < 0)) {
    check.verdict = DirectionVerdict::kRefuted;
    return check;
  }
  RelativePose replaced = pose;
  replaced.rotation = found->rotation;
  replaced.direction = found->translation;
  replaced.point_threshold_px = other.threshold;
  replaced.covariance.reset();  // that of the wrong direction
  replaced = ImproveRelativePose(input, replaced, false, TwoViewOptions());
  replaced.line_inliers =
      FilterLineMatches(input.line_matches, *input.features1, *input.features2,
                        replaced.Cam2FromCam1(), LineFilterOptions());
  check.error_rad = AngleBetween(replaced.direction, pose.direction);
  if (check.error_rad <= same_rad) return check;
  check.verdict = DirectionVerdict::kReplaced;
  check.replacement = std::move(replaced);
  return check;
}

}  // namespace lowlap
