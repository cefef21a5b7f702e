#include "lowlap/matching/internal/points/patch_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/requirement.h"

namespace lowlap {
namespace {

constexpr double kStepPerScale = 0.5;
// Standard deviation of the weights, in steps of the grid.
constexpr double kWeightStddev = 5;
constexpr double kMaxDeformation = 2;
// The residuals of neighbouring samples are alike: the variances that they
// would have if independent, times this. Measured on photographs.
constexpr double kVarianceFactor = 2;
constexpr int kMinLevelSidePx = 32;

using Vec8 = Eigen::Matrix<double, 8, 1>;
using Mat8 = Eigen::Matrix<double, 8, 8>;

// Catmull-Rom weights of the four neighbours; f in [0, 1).
std::array<double, 4> CubicWeights(double f) {
  const double f2 = f * f, f3 = f2 * f;
  return {0.5 * (-f3 + 2 * f2 - f), 0.5 * (3 * f3 - 5 * f2 + 2),
          0.5 * (-3 * f3 + 4 * f2 + f), 0.5 * (f3 - f2)};
}

// A patch prepared for alignment: its inner grid, whose gradients are known.
struct Template {
  static constexpr int kInner = PointPatch::kRadius - 1;
  static constexpr int kCount = (2 * kInner + 1) * (2 * kInner + 1);
  std::array<Vec2, kCount> places;
  std::array<double, kCount> weights;
  // Derivatives by (A - I) column by column, t; then grey value and 1.
  std::array<Vec8, kCount> rows;
  Mat8 information = Mat8::Zero();
};

Template Prepare(const PointPatch& patch) {
  Template result;
  int n = 0;
  for (int y = -Template::kInner; y <= Template::kInner; ++y) {
    for (int x = -Template::kInner; x <= Template::kInner; ++x, ++n) {
      const auto at = [&](int dx, int dy) -> double {
        return patch.values[(y + dy + PointPatch::kRadius) * PointPatch::kSide +
                            x + dx + PointPatch::kRadius];
      };
      const double gx = 0.5 * (at(1, 0) - at(-1, 0));
      const double gy = 0.5 * (at(0, 1) - at(0, -1));
      result.places[n] = Vec2(x, y);
      result.weights[n] = std::exp(-0.5 * result.places[n].squaredNorm() /
                                   (kWeightStddev * kWeightStddev));
      result.rows[n] << gx * x, gy * x, gx * y, gy * y, gx, gy, at(0, 0), 1;
      result.information +=
          result.weights[n] * result.rows[n] * result.rows[n].transpose();
    }
  }
  return result;
}

// Weighted normalised cross-correlation.
double Correlation(const Template& patch,
                   const std::array<double, Template::kCount>& values) {
  double w = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int n = 0; n < Template::kCount; ++n) {
    const double weight = patch.weights[n];
    const double t = patch.rows[n][6], v = values[n];
    w += weight;
    a += weight * t;
    b += weight * v;
    aa += weight * t * t;
    bb += weight * v * v;
    ab += weight * t * v;
  }
  const double variances = (aa - a * a / w) * (bb - b * b / w);
  return variances > 0 ? (ab - a * b / w) / std::sqrt(variances) : 0;
}

// Of the shift times the gain, in the patch's frame: the variance of the
// residuals over the information.
Mat2 ShiftCovariance(const Template& patch, const Eigen::LDLT<Mat8>& solver,
                     const std::array<double, Template::kCount>& values,
                     const Vec8& fit) {
  double sum = 0, weights = 0;
  for (int n = 0; n < Template::kCount; ++n) {
    const double residual = values[n] - patch.rows[n].dot(fit);
    sum += patch.weights[n] * residual * residual;
    weights += patch.weights[n];
  }
  Eigen::Matrix<double, 8, 2> shift = Eigen::Matrix<double, 8, 2>::Zero();
  shift.block<2, 2>(4, 0).setIdentity();
  return kVarianceFactor * sum / weights *
         Mat2(solver.solve(shift).block<2, 2>(4, 0));
}

// The mean of the keypoint and of where it was aligned, each by its
// covariance.
std::optional<Vec2> Combine(const Keypoint& keypoint, const Vec2& aligned_px,
                            const Mat2& aligned_covariance,
                            const PatchAlignmentOptions& options) {
  const double stddev_px = options.keypoint_stddev * keypoint.scale_px;
  const Mat2 prior = stddev_px * stddev_px * Mat2::Identity();
  const Vec2 shift = aligned_px - keypoint.position_px;
  const Vec2 weighted = (prior + aligned_covariance).inverse() * shift;
  if (!(shift.dot(weighted) <= options.max_deviation * options.max_deviation)) {
    return std::nullopt;
  }
  return keypoint.position_px + prior * weighted;
}

bool DeformsLittle(const Mat2& affine, const Mat2& similarity) {
  const Mat2 change = similarity.inverse() * affine;
  const Vec2 stretch = change.jacobiSvd().singularValues();
  return change.determinant() > 0 && stretch[0] < kMaxDeformation &&
         stretch[1] > 1 / kMaxDeformation;
}

}  // namespace

