#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/study/internal/trust/appearance.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// What the scenes of a study of trust are drawn from.
enum class TrustFamily {
  /// Open and closed walks of few points, a part of whose relative poses have
  /// any direction.
  kWrongDirections,
  /// All worlds, pairs and flaws there are.
  kMixed,
  /// Scenes without truth: features that have nothing to do with each other.
  kNoise,
  /// Walks around a house whose opposite sides are alike in part, some views
  /// missing; all pairs are matched by what looks the same.
  kAlikeSides,
  /// Walks around a house or through a room on two days, or with two cameras,
  /// which find little of what the other one sees; matched likewise.
  kTwoSessions,
  /// Walks along a corridor whose sections are alike in part, some views
  /// missing; matched likewise.
  kAlikeSections,
};

/// "wrong_directions", "mixed", "noise", "alike_sides", "two_sessions",
/// "alike_sections".
const char* TrustFamilyName(TrustFamily family);
const std::vector<TrustFamily>& AllTrustFamilies();

/// A simulated scene with what is wrong with it.
struct TrustScene {
  SyntheticOptions options;
  enum class Features { kKept, kShuffled, kDrawn } features = Features::kKept;
  bool has_look_alikes = false;
  /// What looks the same; all: features are matched as simulated.
  LikenessOptions likeness;
  std::vector<ViewId> left_out;
  /// Of the given to the true focal length.
  double focal_factor = 1;
  /// Relative poses are estimated from the matches, as those of photographs.
  bool estimates_poses = false;

  /// In words, as counts are kept by them: world, pairs and flaws.
  std::vector<std::string> Labels() const;
};

/// The same family and seed give the same scene on every machine.
TrustScene DrawTrustScene(TrustFamily family, std::uint64_t seed);

/// What is to be solved, and its truth. Errors: those of Simulate, MatchAnew
/// and EstimatePosesAnew.
Result<SyntheticScene> MakeTrustScene(const TrustScene& drawn,
                                      const RunContext& context);

}  // namespace lowlap
