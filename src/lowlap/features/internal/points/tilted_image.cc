#include "lowlap/features/internal/points/tilted_image.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

cv::Mat AffineMat(const Mat2& linear, const Vec2& offset) {
  return (cv::Mat_<double>(2, 3) << linear(0, 0), linear(0, 1), offset.x(),
          linear(1, 0), linear(1, 1), offset.y());
}

cv::Mat Warped(const cv::Mat& image, const Mat2& linear, const Vec2& offset,
               const cv::Size& size) {
  cv::Mat warped;
  cv::warpAffine(image, warped, AffineMat(linear, offset), size,
                 cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return warped;
}

// The standard deviation of the blur before an image is compressed so much.
double BlurBefore(double compression) {
  return 0.8 * std::sqrt(compression * compression - 1);
}

// Maps the corners of the image to the first quadrant, as tightly as it goes.
Vec2 OffsetToOrigin(const GrayImage& image, const Mat2& linear, Vec2* extent) {
  const double right = image.width - 1, bottom = image.height - 1;
  Eigen::Matrix<double, 2, 4> corners;
  corners << 0, right, 0, right, 0, 0, bottom, bottom;
  const Eigen::Matrix<double, 2, 4> mapped = linear * corners;
  const Vec2 low = mapped.rowwise().minCoeff();
  *extent = mapped.rowwise().maxCoeff() - low;
  return -low;
}

cv::Size SizeOf(const Vec2& extent) {
  return {static_cast<int>(std::floor(extent.x())) + 1,
          static_cast<int>(std::floor(extent.y())) + 1};
}

}  // namespace

Result<TiltedImage> TiltImage(const GrayImage& image, double scale, double tilt,
                              double turn_rad) {
  return CatchOpenCv("tilted image", [&]() -> Result<TiltedImage> {
    const SingleThreadedOpenCv single_threaded;
    cv::Mat pixels = AsMat(image);
    if (scale < 1) {
      cv::Mat blurred;
      cv::GaussianBlur(pixels, blurred, {}, BlurBefore(1 / scale));
      pixels = blurred;
    }
    Vec2 extent;
    const Mat2 turned = scale * Eigen::Rotation2Dd(turn_rad).toRotationMatrix();
    const Vec2 turned_offset = OffsetToOrigin(image, turned, &extent);
    pixels = Warped(pixels, turned, turned_offset, SizeOf(extent));
    if (tilt > 1) {
      cv::GaussianBlur(pixels, pixels, {0, 1}, BlurBefore(tilt), 1);
    }
    const Mat2 compressed = Vec2(1 / tilt, 1).asDiagonal();
    extent.x() /= tilt;
    pixels = Warped(pixels, compressed, Vec2::Zero(), SizeOf(extent));

    TiltedImage result;
    result.linear = compressed * turned;
    result.offset_px = compressed * turned_offset;
    result.image.width = pixels.cols;
    result.image.height = pixels.rows;
    result.image.pixels.assign(pixels.datastart, pixels.dataend);
    return result;
  });
}

Keypoint Untilted(const Keypoint& keypoint, const TiltedImage& tilted) {
  const Mat2 image_from_tilted = tilted.linear.inverse();
  Keypoint result;
  result.position_px =
      image_from_tilted * (keypoint.position_px - tilted.offset_px);
  result.scale_px =
      keypoint.scale_px * std::sqrt(std::abs(image_from_tilted.determinant()));
  const Vec2 direction = image_from_tilted * Vec2(std::cos(keypoint.angle_rad),
                                                  std::sin(keypoint.angle_rad));
  result.angle_rad = std::atan2(direction.y(), direction.x());
  if (result.angle_rad < 0) result.angle_rad += 2 * kPi;
  result.covariance =
      image_from_tilted * keypoint.covariance * image_from_tilted.transpose();
  return result;
}

}  // namespace lowlap
