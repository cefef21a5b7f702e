#include "lowlap/features/internal/undistorted_image.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

// Where the border of the photograph lies without distortion, relative to the
// principal point, in pixels of the pinhole.
Eigen::AlignedBox2d UndistortedExtent(const Intrinsic& intrinsic) {
  const Vec2 size(intrinsic.width_px, intrinsic.height_px);
  Eigen::AlignedBox2d extent(Vec2::Zero(), Vec2::Zero());
  const auto include = [&](double x, double y) {
    // Beyond the fold of the distortion lies more than can be shown.
    const std::optional<Vec2> p = intrinsic.Normalize({x, y});
    if (p) {
      extent.extend(Vec2(intrinsic.fx_px * p->x(), intrinsic.fy_px * p->y()));
    }
  };
  for (int x = 0; x < intrinsic.width_px; ++x) {
    include(x, 0);
    include(x, intrinsic.height_px - 1);
  }
  for (int y = 0; y < intrinsic.height_px; ++y) {
    include(0, y);
    include(intrinsic.width_px - 1, y);
  }
  // Pixels of the border may lie beyond the fold: the photograph's own size
  // about the principal point is shown in any case, and twice it at most.
  const Vec2 pp = intrinsic.principal_point_px;
  extent.extend(-pp);
  extent.extend(size - pp);
  extent.min() = extent.min().cwiseMax(-size);
  extent.max() = extent.max().cwiseMin(size);
  return extent;
}

}  // namespace

Result<UndistortedImage> UndistortedImage::Make(const GrayImage& distorted,
                                                const Intrinsic& intrinsic) {
  LOWLAP_RETURN_IF_ERROR(distorted.Validate());
  if (intrinsic.model == CameraModel::kSpherical) {
    return MakeError(ErrorCode::kUnsupported,
                     "a panorama cannot be undistorted to a pinhole image");
  }
  if (distorted.width != intrinsic.width_px ||
      distorted.height != intrinsic.height_px) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "image and intrinsic differ in size");
  }
  const Eigen::AlignedBox2d extent = UndistortedExtent(intrinsic);
  const Vec2 origin_px = (-extent.min()).array().ceil();
  GrayImage image;
  image.width = static_cast<int>(std::ceil(extent.max().x() + origin_px.x()));
  image.height = static_cast<int>(std::ceil(extent.max().y() + origin_px.y()));
  image.pixels.resize(static_cast<std::size_t>(image.width) * image.height);
  UndistortedImage result(std::move(image), intrinsic, origin_px);
  const Status done = CatchOpenCv("undistortion", [&]() -> Status {
    const SingleThreadedOpenCv single_threaded;
    const cv::Size size(result.image_.width, result.image_.height);
    cv::Mat map(size, CV_32FC2);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const Vec2 p = result.PixelToDistorted(Vec2(x, y));
        map.at<cv::Vec2f>(y, x) = {static_cast<float>(p.x()),
                                   static_cast<float>(p.y())};
      }
    }
    cv::Mat target(size, CV_8UC1, result.image_.pixels.data());
    // Repeated border pixels make no edge along the border.
    cv::remap(AsMat(distorted), target, map, cv::noArray(), cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
    return {};
  });
  if (!done) return tl::unexpected<Error>(done.error());
  return result;
}

Vec2 UndistortedImage::PixelToDistorted(const Vec2& pixel_px) const {
  const Vec2 p = pixel_px - origin_px_;
  return intrinsic_.Project(
      Vec3(p.x() / intrinsic_.fx_px, p.y() / intrinsic_.fy_px, 1));
}

std::optional<LineSegment> UndistortedImage::ToDistorted(
    const LineSegment& segment) const {
  const auto at = [&](double t) -> Vec2 {
    return segment.start_px + t * (segment.end_px - segment.start_px);
  };
  // In the photograph, and on the side of the distortion's fold that its
  // pixels come from.
  const auto is_seen = [&](double t) {
    const Vec2 raw = PixelToDistorted(at(t));
    if (!(raw.x() >= 0 && raw.y() >= 0 && raw.x() <= intrinsic_.width_px - 1 &&
          raw.y() <= intrinsic_.height_px - 1)) {
      return false;
    }
    const std::optional<Vec2> back = intrinsic_.Normalize(raw);
    if (!back) return false;
    const Vec2 pixel =
        Vec2(intrinsic_.fx_px * back->x(), intrinsic_.fy_px * back->y()) +
        origin_px_;
    return (pixel - at(t)).norm() < 0.5;
  };
  // The longest run of samples that are seen, then its ends by bisection.
  constexpr int kSamples = 33;
  int best_begin = 0, best_end = -1;
  for (int n = 0, begin = 0; n <= kSamples; ++n) {
    if (n < kSamples && is_seen(n / (kSamples - 1.0))) {
      if (n - begin > best_end - best_begin) best_begin = begin, best_end = n;
    } else {
      begin = n + 1;
    }
  }
  if (best_end <= best_begin) return std::nullopt;
  const auto bisect = [&](double seen, double unseen) {
    for (int n = 0; n < 20; ++n) {
      const double middle = 0.5 * (seen + unseen);
      (is_seen(middle) ? seen : unseen) = middle;
    }
    return seen;
  };
  const double step = 1 / (kSamples - 1.0);
  const double t0 =
      best_begin == 0 ? 0 : bisect(best_begin * step, (best_begin - 1) * step);
  const double t1 = best_end == kSamples - 1
                        ? 1
                        : bisect(best_end * step, (best_end + 1) * step);

  LineSegment moved = segment;
  moved.start_px = PixelToDistorted(at(t0));
  moved.end_px = PixelToDistorted(at(t1));
  const Vec2 along = (segment.end_px - segment.start_px).normalized();
  const Vec2 across(-along.y(), along.x());
  const Vec2 middle = at(0.5 * (t0 + t1));
  moved.stddev_px *= (PixelToDistorted(middle + 0.5 * across) -
                      PixelToDistorted(middle - 0.5 * across))
                         .norm();
  return moved;
}

}  // namespace lowlap
