#include "lowlap/features/internal/points/point_detector.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/features2d.hpp>
#include <tuple>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/features/internal/opencv.h"
#include "lowlap/features/internal/points/point_memory.h"

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

// Below this side the pyramid of SIFT has no level to look for a blob in.
constexpr int kMinSidePx = 16;
// The cells of the selection grid get about this many points each.
constexpr double kPointsPerCell = 20;
// Share of the selection that goes by strength alone. Measured on photographs
// of facades: an even selection alone loses a third of the matches.
constexpr double kStrongestShare = 0.75;
// OpenCV's SIFT doubles the image with pixel centres at 2 x + 0.5, but maps
// positions back by a mere division: they come out a quarter pixel too far.
constexpr double kDoublingOffsetPx = 0.25;

bool PositionOrder(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  return std::tie(a.pt.y, a.pt.x, a.size, a.angle, a.response, a.octave) <
         std::tie(b.pt.y, b.pt.x, b.size, b.angle, b.response, b.octave);
}

// Keeps `max_points` of `keypoints`: first the strongest of the image, which
// are the most repeatable; then, in rounds, the strongest of every cell of a
// grid, the second strongest, and so on. Order is kept.
void SelectPoints(const cv::Size& image, int max_points,
                  std::vector<cv::KeyPoint>* keypoints) {
  const std::size_t count = keypoints->size();
  const auto wanted = static_cast<std::size_t>(max_points);
  if (count <= wanted) return;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const float ra = (*keypoints)[a].response, rb = (*keypoints)[b].response;
    return ra != rb ? ra > rb : a < b;
  });

  const int cells =
      std::max(1, static_cast<int>(std::sqrt(max_points / kPointsPerCell)));
  const double cell_px =
      std::max(image.width, image.height) / static_cast<double>(cells);
  const auto num_strongest =
      static_cast<std::size_t>(kStrongestShare * max_points);
  std::vector<int> taken(static_cast<std::size_t>(cells) * cells, 0);
  std::vector<int> round(count, 0);
  for (std::size_t rank = 0; rank < count; ++rank) {
    const cv::Point2f& p = (*keypoints)[order[rank]].pt;
    const int column =
        std::clamp(static_cast<int>(p.x / cell_px), 0, cells - 1);
    const int row = std::clamp(static_cast<int>(p.y / cell_px), 0, cells - 1);
    const int before = taken[row * cells + column]++;
    if (rank >= num_strongest) round[order[rank]] = before;
  }
  std::stable_sort(
      order.begin() + static_cast<std::ptrdiff_t>(num_strongest), order.end(),
      [&](std::size_t a, std::size_t b) { return round[a] < round[b]; });
  order.resize(wanted);
  std::sort(order.begin(), order.end());
  std::vector<cv::KeyPoint> selected;
  selected.reserve(wanted);
  for (const std::size_t i : order) selected.push_back((*keypoints)[i]);
  *keypoints = std::move(selected);
}

PointDescriptor RootSift(const float* sift) {
  float sum = 0;
  for (int i = 0; i < 128; ++i) sum += sift[i];
  PointDescriptor root{};
  if (!(sum > 0)) return root;
  for (int i = 0; i < 128; ++i) {
    const float value = 512.0f * std::sqrt(sift[i] / sum);
    root[i] =
        static_cast<std::uint8_t>(std::min(255.0f, std::floor(value + 0.5f)));
  }
  return root;
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

Status PointOptions::Validate() const {
  return Require({{max_points >= 1, "max_points must be at least 1"},
                  {contrast_threshold >= 0 && contrast_threshold < 1,
                   "contrast_threshold must lie in [0, 1)"},
                  {edge_threshold >= 1 && std::isfinite(edge_threshold),
                   "edge_threshold must be at least 1"}});
}

Result<PointFeatures> DetectPoints(const GrayImage& image,
                                   const PointOptions& options) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_RETURN_IF_ERROR(image.Validate());
  if (std::min(image.width, image.height) < kMinSidePx) return PointFeatures{};
  LOWLAP_RETURN_IF_ERROR(CheckMemoryOfPoints(image.width, image.height, {}));
  return CatchOpenCv("SIFT", [&]() -> Result<PointFeatures> {
    const SingleThreadedOpenCv single_threaded;
    const cv::Ptr<cv::SIFT> sift = cv::SIFT::create(
        0, 3, options.contrast_threshold, options.edge_threshold, 1.6, CV_32F);
    std::vector<cv::KeyPoint> all;
    cv::Mat sift_descriptors;
    sift->detectAndCompute(AsMat(image), cv::noArray(), all, sift_descriptors);
    // class_id remembers the row of the descriptor.
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].class_id = static_cast<int>(i);
    }
    std::sort(all.begin(), all.end(), PositionOrder);
    SelectPoints(cv::Size(image.width, image.height), options.max_points, &all);

    PointFeatures features;
    features.keypoints.reserve(all.size());
    features.descriptors.reserve(all.size());
    for (const cv::KeyPoint& point : all) {
      Keypoint keypoint;
      keypoint.position_px =
          Vec2(point.pt.x - kDoublingOffsetPx, point.pt.y - kDoublingOffsetPx);
      keypoint.scale_px = 0.5 * point.size;
      keypoint.angle_rad = RadFromDeg(point.angle);
      keypoint.covariance = LocalizationCovariance(image, keypoint.position_px,
                                                   keypoint.scale_px);
      features.keypoints.push_back(keypoint);
      features.descriptors.push_back(
          RootSift(sift_descriptors.ptr<float>(point.class_id)));
    }
    return features;
  });
}

}  // namespace lowlap
