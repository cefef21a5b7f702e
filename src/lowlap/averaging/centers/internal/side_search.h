#pragma once

#include <vector>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/centers/internal/scene_centers.h"

namespace lowlap {

/// Centres, and the relative poses that contradict them, in use or not, by
/// their directions or their lengths (ContradictedLengths). What is left out
/// for a little turn alone (no more than directions may be off) does not, if
/// its direction agrees.
struct Side {
  SceneCenters centers;
  EvidenceOfPairs against;

  int NumPlaced() const { return centers.solution.NumPlaced(); }
  /// Beyond what is left out for its rotation.
  bool IsContradicted(const SceneRotations& rotations) const;
  double EvidenceAgainst() const;
  double EvidenceAgainstOnly(const Side& other) const;
};

struct SideFound {
  Side side;
  std::vector<Contest> contests;  // those that cannot be decided
};

/// What the search begins with, where relative poses contradict: the solution
/// from the strongest relative poses, as few as lose no view, if less speaks
/// against it than against that from all; or the solution without what
/// contradicts centres that grow (ContradictionsOfGrowth).
enum class SideStart { kStrongest, kGrown };

/// From there, for every contest (FindSceneContests), the solution with the
/// contradictions beside the links, and with them instead of the links; then
/// that without one more, the weakest first. If the relative poses that
/// contradict such a solution, left out or kept, have less evidence together,
/// and no view is lost, it is taken, and its own contests are looked at next.
///
/// A contest is decided, and not listed, if those that contradict only the
/// solution without the links have more than twice the evidence of those that
/// contradict only this one: that counts what else must be wrong if the links
/// are. It is not where that solution loses a view or fails, nor where a
/// contradiction is left out for its rotation, which stays as it is.
///
/// Cost: up to four solutions, two for each contest, of the 3000 / n (at least
/// one) against whose links most evidence speaks, n views being placed, and as
/// many again without one. Errors: those of SolveSceneCenters.
Result<SideFound> SearchSides(const Scene& scene,
                              const SceneRotations& rotations,
                              const PoseOptions& options, SideStart start,
                              const RunContext& context);

}  // namespace lowlap
