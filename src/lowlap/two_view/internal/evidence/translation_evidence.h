#pragma once

#include <optional>
#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"

namespace lowlap {

/// Whether the matches show a translation at all, or the noise hides it.
struct TranslationEvidence {
  /// Inliers of the pose that a rotation alone explains.
  int num_rotation_inliers = 0;
  /// log10 NFA of the translation in a thousand pairs, at most 0: no evidence
  /// for one. Absent where rotation alone explains less than half of the
  /// inliers.
  std::optional<double> log10_nfa;

  bool IsSeen() const { return !log10_nfa || *log10_nfa < 0; }
};

/// A rotation is fitted to the inliers of the pose and explains those it
/// transfers to within 3 `threshold_px`. If that is most of them, the
/// translation must prove itself. Any translation fits the matches of a
/// rotation, for what their noise does across epipolar lines is all it is asked
/// for; but then nothing tells the two directions apart. So matches vote: is
/// the error that the rotation leaves along the epipolar line greater than the
/// one that the pose leaves across, each in its own deviation (the shapes of
/// the points' errors, and what the fits have taken from either)? The inliers
/// are within the threshold across; so that neither is preferred, those that
/// are within it along vote as well. Without translation both are as likely,
/// whatever the size of a point's noise; so often, and by chance matches, the
/// votes are binomial; of crossings that share a line, one votes. With one, the
/// parallax goes along. The direction was chosen among all: the NFA counts
/// those whose votes differ.
///
/// Errors below `precision_px` are none: in a copy of an image nothing moves,
/// and what is left is rounding.
TranslationEvidence TestTranslation(const PointPairs& pairs,
                                    const RigidTransform& cam2_from_cam1,
                                    const std::vector<int>& inliers,
                                    double threshold_px, double precision_px);

}  // namespace lowlap
