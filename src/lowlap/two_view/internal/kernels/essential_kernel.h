#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"

namespace lowlap {

/// Relative pose as a kernel of AContrarioRansac: five-point samples, squared
/// Sampson residuals in pixels, Cauchy refinement. Pairs are in random order.
class EssentialKernel {
 public:
  using Model = RigidTransform;  // cam2_from_cam1, |t| = 1
  static constexpr int kSampleSize = 5;
  /// Motions that one sample can give.
  static constexpr int kMaxModels = 10;

  explicit EssentialKernel(const PointPairs& pairs);

  const PointPairs& pairs() const { return pairs_; }
  int NumData() const { return pairs_.size(); }
  /// The motions that see all five points in front of both cameras.
  void Solve(const std::array<int, 5>& sample,
             std::vector<Model>& models) const;
  void SquaredResiduals(const Model& model, int begin, int end,
                        float* squared_px) const;
  std::optional<Model> Refine(const Model& model, double threshold_px) const;

  /// Matches with a Sampson residual of at most `threshold_px`.
  std::vector<int> WithinThreshold(const Model& model,
                                   double threshold_px) const;
  /// Those of them that are not behind a camera.
  std::vector<int> VisibleWithinThreshold(const Model& model,
                                          double threshold_px) const;

 private:
  const PointPairs& pairs_;
  // Coordinates once more, for fast evaluation.
  std::vector<float> x1_, y1_, x2_, y2_;
  // Covariances over squared focal lengths, xx, xy (twice), yy.
  std::vector<float> xx1_, xy1_, yy1_, xx2_, xy2_, yy2_;
};

/// What the rays of a match say about the sign of its depths.
enum class Visibility {
  kInFront,       // of both cameras
  kBehind,        // at least one depth is negative
  kUndetermined,  // the rays are parallel to within `min_parallax_rad`
};

/// The parallax that residuals of `threshold_px` can feign.
double NoiseAngle(const PointPairs& pairs, double threshold_px);

Visibility CheckVisibility(const RigidTransform& cam2_from_cam1, const Vec3& x1,
                           const Vec3& x2, double min_parallax_rad);

}  // namespace lowlap
