#include "lowlap/features/internal/points/point_localization.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace lowlap {
namespace {

constexpr int kHalf = 4;  // gradients on a grid of 2 kHalf + 1 samples a side
constexpr double kMaxVariance = 100;

// Bilinear; the border is continued outwards.
double Sample(const GrayImage& image, double x, double y) {
  x = std::clamp(x, 0.0, image.width - 1.001);
  y = std::clamp(y, 0.0, image.height - 1.001);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const double fx = x - column, fy = y - row;
  const std::uint8_t* p = image.pixels.data() +
                          static_cast<std::size_t>(row) * image.width + column;
  return (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) +
         fy * ((1 - fx) * p[image.width] + fx * p[image.width + 1]);
}

// Gaussian weights of the grid of gradients.
struct GridWeights {
  double at[2 * kHalf + 1][2 * kHalf + 1];

  GridWeights() {
    for (int row = 0; row <= 2 * kHalf; ++row) {
      for (int column = 0; column <= 2 * kHalf; ++column) {
        const double dx = (column - kHalf) / (0.5 * kHalf);
        const double dy = (row - kHalf) / (0.5 * kHalf);
        at[row][column] = std::exp(-0.5 * (dx * dx + dy * dy));
      }
    }
  }
};

Mat2 StructureTensor(const GrayImage& image, const Vec2& position_px,
                     double scale_px) {
  static const GridWeights weights;
  constexpr int kSide = 2 * kHalf + 3;
  // The window reaches two standard deviations of the blob.
  const double spacing = std::max(1.0, 2 * scale_px / kHalf);
  double grid[kSide][kSide];
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      grid[row][column] =
          Sample(image, position_px.x() + spacing * (column - kHalf - 1),
                 position_px.y() + spacing * (row - kHalf - 1));
    }
  }
  Mat2 tensor = Mat2::Zero();
  for (int row = 1; row + 1 < kSide; ++row) {
    for (int column = 1; column + 1 < kSide; ++column) {
      const Vec2 gradient(grid[row][column + 1] - grid[row][column - 1],
                          grid[row + 1][column] - grid[row - 1][column]);
      tensor +=
          weights.at[row - 1][column - 1] * gradient * gradient.transpose();
    }
  }
  return tensor;
}

}  // namespace

Mat2 LocalizationCovariance(const GrayImage& image, const Vec2& position_px,
                            double scale_px) {
  const Eigen::SelfAdjointEigenSolver<Mat2> solver(
      StructureTensor(image, position_px, scale_px));
  const double weak = solver.eigenvalues()(0);
  const double strong = solver.eigenvalues()(1);
  if (!(strong > 0)) return Mat2::Identity();
  const double variance =
      std::min(kMaxVariance, strong / std::max(weak, 1e-12 * strong));
  const Vec2 along = solver.eigenvectors().col(0);
  return Mat2::Identity() + (variance - 1) * along * along.transpose();
}

}  // namespace lowlap
