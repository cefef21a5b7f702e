#pragma once

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Triangulates scene->point_tracks and scene->line_tracks from scene->poses,
/// and collects the coplanar pairs of scene->scale_ratios: replaces
/// `structure`, `line_structure` and `coplanar_pairs` of the enabled kinds
/// (clears those of the others).
///
/// Points: the pair of observations that most others agree with is refined on
/// all that agree (reprojection error below the threshold, in front of every
/// camera); tracks of two views are landmarks like the others. Lines: the same
/// with interpretation planes and the distances of the segments' end points;
/// the extent is what the segments cover.
///
/// Observations in views without a pose or an intrinsic are left out. The
/// result does not depend on the number of threads. Errors: kInvalidArgument
/// (options, null scene), kInvalidScene (a track refers to a missing feature, a
/// number that is not finite), kCancelled.
Result<StructureSummary> BuildStructure(Scene* scene,
                                        const StructureOptions& options,
                                        const RunContext& context);

/// Bundle adjustment of scene->poses, structure, line_structure and, on
/// request, intrinsics; scene->coplanar_pairs hold lines together.
///
/// Minimises  sum over kinds  1/s^2  sum rho(|r|^2),  with the residuals (px)
///   point    W (projection of X - observed pixel), W the whitening        (2)
///            of the shape of its error (see EstimateShapeExponent)
///   line     distances of a segment's end points to the projected line    (2)
///   pair     see AdjustedCoplanarResidual; a pair counts as one residual, and
///            less the more pairs its lines are in: n lines of one plane do not
///            count n^2 times
///   plane    distances of a point, or of the two ends of a line's extent, from
///            a plane of the scene, over its thickness, both as the first
///            camera sees them, so that nothing shrinks (CoplanarTies; Cauchy
///            loss at half a thickness): after the rounds below, the planes are
///            found three times (FindPlanes), with a solve each time
/// where s is the kind's noise level and rho the Cauchy loss, whose scale is
/// the kind's a-contrario threshold (of pairs, which may all but meet by
/// chance: s); all from the residuals before each solve. A line in two views
/// and no pair constrains nothing; it is triangulated again at the end.
///
/// Rounds: observations beyond the threshold are dropped, those of the tracks
/// that fit now are taken in, landmarks that lost observations are triangulated
/// anew; pairs are kept while their residual is small, and come back if the
/// noise of the segments explains that their lines do not meet.
/// Once all is at rest, what drift may have put out of use is let in again, and
/// kept where that explains more of what was measured (OptimumSearch). Where
/// most is seen by two views, there are other starts (FindOptimum).
///
/// Gauge, per component: one camera is held, and the length of its longest
/// baseline. The result is equivariant to similarities of the input.
///
/// Deterministic: the same for any number of threads.
///
/// Degenerate: poses without observations keep their value and are named in
/// the summary. Errors, with the scene unchanged: kInvalidArgument (options,
/// null scene), kInvalidScene (values that are not finite, dangling ids),
/// kInsufficientData (no structure of the enabled kinds in two posed views),
/// kNumerical (the solver found no usable solution), kCancelled.
///
/// Source: Salaün, Marlet, Monasse 2017, section 5; what is different, and why:
/// robust losses, weights, gauge, outlier rounds, points of two views.
Result<AdjustmentSummary> AdjustScene(Scene* scene,
                                      const AdjustmentOptions& options,
                                      const RunContext& context);

}  // namespace lowlap
