#include "third_party_adapters/bundler/internal/radial_camera.h"

#include <Eigen/QR>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/internal/format.h"

namespace lowlap::bundler {
namespace {

std::vector<double> InverseSeries(double k) {
  return {-k, 3 * k * k, -12 * k * k * k};
}

/// The coefficients, if the model and the focal length are held exactly.
std::optional<RadialCamera> ExactCamera(const Intrinsic& intrinsic,
                                        RadialForm form) {
  const bool is_perspective = intrinsic.model != CameraModel::kFisheye &&
                              intrinsic.model != CameraModel::kSpherical;
  if (!is_perspective || intrinsic.fx_px != intrinsic.fy_px) {
    return std::nullopt;
  }
  RadialCamera camera{intrinsic.fx_px, {}};
  if (!intrinsic.HasDistortion()) return camera;
  const std::vector<double>& k = intrinsic.distortion;
  const bool is_k1 = intrinsic.model == CameraModel::kRadialK1;
  const bool is_k3 = intrinsic.model == CameraModel::kRadialK3;
  if (form == RadialForm::kUndistorts) {
    if (!is_k3 || k != InverseSeries(-k[0])) return std::nullopt;
    camera.k[0] = -k[0];
  } else {
    if (!is_k1 && !(is_k3 && k[2] == 0)) return std::nullopt;
    camera.k = {k[0], is_k3 ? k[1] : 0.0};
  }
  return camera;
}

/// An undistorted place of the image, and the same as it is measured.
struct Sample {
  Vec2 undistorted;
  Vec2 measured;  // (pixel - principal point) / focal length
};

std::vector<Sample> SamplesOf(const Intrinsic& intrinsic, double focal_px) {
  constexpr int kSteps = 16;
  std::vector<Sample> samples;
  for (int row = 0; row <= kSteps; ++row) {
    for (int column = 0; column <= kSteps; ++column) {
      const Vec2 pixel(intrinsic.width_px * (column / double{kSteps}),
                       intrinsic.height_px * (row / double{kSteps}));
      if (const auto undistorted = intrinsic.Normalize(pixel)) {
        samples.push_back(
            {*undistorted, (pixel - intrinsic.principal_point_px) / focal_px});
      }
    }
  }
  return samples;
}

RadialFit Fit(const Intrinsic& intrinsic, RadialForm form) {
  RadialFit fit;
  fit.camera.focal_px = intrinsic.MeanFocalPx();
  const bool distorts = form == RadialForm::kDistorts;
  const auto samples = SamplesOf(intrinsic, fit.camera.focal_px);
  Eigen::MatrixXd a(2 * samples.size(), distorts ? 2 : 1);
  Eigen::VectorXd b(2 * samples.size());
  for (std::size_t n = 0; n < samples.size(); ++n) {
    // to = from (1 + k[0] r^2 + ...), r = |from|
    const Vec2& from = distorts ? samples[n].undistorted : samples[n].measured;
    const Vec2& to = distorts ? samples[n].measured : samples[n].undistorted;
    const double r2 = from.squaredNorm();
    a.block<2, 1>(2 * n, 0) = r2 * from;
    if (distorts) a.block<2, 1>(2 * n, 1) = r2 * r2 * from;
    b.segment<2>(2 * n) = to - from;
  }
  Eigen::VectorXd k = Eigen::VectorXd::Zero(a.cols());
  // Two focal lengths alone are no distortion.
  if (intrinsic.model != CameraModel::kPinhole) {
    k = a.colPivHouseholderQr().solve(b);
  }
  std::copy(k.begin(), k.end(), fit.camera.k.begin());
  const Eigen::VectorXd residual = a * k - b;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    fit.error_px = std::max(
        fit.error_px, residual.segment<2>(2 * n).norm() * fit.camera.focal_px);
  }
  return fit;
}

}  // namespace

Intrinsic IntrinsicFromRadial(const RadialCamera& camera, RadialForm form) {
  Intrinsic intrinsic;
  intrinsic.fx_px = intrinsic.fy_px = camera.focal_px;
  const auto& k = camera.k;
  if (k[0] == 0 && k[1] == 0) return intrinsic;
  intrinsic.model = CameraModel::kRadialK3;
  intrinsic.distortion = form == RadialForm::kDistorts
                             ? std::vector<double>{k[0], k[1], 0}
                             : InverseSeries(k[0]);
  return intrinsic;
}

Result<RadialFit> RadialFromIntrinsic(const Intrinsic& intrinsic,
                                      RadialForm form) {
  if (const auto exact = ExactCamera(intrinsic, form)) return RadialFit{*exact};
  // Of the diagonal: a pixel or two of a photograph.
  constexpr double kMaxError = 1e-3;
  if (intrinsic.model != CameraModel::kSpherical) {
    const RadialFit fit = Fit(intrinsic, form);
    if (fit.error_px <= kMaxError * intrinsic.ImageDiagonal()) return fit;
  }
  return MakeError(
      ErrorCode::kUnsupported,
      std::string("a camera (") + CameraModelName(intrinsic.model) +
          ") cannot be approximated well by one focal length and " +
          (form == RadialForm::kDistorts ? "k1, k2" : "one k"));
}

}  // namespace lowlap::bundler
