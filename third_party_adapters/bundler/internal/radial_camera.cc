#include "third_party_adapters/bundler/internal/radial_camera.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/format.h"

namespace lowlap::bundler {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A place of the image before and after a distortion or its inverse, in focal
/// lengths off the principal point.
struct Sample {
  Vec2 from, to;
};

/// Fits to = from (1 + k[0] r^2 + k[1] r^4 + ...), r = |from|, by least squares
/// over the coefficients but the first `num_known`. The largest error, infinite
/// if there is no fit.
double FitSeries(const std::vector<Sample>& samples, Eigen::Index num_known,
                 Eigen::VectorXd* k) {
  Eigen::MatrixXd a(2 * samples.size(), k->size());
  Eigen::VectorXd b(2 * samples.size());
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const auto& [from, to] = samples[n];
    Vec2 term = from;
    for (Eigen::Index power = 0; power < k->size(); ++power) {
      term *= from.squaredNorm();
      a.block<2, 1>(2 * n, power) = term;
    }
    b.segment<2>(2 * n) = to - from;
  }
  if (const Eigen::Index num_free = k->size() - num_known; num_free > 0) {
    k->tail(num_free) = a.rightCols(num_free).colPivHouseholderQr().solve(
        b - a.leftCols(num_known) * k->head(num_known));
  }
  const Eigen::VectorXd residual = a * *k - b;
  if (!residual.allFinite()) return kInfinity;
  double error = 0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    error = std::max(error, residual.segment<2>(2 * n).norm());
  }
  return error;
}

// Fits reach to radii in steps, so that the writer finds a reader's fit again
// without its measurements.
constexpr int kStepsPerOctave = 16;
constexpr int kLastStep = 4 * kStepsPerOctave;  // 86 degrees off the axis

/// The first step that reaches so far.
int StepOfReach(double d, double reach) {
  // Fits over less would be of rounding errors.
  constexpr double kSmallestChange = 1e-3;
  reach =
      std::max(reach, std::min(1.0, std::sqrt(kSmallestChange / std::abs(d))));
  return static_cast<int>(
      std::ceil(std::min(kStepsPerOctave * std::log2(reach), kLastStep + 1.0)));
}

struct Inverse {
  std::vector<double> k;
  double error = kInfinity;
};

/// k1, k2, k3 of the inverse of x = x_d (1 + d r_d^2) up to a step. k1 is that
/// of the inverse's series, which tells d.
Inverse InverseUpTo(int step, double d) {
  const double reach = std::exp2(step / double{kStepsPerOctave});
  Eigen::VectorXd k = Eigen::Vector3d(-d, 0, 0);
  Inverse inverse;
  // Beyond the last step, or where the formula folds, there is none.
  if (step <= kLastStep && 1 + 3 * d * reach * reach > 0) {
    // Dense at the end, where least squares would be worst.
    constexpr int kSamples = 24;
    std::vector<Sample> samples;
    for (int n = 1; n <= kSamples; ++n) {
      const double r = reach * std::sin(0.5 * kPi * n / kSamples);
      samples.push_back({{r * (1 + d * r * r), 0}, {r, 0}});
    }
    inverse.error = FitSeries(samples, 1, &k);
  }
  inverse.k.assign(k.begin(), k.end());
  return inverse;
}

/// Whether coefficients are those of InverseUpTo some step, for d = -k1.
bool IsInverse(const std::vector<double>& k) {
  for (int step = StepOfReach(-k[0], 0); step <= kLastStep; ++step) {
    if (InverseUpTo(step, -k[0]).k == k) return true;
  }
  return false;
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
    if (!is_k3 || !IsInverse(k)) return std::nullopt;
    camera.k[0] = -k[0];
  } else {
    if (!is_k1 && !(is_k3 && k[2] == 0)) return std::nullopt;
    camera.k = {k[0], is_k3 ? k[1] : 0.0};
  }
  return camera;
}

std::vector<Sample> SamplesOf(const Intrinsic& intrinsic, RadialForm form) {
  constexpr int kSteps = 16;
  std::vector<Sample> samples;
  for (int row = 0; row <= kSteps; ++row) {
    for (int column = 0; column <= kSteps; ++column) {
      const Vec2 pixel(intrinsic.width_px * (column / double{kSteps}),
                       intrinsic.height_px * (row / double{kSteps}));
      if (const auto undistorted = intrinsic.Normalize(pixel)) {
        const Vec2 measured =
            (pixel - intrinsic.principal_point_px) / intrinsic.MeanFocalPx();
        samples.push_back(form == RadialForm::kDistorts
                              ? Sample{*undistorted, measured}
                              : Sample{measured, *undistorted});
      }
    }
  }
  return samples;
}

RadialFit Fit(const Intrinsic& intrinsic, RadialForm form) {
  RadialFit fit;
  fit.camera.focal_px = intrinsic.MeanFocalPx();
  Eigen::VectorXd k =
      Eigen::VectorXd::Zero(form == RadialForm::kDistorts ? 2 : 1);
  // Two focal lengths alone are no distortion.
  const bool is_pinhole = intrinsic.model == CameraModel::kPinhole;
  fit.error_px = fit.camera.focal_px * FitSeries(SamplesOf(intrinsic, form),
                                                 is_pinhole ? k.size() : 0, &k);
  std::copy(k.begin(), k.end(), fit.camera.k.begin());
  return fit;
}

}  // namespace

IntrinsicFit IntrinsicFromRadial(const RadialCamera& camera, RadialForm form,
                                 double reach) {
  IntrinsicFit fit;
  Intrinsic& intrinsic = fit.intrinsic;
  intrinsic.fx_px = intrinsic.fy_px = camera.focal_px;
  const auto& k = camera.k;
  if (k[0] == 0 && k[1] == 0) return fit;
  intrinsic.model = CameraModel::kRadialK3;
  if (form == RadialForm::kDistorts) {
    intrinsic.distortion = {k[0], k[1], 0};
  } else {
    Inverse inverse = InverseUpTo(StepOfReach(k[0], reach), k[0]);
    intrinsic.distortion = std::move(inverse.k);
    fit.error_px = inverse.error * camera.focal_px;
  }
  return fit;
}

Result<RadialFit> RadialFromIntrinsic(const Intrinsic& intrinsic,
                                      RadialForm form) {
  if (const auto exact = ExactCamera(intrinsic, form)) return RadialFit{*exact};
  if (intrinsic.model != CameraModel::kSpherical) {
    const RadialFit fit = Fit(intrinsic, form);
    if (IsCloseFit(fit.error_px, intrinsic)) return fit;
  }
  return MakeError(
      ErrorCode::kUnsupported,
      std::string("a camera (") + CameraModelName(intrinsic.model) +
          ") cannot be approximated well by one focal length and " +
          (form == RadialForm::kDistorts ? "k1, k2" : "one k"));
}

bool IsCloseFit(double error_px, const Intrinsic& intrinsic) {
  // Of the diagonal: a pixel or two of a photograph.
  constexpr double kMaxError = 1e-3;
  return error_px <= kMaxError * intrinsic.ImageDiagonal();
}

}  // namespace lowlap::bundler
