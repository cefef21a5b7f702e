#pragma once

#include <vector>

#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// How far from a solution a measurement contradicts it.
struct AgreementOptions {
  /// In robust standard deviations of all residuals of its kind.
  double reach = 5.0;
  /// Deviation of a direction, in radians; no stated deviation counts as less.
  double direction_stddev_rad = kPoseErrorFloorRad;
  /// As in PoseOptions: nor does a direction contradict that is closer than
  /// three times this.
  double least_false_rad = 0;
};

/// What of the measurements agrees with component 0 of a solution.
struct SolutionAgreement {
  std::vector<ViewId> placed;  // sorted
  /// Relative poses of placed views that are in use: those whose directions are
  /// within `reach` deviations of the centres, those that are not too far for
  /// use, and the others.
  std::vector<ViewPair> agreeing, held, contradicting;
  /// Of those held: whose stated deviation, or half the distance of the two
  /// motions that explain them, is more than that of a weak ratio, so that they
  /// would agree with anything, and those with a weakness, since things that
  /// look alike in two pairs do in a third; and others, of which their matches
  /// tell nothing.
  std::vector<ViewPair> vague, untold;
  /// Triangles of those held, by end, middle and other end, whose directions
  /// are less than ten standard deviations from those of a line, as of a walk
  /// straight ahead: they do not fix the ratios of its lengths.
  std::vector<ViewTriplet> flat;
  /// Triangles of those held, by near view, far view and other near view, with
  /// an angle of less than ten standard deviations at the far one, or flat ones
  /// with a side that is as short: how far the far one is, is not known in
  /// lengths of that side.
  std::vector<ViewTriplet> narrow;
  /// Not in use, for their own matches.
  std::vector<ViewPair> refuted;  // sorted
  /// Of the ratios in use across relative poses that are held, those within
  /// `reach` deviations of the centres, or a tenth, and the others.
  std::vector<ViewTriplet> agreeing_ratios, rejected_ratios;
};

SolutionAgreement FindAgreement(const Scene& scene,
                                const TranslationProblem& problem,
                                const TranslationSolution& solution,
                                const MatchVerdicts& matches,
                                const AgreementOptions& options);

}  // namespace lowlap
