#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lowlap/features/internal/image.h"
#include "lowlap/features/internal/points/point_detector.h"
#include "lowlap/geometry/types.h"
#include "lowlap/matching/match_options.h"

namespace lowlap {

/// Grey values at half the resolution per level, by averaging 2 x 2 pixels.
class GrayPyramid {
 public:
  explicit GrayPyramid(const GrayImage& image);

  /// The level whose pixels are at most as wide as `step_px`.
  int LevelOf(double step_px) const;
  /// Bicubic (Catmull-Rom) interpolation in a level; the position is in pixels
  /// of the full image. nullopt beyond the border.
  std::optional<double> Sample(int level, const Vec2& position_px) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<float> values;
  };
  std::vector<Level> levels_;
};

/// What a point looks like: grey values on a grid of kSide x kSide around it,
/// upright, 0.5 standard deviations of its blob apart.
struct PointPatch {
  static constexpr int kRadius = 9;
  static constexpr int kSide = 2 * kRadius + 1;
  std::array<float, kSide * kSide> values{};
  double step_px = 0;
};

/// nullopt: the patch reaches beyond the image.
std::optional<PointPatch> ExtractPatch(const GrayPyramid& image,
                                       const Keypoint& point);

/// Where the middle of a patch lies in another image:
///   g T(u) + b = I(A u + t)
/// is solved in least squares for the affine map (A, t), the gain g > 0 and the
/// offset b, by Gauss-Newton steps in the patch's frame (inverse compositional:
/// Baker & Matthews, "Lucas-Kanade 20 Years On", IJCV 2004), under Gaussian
/// weights. It starts at the similarity that takes the keypoint `from`, whose
/// patch it is, to `to`.
///
/// The place returned is the mean of t, with the covariance S that the residual
/// leaves it, and of the keypoint, with K = I (keypoint_stddev to.scale_px)^2,
///   to.position_px + K (K + S)^-1 (t - to.position_px),
/// so that a poor fit moves the point little, and least along an edge. nullopt
/// where the alignment does not converge, leaves the image, deforms the patch
/// by more than a factor 2 against the similarity, correlates too little, or
/// contradicts the keypoint (Mahalanobis distance of t under K + S beyond
/// max_deviation).
std::optional<Vec2> AlignPatch(const PointPatch& patch, const Keypoint& from,
                               const Keypoint& to, const GrayPyramid& image,
                               const PatchAlignmentOptions& options);

}  // namespace lowlap
