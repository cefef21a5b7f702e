#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// A picture that features are drawn into: faded images on a common canvas,
/// each with a place and a scale of its own. Not for OpenCV's own threads (see
/// SingleThreadedOpenCv), and it may throw what OpenCV throws.
class OverlayCanvas {
 public:
  OverlayCanvas(int width_px, int height_px);

  /// Where an image lies: canvas pixel = corner + scale (image pixel + 0.5) -
  /// 0.5.
  struct Place {
    int left_px = 0;
    double scale = 1;
  };

  /// The image, faded, from the top at `place`.
  void AddImage(const GrayImage& image, const Place& place);
  void AddPoint(const Vec2& position_px, const Place& place,
                const cv::Scalar& color, double radius_px);
  void AddSegment(const LineSegment& segment, const Place& place,
                  const cv::Scalar& color, int width_px);
  /// From a position in one image to one in another.
  void AddLink(const Vec2& from_px, const Place& from, const Vec2& to_px,
               const Place& to, const cv::Scalar& color);

  /// Of lines, so that they can be seen in a large picture, too.
  int LineWidthPx() const;
  std::string EncodePng() const;

 private:
  cv::Mat canvas_;
};

/// Distinct for neighbouring indices: the hue turns by the golden ratio.
cv::Scalar ColorOf(std::size_t index);

}  // namespace lowlap
