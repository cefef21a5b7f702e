#include "lowlap/features/internal/overlay.h"

#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/opencv.h"
#include "lowlap/features/internal/overlay_canvas.h"

namespace lowlap {
namespace {

using Place = OverlayCanvas::Place;

// Blue, green, red.
const cv::Scalar kPoint(40, 140, 0), kPalePoint(150, 165, 150);
const cv::Scalar kSegment(20, 110, 235), kPaleSegment(150, 165, 185);

double ScaleFor(const GrayImage& image, int max_width_px) {
  return std::min(1.0, static_cast<double>(max_width_px) / image.width);
}

int Scaled(int size, double scale) {
  return std::max(1, static_cast<int>(std::lround(size * scale)));
}

template <class Function>
Result<std::string> Drawn(Function&& draw) {
  return CatchOpenCv("overlay", [&]() -> Result<std::string> {
    const SingleThreadedOpenCv single_threaded;
    return draw();
  });
}

}  // namespace

Status WriteOverlay(const GrayImage& image, const ViewFeatures& features,
                    const std::string& path) {
  LOWLAP_RETURN_IF_ERROR(image.Validate());
  const auto draw = [&] {
    OverlayCanvas canvas(image.width, image.height);
    const Place place;
    canvas.AddImage(image, place);
    const int width_px = canvas.LineWidthPx();
    for (const Vec2& point : features.points_px) {
      canvas.AddPoint(point, place, kPoint, width_px);
    }
    for (std::size_t i = 0; i < features.segments.size(); ++i) {
      const LineSegment& segment = features.segments[i];
      canvas.AddSegment(segment, place, ColorOf(i), width_px);
      canvas.AddPoint(segment.end_px, place, ColorOf(i), 2 * width_px);
    }
    return canvas.EncodePng();
  };
  LOWLAP_ASSIGN_OR_RETURN(const std::string png, Drawn(draw));
  return WriteFileAtomically(path, png);
}

Result<std::string> DrawInliers(const GrayImage& image,
                                const ViewFeatures& features,
                                const std::set<FeatureIndex>& inlier_points,
                                const std::set<FeatureIndex>& inlier_segments,
                                int max_width_px) {
  LOWLAP_RETURN_IF_ERROR(image.Validate());
  return Drawn([&] {
    const Place place{0, ScaleFor(image, max_width_px)};
    OverlayCanvas canvas(Scaled(image.width, place.scale),
                         Scaled(image.height, place.scale));
    canvas.AddImage(image, place);
    const int width_px = canvas.LineWidthPx();
    // What is pale first, so that it covers nothing.
    for (const bool bright : {false, true}) {
      for (FeatureIndex n = 0; n < features.points_px.size(); ++n) {
        if ((inlier_points.count(n) > 0) != bright) continue;
        canvas.AddPoint(features.points_px[n], place,
                        bright ? kPoint : kPalePoint, 1.5 * width_px);
      }
      for (FeatureIndex n = 0; n < features.segments.size(); ++n) {
        if ((inlier_segments.count(n) > 0) != bright) continue;
        canvas.AddSegment(features.segments[n], place,
                          bright ? kSegment : kPaleSegment,
                          bright ? 2 * width_px : width_px);
      }
    }
    return canvas.EncodePng();
  });
}

Result<std::string> DrawMatches(const MatchedView& first,
                                const MatchedView& second,
                                const std::vector<FeatureMatch>& point_matches,
                                const std::vector<FeatureMatch>& line_matches,
                                int max_width_px) {
  LOWLAP_RETURN_IF_ERROR(first.image->Validate());
  LOWLAP_RETURN_IF_ERROR(second.image->Validate());
  return Drawn([&] {
    constexpr int kGapPx = 8;
    const Place left{0, ScaleFor(*first.image, max_width_px)};
    const int left_width_px = Scaled(first.image->width, left.scale);
    const Place right{left_width_px + kGapPx,
                      ScaleFor(*second.image, max_width_px)};
    OverlayCanvas canvas(
        right.left_px + Scaled(second.image->width, right.scale),
        std::max(Scaled(first.image->height, left.scale),
                 Scaled(second.image->height, right.scale)));
    canvas.AddImage(*first.image, left);
    canvas.AddImage(*second.image, right);
    const int width_px = canvas.LineWidthPx();
    std::size_t index = 0;
    for (const FeatureMatch& match : point_matches) {
      const auto& from = first.features->points_px;
      const auto& to = second.features->points_px;
      if (match.first >= from.size() || match.second >= to.size()) continue;
      const cv::Scalar color = ColorOf(index++);
      canvas.AddLink(from[match.first], left, to[match.second], right, color);
      canvas.AddPoint(from[match.first], left, color, 1.5 * width_px);
      canvas.AddPoint(to[match.second], right, color, 1.5 * width_px);
    }
    for (const FeatureMatch& match : line_matches) {
      const auto& from = first.features->segments;
      const auto& to = second.features->segments;
      if (match.first >= from.size() || match.second >= to.size()) continue;
      const LineSegment& one = from[match.first];
      const LineSegment& other = to[match.second];
      const cv::Scalar color = ColorOf(index++);
      canvas.AddLink(0.5 * (one.start_px + one.end_px), left,
                     0.5 * (other.start_px + other.end_px), right, color);
      canvas.AddSegment(one, left, color, 2 * width_px);
      canvas.AddSegment(other, right, color, 2 * width_px);
    }
    return canvas.EncodePng();
  });
}

}  // namespace lowlap
