#pragma once

#include <array>

#include "lowlap/core/result.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap::bundler {

/// What the coefficients k of a RadialCamera say. With x undistorted and x_d
/// distorted, both normalised, and r, r_d their lengths:
enum class RadialForm {
  kDistorts,    // x_d = x (1 + k[0] r^2 + k[1] r^4); Bundler, BAL
  kUndistorts,  // x = x_d (1 + k[0] r_d^2); NVM, k[1] = 0
};

/// A camera of one focal length, whose pixels are relative to the principal
/// point: focal_px x_d.
struct RadialCamera {
  double focal_px = 0;
  std::array<double, 2> k = {0, 0};
};

struct IntrinsicFit {
  Intrinsic intrinsic;  // without a frame
  /// The largest up to the reach; 0 where exact, infinite where the formula
  /// folds.
  double error_px = 0;
};

/// A camera in our model. It is exact for kDistorts. kUndistorts has no inverse
/// of our form: k1 is -k[0], and k2, k3 are fitted as far out as `reach`, the
/// length of the outermost measurement in focal lengths.
IntrinsicFit IntrinsicFromRadial(const RadialCamera& camera, RadialForm form,
                                 double reach);

struct RadialFit {
  RadialCamera camera;
  double error_px = 0;  // the largest over the image; 0 where exact
};

/// The camera of an intrinsic: exact for one focal length and k1, k2 alone
/// (kDistorts), or no distortion and what IntrinsicFromRadial made
/// (kUndistorts); else the mean focal length and, unless it is a pinhole, the
/// least squares fit of k over the image. kUnsupported for panoramas, and where
/// the fit is not close (IsCloseFit).
Result<RadialFit> RadialFromIntrinsic(const Intrinsic& intrinsic,
                                      RadialForm form);

/// Whether a fit is off by no more than a thousandth of the image diagonal.
bool IsCloseFit(double error_px, const Intrinsic& intrinsic);

}  // namespace lowlap::bundler
