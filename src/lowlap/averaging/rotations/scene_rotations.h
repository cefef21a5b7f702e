#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct RotationAveragingOptions {
  int max_iterations = 100;
  double tolerance_rad = 1e-9;
  /// Spanning trees tried at most; fewer on graphs of thousands of edges.
  int max_starts = 8;
  /// Of the trees that are drawn at random.
  std::uint64_t seed = 0;

  Status Validate() const;
};

enum class OutlierReason {
  kRotation,      // its rotation is not the averaged one
  kDirection,     // its direction is not that of the solved centres
  kContradicted,  // on no cycle, and what contradicts it has more evidence
  kOpenLoop,      // the least evidence in a loop that does not close at all
  kMatches,       // its own matches contradict its direction
  kOutweighed,    // third views bear out what contradicts it, and hardly it
  kLookAlike,     // beside its matches, what both views should see is missing
};

/// "rotation", "direction", "contradicted", "open_loop", "matches",
/// "outweighed", "look_alike".
const char* OutlierReasonName(OutlierReason reason);

/// What a rotation and a direction may be off without being called false.
inline constexpr double kLittleDeg = 1.0;
inline constexpr double kLittleOfDirectionsDeg = 3 * kLittleDeg;

/// A relative pose that was left out, and why.
struct OutlierEdge {
  ViewPair views;
  OutlierReason reason = OutlierReason::kRotation;
  /// Its distance from the solution when it was left out; 0 for reasons other
  /// than kRotation and kDirection.
  double error_deg = 0;

  /// The others say that it is wrong: not if it is off by a little only, nor if
  /// its own matches contradict it, which are right then.
  bool IsFalse() const;
};

std::vector<ViewPair> PairsOf(const std::vector<OutlierEdge>& outliers);

/// Relative poses that only one loop could check, and that do not close it: one
/// of them at least is wrong, and nothing tells which.
struct LoopClosing {
  std::vector<ViewPair> edges;
  double closing_deg = 0;
  /// What the stated deviations of the edges add up to.
  double expected_deg = 0;
  /// The closing is too large to be shared out among them: the one of least
  /// evidence was left out.
  std::optional<ViewPair> left_out;

  /// Those of the edges, ascending, if one was left out: it may be another that
  /// is false. None if the edges share out what is left.
  std::vector<ViewId> DoubtfulViews() const;
};

/// A kept relative pose that is the only link of `views` to the others and is
/// contradicted by relative poses of less evidence.
struct ContestedLink {
  ViewPair edge;
  std::vector<ViewPair> contradictions;
  std::vector<ViewId> views;
};

/// What told the motions of a pair apart, whose matches allow several
/// (RelativePose::alternatives).
enum class HypothesisGrounds {
  kNone,       // nothing did
  kCycles,     // the rotations of the cycles through the pair
  kTriplets,   // the scale ratios of the triplets through the pair
  kStructure,  // what the whole scene shows, adjusted under either
};

/// "none", "cycles", "triplets", "structure".
const char* HypothesisGroundsName(HypothesisGrounds grounds);

/// Which motion of a pair was taken, and why.
struct HypothesisDecision {
  ViewPair views;
  HypothesisGrounds grounds = HypothesisGrounds::kNone;
  /// Not the motion that the pair came with.
  bool replaced = false;
  /// By how much the best motion is ahead of the next: robust cost of the
  /// rotations (see DecideHypothesesByCycles), log10 NFA of the ratios, or
  /// squared errors of the structure in units of its noise.
  double margin = 0;
};

/// A relative pose whose matches bear out another direction, which it got.
struct ReplacedDirection {
  ViewPair views;
  double error_deg = 0;  // of the one that it came with
};

/// What the relative poses' own matches say about their directions, by views.
/// Those that are not named are borne out.
struct MatchVerdicts {
  std::vector<ReplacedDirection> replaced;
  std::vector<ViewPair> refuted;  // their matches bear no direction out
  std::vector<ViewPair> untold;   // too few matches to say
};

/// What third views say of relative poses that contradict one another, by
/// views.
struct ThirdViewVerdicts {
  /// To be left out: others that contradict them are borne out better.
  std::set<ViewPair> outweighed;
  /// What of their evidence (EvidenceOfNfa) counts in contests; all, unless
  /// listed.
  std::map<ViewPair, double> evidence;
};

struct SceneRotations {
  /// The largest component of what is kept.
  std::map<ViewId, Mat3> cam_from_world;
  std::vector<OutlierEdge> outliers;  // by views
  std::vector<LoopClosing> loops;     // only those that were found open
  std::vector<ContestedLink> contested;
  /// Kept relative poses that are on no cycle, so that nothing checks them.
  std::vector<ViewPair> unchecked;
  /// Of all relative poses, if they were asked; see AddMatchVerdicts.
  MatchVerdicts matches;
  /// As given.
  ThirdViewVerdicts third_views;
  double median_residual_rad = 0;
};

/// Standard deviation of the rotation about each axis, in radians: as stated,
/// with a floor that covers what covariances leave out; a default if unknown.
double RotationStddev(const RelativePose& pose);

/// Rotations from the relative poses of a scene (AverageRotations), and which
/// of these to believe.
///
/// - A relative pose whose rotation is off by more than `outlier_reach` robust
///   standard deviations, and by more than `least_false_rad`, is left out, and
///   the rest is averaged again.
/// - What remains is checked by its cycles. A relative pose on no cycle (a
///   bridge) is left out too if those left out across it have more evidence
///   together (-log10 NFA) than it has itself: then the views beyond it are not
///   placed by it. If they have less, it is kept, and `contested`.
/// - Where one relative pose left out closes a loop with two or more that
///   nothing else checks, there is one contradiction for several suspects. Up
///   to `outlier_reach` times the expected closing error all are kept, and
///   share it with full weights; beyond, the one of least evidence is left out.
///   Both are listed in `loops`.
/// - What third views found outweighed has no part in any of this.
///
/// Errors: those of AverageRotations; kInsufficientData if nothing remains.
Result<SceneRotations> AverageSceneRotations(
    const Scene& scene, const RotationAveragingOptions& options,
    double outlier_reach, double least_false_rad = 0,
    const RunContext& context = {}, ThirdViewVerdicts third_views = {});

/// Takes the verdicts over. Relative poses that are refuted become outliers:
/// their rotations may be right, and have had their part in the average.
void AddMatchVerdicts(MatchVerdicts verdicts, SceneRotations* rotations);

}  // namespace lowlap
