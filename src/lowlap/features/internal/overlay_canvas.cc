#include "lowlap/features/internal/overlay_canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

// Positions are drawn to 1/16 pixel.
constexpr int kShift = 4;

cv::Point Fixed(const Vec2& position_px, const OverlayCanvas::Place& place) {
  const auto fixed = [&](double at, int corner_px) {
    const double on_canvas = corner_px + place.scale * (at + 0.5) - 0.5;
    return static_cast<int>(std::lround(on_canvas * (1 << kShift)));
  };
  return {fixed(position_px.x(), place.left_px), fixed(position_px.y(), 0)};
}

}  // namespace

OverlayCanvas::OverlayCanvas(int width_px, int height_px)
    : canvas_(height_px, width_px, CV_8UC3, cv::Scalar::all(255)) {}

void OverlayCanvas::AddImage(const GrayImage& image, const Place& place) {
  const auto scaled = [&](int size) {
    return std::max(1, static_cast<int>(std::lround(size * place.scale)));
  };
  cv::Mat gray = AsMat(image);
  if (place.scale != 1) {
    cv::Mat small;
    cv::resize(gray, small, {scaled(image.width), scaled(image.height)}, 0, 0,
               cv::INTER_AREA);
    gray = small;
  }
  cv::Mat faded, color;
  gray.convertTo(faded, CV_8U, 0.5, 110);
  cv::cvtColor(faded, color, cv::COLOR_GRAY2BGR);
  color.copyTo(canvas_({place.left_px, 0, color.cols, color.rows}));
}

void OverlayCanvas::AddPoint(const Vec2& position_px, const Place& place,
                             const cv::Scalar& color, double radius_px) {
  cv::circle(canvas_, Fixed(position_px, place),
             static_cast<int>(std::lround(radius_px * (1 << kShift))), color,
             cv::FILLED, cv::LINE_AA, kShift);
}

void OverlayCanvas::AddSegment(const LineSegment& segment, const Place& place,
                               const cv::Scalar& color, int width_px) {
  cv::line(canvas_, Fixed(segment.start_px, place),
           Fixed(segment.end_px, place), color, width_px, cv::LINE_AA, kShift);
}

void OverlayCanvas::AddLink(const Vec2& from_px, const Place& from,
                            const Vec2& to_px, const Place& to,
                            const cv::Scalar& color) {
  cv::line(canvas_, Fixed(from_px, from), Fixed(to_px, to), color, 1,
           cv::LINE_AA, kShift);
}

int OverlayCanvas::LineWidthPx() const {
  return std::max(1, (canvas_.cols + canvas_.rows) / 1500);
}

std::string OverlayCanvas::EncodePng() const {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", canvas_, png);
  return {png.begin(), png.end()};
}

cv::Scalar ColorOf(std::size_t index) {
  const double hue = std::fmod(0.618034 * static_cast<double>(index), 1.0) * 6;
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue, 6.0);
    return 230 * (1 - std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  };
  return {channel(1), channel(3), channel(5)};
}

}  // namespace lowlap
