#pragma once

#include <map>
#include <set>
#include <vector>

#include "lowlap/averaging/reliability/internal/solution_agreement.h"
#include "lowlap/averaging/reliability_warning.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What an adjustment makes of ratios, log(|c3 - c2| / |c2 - c1|) of the
/// centres, and what it leaves open of them and of directions.
struct AdjustedEvidence {
  struct Ratio {
    double log_ratio = 0;
    double log_ratio_stddev = 0;
  };
  std::map<ViewTriplet, Ratio> ratios;
  std::map<ViewPair, double> direction_stddevs_rad;
  /// log10 NFA by the structure (FindPredictionEvidence), of relative poses and
  /// ratios that have too little themselves.
  std::map<ViewPair, double> evidence_of_pairs;
  std::map<ViewTriplet, double> evidence_of_triplets;
  /// Views of which the structure contradicts what they share with another: it
  /// has nothing to say for them.
  std::set<ViewId> contradicted;
  /// Weak ratios once more, measured between the adjusted cameras.
  std::map<ViewTriplet, ScaleRatio> measured_again;
};

/// Which placed views are doubtful by what is measured: all reasons but the
/// last two. `firm` becomes what the firm views stand on.
///
/// - The evidence of a relative pose is 1 - min(0, log10 NFA). It contradicts a
///   view if it was left out, though not for its own matches, or does not agree
///   (SolutionAgreement).
/// - Views hold each other where the relative poses and ratios that are in use
///   and agree with the solution fix their places (AnalyzeRigidity). The firm
///   ones are the largest set that is held without weak ratios (IsWeak), and
///   without relative poses of which their matches tell nothing or whose stated
///   deviation is more than that of a weak ratio, and whose views would not
///   hold each other without them and weak ratios; two views are none if the
///   scene has more. Every other view hangs on what was set aside, or on other
///   such views, and is doubtful for it; if they, and the one that joins them
///   to the firm ones, are as many as these, so are the firm ones: nothing says
///   which of the parts is in its place.
/// - A ratio is no weaker than an adjustment that bears it out leaves it:
///   where it is within three deviations of `adjusted`, the smaller deviation
///   of both counts.
/// - Where an adjustment determines the direction between two views better than
///   a weak ratio is known, and chance does not explain (as in IsWeak) that its
///   structure predicts what they share, it does not matter what their relative
///   pose tells, unless that is nearly all of copies (PoseWeakness::kRepeats),
///   whose structure agrees with itself. Nor, likewise, how little speaks for a
///   ratio that the adjustment determines while most candidates do not
///   contradict it; or that is not weak when it is measured again, and the same
///   to a tenth.
/// - Ratios across one camera are contradicted if those rejected there, between
///   the same parts, have more than half their evidence.
std::vector<ReliabilityWarning> FindReliabilityWarnings(
    const Scene& scene, const SolutionAgreement& agreement,
    const AdjustedEvidence& adjusted, FirmEvidence* firm);

}  // namespace lowlap
