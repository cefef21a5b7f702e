#include "lowlap/features/internal/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <ostream>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

// Positions are drawn to 1/16 pixel.
constexpr int kShift = 4;

cv::Point Fixed(const Vec2& p) {
  return {static_cast<int>(std::lround(p.x() * (1 << kShift))),
          static_cast<int>(std::lround(p.y() * (1 << kShift)))};
}

// Distinct for neighbouring indices: the hue turns by the golden ratio.
cv::Scalar ColorOf(std::size_t index) {
  const double hue = std::fmod(0.618034 * static_cast<double>(index), 1.0) * 6;
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue, 6.0);
    return 230 * (1 - std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  };
  return {channel(1), channel(3), channel(5)};
}

cv::Mat Draw(const cv::Mat& gray, const ViewFeatures& features) {
  cv::Mat faded;
  gray.convertTo(faded, CV_8U, 0.5, 110);
  cv::Mat canvas;
  cv::cvtColor(faded, canvas, cv::COLOR_GRAY2BGR);
  const int width = std::max(1, (gray.cols + gray.rows) / 1500);
  for (const Vec2& point : features.points_px) {
    cv::circle(canvas, Fixed(point), width << kShift, {40, 140, 0}, cv::FILLED,
               cv::LINE_AA, kShift);
  }
  for (std::size_t i = 0; i < features.segments.size(); ++i) {
    const LineSegment& segment = features.segments[i];
    const cv::Scalar color = ColorOf(i);
    cv::line(canvas, Fixed(segment.start_px), Fixed(segment.end_px), color,
             width, cv::LINE_AA, kShift);
    cv::circle(canvas, Fixed(segment.end_px), (2 * width) << kShift, color,
               cv::FILLED, cv::LINE_AA, kShift);
  }
  return canvas;
}

}  // namespace

Status WriteOverlay(const GrayImage& image, const ViewFeatures& features,
                    const std::string& path) {
  if (const Status s = image.Validate(); !s) return s;
  std::vector<std::uint8_t> png;
  const auto encode = [&]() -> Status {
    const SingleThreadedOpenCv single_threaded;
    cv::imencode(".png", Draw(AsMat(image), features), png);
    return {};
  };
  if (const Status s = CatchOpenCv("overlay", encode); !s) return s;
  return WriteFileAtomically(
      path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace lowlap