GrayPyramid::GrayPyramid(const GrayImage& image) {
  levels_.push_back(
      {image.width, image.height,
       std::vector<float>(image.pixels.begin(), image.pixels.end())});
  while (std::min(levels_.back().width, levels_.back().height) >=
         2 * kMinLevelSidePx) {
    const Level& fine = levels_.back();
    Level half;
    half.width = fine.width / 2;
    half.height = fine.height / 2;
    half.values.reserve(static_cast<std::size_t>(half.width) * half.height);
    for (int y = 0; y < half.height; ++y) {
      const float* row =
          fine.values.data() + static_cast<std::size_t>(2 * y) * fine.width;
      for (int x = 0; x < half.width; ++x) {
        half.values.push_back(0.25f * (row[2 * x] + row[2 * x + 1] +
                                       row[fine.width + 2 * x] +
                                       row[fine.width + 2 * x + 1]));
      }
    }
    levels_.push_back(std::move(half));
  }
}

int GrayPyramid::LevelOf(double step_px) const {
  int level = 0;
  while (level + 1 < static_cast<int>(levels_.size()) &&
         std::ldexp(1.0, level + 1) <= step_px) {
    ++level;
  }
  return level;
}

std::optional<double> GrayPyramid::Sample(int level,
                                          const Vec2& position_px) const {
  const Level& l = levels_[level];
  const double pixels = std::ldexp(1.0, level);
  const double x = (position_px.x() + 0.5) / pixels - 0.5;
  const double y = (position_px.y() + 0.5) / pixels - 0.5;
  if (!(x >= 1 && y >= 1 && x < l.width - 2 && y < l.height - 2)) {
    return std::nullopt;
  }
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const std::array<double, 4> wx = CubicWeights(x - column);
  const std::array<double, 4> wy = CubicWeights(y - row);
  double value = 0;
  for (int j = 0; j < 4; ++j) {
    const float* v = l.values.data() +
                     static_cast<std::size_t>(row - 1 + j) * l.width + column -
                     1;
    value +=
        wy[j] * (wx[0] * v[0] + wx[1] * v[1] + wx[2] * v[2] + wx[3] * v[3]);
  }
  return value;
}

std::optional<PointPatch> ExtractPatch(const GrayPyramid& image,
                                       const Keypoint& point) {
  PointPatch patch;
  patch.step_px = kStepPerScale * point.scale_px;
  const int level = image.LevelOf(patch.step_px);
  std::size_t n = 0;
  for (int y = -PointPatch::kRadius; y <= PointPatch::kRadius; ++y) {
    for (int x = -PointPatch::kRadius; x <= PointPatch::kRadius; ++x) {
      const std::optional<double> value =
          image.Sample(level, point.position_px + patch.step_px * Vec2(x, y));
      if (!value) return std::nullopt;
      patch.values[n++] = static_cast<float>(*value);
    }
  }
  return patch;
}

Status PatchAlignmentOptions::Validate() const {
  return Require(
      {{max_iterations >= 1, "max_iterations must be at least 1"},
       {min_step > 0 && std::isfinite(min_step), "min_step must be positive"},
       {min_correlation >= 0 && min_correlation < 1,
        "min_correlation must lie in [0, 1)"},
       {keypoint_stddev > 0 && std::isfinite(keypoint_stddev),
        "keypoint_stddev must be positive"},
       {max_deviation > 0 && std::isfinite(max_deviation),
        "max_deviation must be positive"}});
}

std::optional<Vec2> AlignPatch(const PointPatch& patch, const Keypoint& from,
                               const Keypoint& to, const GrayPyramid& image,
                               const PatchAlignmentOptions& options) {
  const Template reference = Prepare(patch);
  const Eigen::LDLT<Mat8> solver(reference.information);
  const double rcond = solver.rcond();
  if (solver.info() != Eigen::Success || !(rcond > 1e-12)) return std::nullopt;
  const double step_px = patch.step_px * to.scale_px / from.scale_px;
  const int level = image.LevelOf(step_px);
  const Mat2 similarity =
      step_px *
      Eigen::Rotation2Dd(to.angle_rad - from.angle_rad).toRotationMatrix();
  Mat2 affine = similarity;
  Vec2 middle = to.position_px;
  std::array<double, Template::kCount> values;
  for (int i = 0; i < options.max_iterations; ++i) {
    Vec8 right = Vec8::Zero();
    for (int n = 0; n < Template::kCount; ++n) {
      const std::optional<double> value =
          image.Sample(level, affine * reference.places[n] + middle);
      if (!value) return std::nullopt;
      values[n] = *value;
      right += reference.weights[n] * *value * reference.rows[n];
    }
    const Vec8 fit = solver.solve(right);
    const double gain = fit[6];
    if (!(gain > 0)) return std::nullopt;
    // I(W(u)) = g T(u + D u + d) + b: W goes on from the inverse of that map.
    const Mat2 change =
        Mat2::Identity() +
        (Mat2() << fit[0], fit[2], fit[1], fit[3]).finished() / gain;
    const Vec2 shift = fit.segment<2>(4) / gain;
    if (!(std::abs(change.determinant()) > 0.1)) return std::nullopt;
    affine = affine * change.inverse();
    middle -= affine * shift;
    if (!DeformsLittle(affine, similarity)) return std::nullopt;
    if (shift.norm() > options.min_step) continue;
    if (Correlation(reference, values) < options.min_correlation) break;
    const Mat2 covariance =
        affine *
        (ShiftCovariance(reference, solver, values, fit) / (gain * gain)) *
        affine.transpose();
    return Combine(to, middle, covariance, options);
  }
  return std::nullopt;
}

}  // namespace lowlap
