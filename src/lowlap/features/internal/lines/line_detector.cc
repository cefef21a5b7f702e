#include "lowlap/features/internal/lines/line_detector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/features/internal/lines/edge_fit.h"
#include "lowlap/features/internal/lines/segment_merging.h"
#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

constexpr int kMinLineImageSidePx = 16;
// Fragments shorter than this (in pixels of their level) say nothing.
constexpr double kMinRawLengthPx = 8;
constexpr double kEdgeReachPx = 2.5;

// Coordinates of a level in those of the full resolution; halving puts the
// centre of a pixel between those of the 2 x 2 pixels that it averages.
Vec2 FullFromLevel(const Vec2& p, int level) {
  const double scale = std::ldexp(1.0, level);
  return (p + Vec2(0.5, 0.5)) * scale - Vec2(0.5, 0.5);
}

Vec2 LevelFromFull(const Vec2& p, int level) {
  const double scale = std::ldexp(1.0, -level);
  return (p + Vec2(0.5, 0.5)) * scale - Vec2(0.5, 0.5);
}

std::vector<cv::Mat> BuildPyramid(const cv::Mat& image, int coarsest_side_px) {
  std::vector<cv::Mat> levels = {image};
  while (std::max(levels.back().cols, levels.back().rows) > coarsest_side_px &&
         std::min(levels.back().cols, levels.back().rows) >=
             2 * kMinLineImageSidePx) {
    const cv::Size half(levels.back().cols / 2, levels.back().rows / 2);
    // An odd row or column is left out: the factor stays exactly 2.
    const cv::Mat even =
        levels.back()(cv::Rect(0, 0, 2 * half.width, 2 * half.height));
    cv::Mat next;
    cv::resize(even, next, half, 0, 0, cv::INTER_AREA);
    levels.push_back(next);
  }
  return levels;
}

std::vector<RawSegment> DetectOnLevel(const cv::Mat& image, int level) {
  std::vector<cv::Vec4f> found;
  cv::createLineSegmentDetector(cv::LSD_REFINE_STD)->detect(image, found);
  std::vector<RawSegment> segments;
  for (const cv::Vec4f& s : found) {
    const RawSegment segment = {FullFromLevel(Vec2(s[0], s[1]), level),
                                FullFromLevel(Vec2(s[2], s[3]), level), level};
    if (segment.LengthPx() >= std::ldexp(kMinRawLengthPx, level)) {
      segments.push_back(segment);
    }
  }
  return segments;
}

std::vector<LineSegment> FitSegments(const std::vector<RawSegment>& raw,
                                     const std::vector<cv::Mat>& levels) {
  std::vector<cv::Mat> blurred(levels.size());
  std::vector<LineSegment> fitted;
  for (const RawSegment& segment : raw) {
    cv::Mat& image = blurred[segment.level];
    if (image.empty()) {
      levels[segment.level].convertTo(image, CV_32F);
      cv::GaussianBlur(image, image, cv::Size(), 1.0);
    }
    std::optional<LineSegment> fit =
        FitEdge(image, LevelFromFull(segment.start_px, segment.level),
                LevelFromFull(segment.end_px, segment.level), kEdgeReachPx);
    if (!fit) continue;
    fit->start_px = FullFromLevel(fit->start_px, segment.level);
    fit->end_px = FullFromLevel(fit->end_px, segment.level);
    fit->stddev_px = std::ldexp(fit->stddev_px, segment.level);
    fitted.push_back(*fit);
  }
  return fitted;
}

bool LongerFirst(const LineSegment& a, const LineSegment& b) {
  const double la = a.LengthPx(), lb = b.LengthPx();
  if (la != lb) return la > lb;
  if (a.start_px.y() != b.start_px.y()) return a.start_px.y() < b.start_px.y();
  return a.start_px.x() < b.start_px.x();
}

std::vector<LineSegment> DetectInMat(const cv::Mat& image,
                                     const LineOptions& options) {
  const std::vector<cv::Mat> levels =
      BuildPyramid(image, options.coarsest_side_px);
  std::vector<std::vector<RawSegment>> raw;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    raw.push_back(DetectOnLevel(levels[l], static_cast<int>(l)));
  }
  const double min_length_px =
      options.min_length_ratio * 0.5 * (image.cols + image.rows);
  std::vector<RawSegment> merged = MergeLevels(raw);
  merged.erase(std::remove_if(merged.begin(), merged.end(),
                              [&](const RawSegment& s) {
                                return s.LengthPx() < min_length_px;
                              }),
               merged.end());

  std::vector<LineSegment> fitted = FitSegments(merged, levels);
  std::sort(fitted.begin(), fitted.end(), LongerFirst);
  std::vector<RawSegment> placed;
  for (const LineSegment& s : fitted) {
    placed.push_back({s.start_px, s.end_px, 0});
  }
  std::vector<LineSegment> segments;
  for (const std::size_t i : WithoutDuplicates(placed, 1.0)) {
    if (segments.size() >= static_cast<std::size_t>(options.max_segments))
      break;
    if (fitted[i].LengthPx() >= min_length_px) segments.push_back(fitted[i]);
  }
  return segments;
}

}  // namespace

Status LineOptions::Validate() const {
  return Require(
      {{min_length_ratio >= 0 && min_length_ratio < 1,
        "min_length_ratio of lines must lie in [0, 1)"},
       {coarsest_side_px >= 1, "coarsest_side_px must be at least 1"},
       {max_segments >= 1, "max_segments must be at least 1"}});
}

Result<std::vector<LineSegment>> DetectLines(const GrayImage& image,
                                             const LineOptions& options) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_RETURN_IF_ERROR(image.Validate());
  if (std::min(image.width, image.height) < kMinLineImageSidePx) {
    return std::vector<LineSegment>{};
  }
  return CatchOpenCv("line segments",
                     [&]() -> Result<std::vector<LineSegment>> {
                       const SingleThreadedOpenCv single_threaded;
                       return DetectInMat(AsMat(image), options);
                     });
}

}  // namespace lowlap
