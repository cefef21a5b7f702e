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

/// Distortion model and coefficients of a camera, in ours. They are exact for
/// kDistorts; for kUndistorts they are the inverse series
///   x_d = x (1 - k r^2 + 3 k^2 r^4 - 12 k^3 r^6).
Intrinsic IntrinsicFromRadial(const RadialCamera& camera, RadialForm form);

struct RadialFit {
  RadialCamera camera;
  double error_px = 0;  // the largest over the image; 0 where exact
};

/// The camera of an intrinsic: exact for one focal length and k1, k2 alone
/// (kDistorts), or no distortion and what IntrinsicFromRadial made
/// (kUndistorts); else the mean focal length and, unless it is a pinhole, the
/// least squares fit of k over the image. kUnsupported for panoramas, and where
/// the fit is off by more than a thousandth of the image diagonal.
Result<RadialFit> RadialFromIntrinsic(const Intrinsic& intrinsic,
                                      RadialForm form);

}  // namespace lowlap::bundler
