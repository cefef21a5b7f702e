#include "lowlap/features/internal/lines/line_detector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/features/internal/lines/segment_merging.h"
#include "lowlap/features/internal/opencv.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {
namespace {

constexpr int kMaxSamples = 400;
constexpr double kStepPx = 0.5;        // of the search across the edge
constexpr double kMinRise = 1.0;       // grey values per pixel
constexpr double kMinSupport = 0.5;    // share of the samples on the line
constexpr double kInlierPx = 1.0;      // distance of a sample on the line
constexpr double kMinStddevPx = 0.05;  // of a single place on a perfect edge
// Neighbouring samples see the same noise: the image is blurred by a pixel.
constexpr double kCorrelationLengthPx = 2.5;
constexpr int kIterations = 5;

// Bilinear; the caller keeps within [0, cols - 1) x [0, rows - 1).
double Interpolate(const cv::Mat& image, double x, double y) {
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const double fx = x - x0, fy = y - y0;
  const float* row0 = image.ptr<float>(y0) + x0;
  const float* row1 = image.ptr<float>(y0 + 1) + x0;
  return (1 - fy) * ((1 - fx) * row0[0] + fx * row0[1]) +
         fy * ((1 - fx) * row1[0] + fx * row1[1]);
}

// Offset along `normal` of the steepest rise near `point`.
std::optional<double> SteepestRise(const cv::Mat& image, const Vec2& point,
                                   const Vec2& normal, double reach_px) {
  const int half = std::max(1, static_cast<int>(std::ceil(reach_px / kStepPx)));
  const double margin = (half + 2) * kStepPx;
  if (!(point.x() >= margin && point.y() >= margin &&
        point.x() < image.cols - 1 - margin &&
        point.y() < image.rows - 1 - margin)) {
    return std::nullopt;
  }
  // rise[i] is the central difference at offset (i - half - 1) steps.
  const int count = 2 * half + 3;
  double rise[64];
  double before = 0, here = 0;
  for (int i = -1; i <= count; ++i) {
    const Vec2 p = point + (i - half - 1) * kStepPx * normal;
    const double value = Interpolate(image, p.x(), p.y());
    if (i >= 1) rise[i - 1] = (value - before) / (2 * kStepPx);
    before = here;
    here = value;
  }
  int best = -1;
  for (int i = 1; i + 1 < count; ++i) {
    if (rise[i] >= kMinRise && rise[i] > rise[i - 1] &&
        rise[i] >= rise[i + 1] && (best < 0 || rise[i] > rise[best])) {
      best = i;
    }
  }
  if (best < 0) return std::nullopt;
  const double curvature = rise[best - 1] - 2 * rise[best] + rise[best + 1];
  const double peak = 0.5 * (rise[best - 1] - rise[best + 1]) / curvature;
  return (best - half - 1 + peak) * kStepPx;
}

struct EdgeSample {
  double along = 0;
  double across = 0;
  double weight = 1;
};

// across = offset + slope * (along - center)
struct Line {
  double center = 0;
  double offset = 0;
  double slope = 0;
  double weight_sum = 0;
  double along2_sum = 0;

  double Residual(const EdgeSample& sample) const {
    return sample.across - offset - slope * (sample.along - center);
  }
};

std::optional<Line> WeightedFit(const std::vector<EdgeSample>& samples) {
  Line line;
  double across_mean = 0;
  for (const EdgeSample& s : samples) {
    line.weight_sum += s.weight;
    line.center += s.weight * s.along;
    across_mean += s.weight * s.across;
  }
  if (!(line.weight_sum > 0)) return std::nullopt;
  line.center /= line.weight_sum;
  line.offset = across_mean / line.weight_sum;
  double mixed = 0;
  for (const EdgeSample& s : samples) {
    const double along = s.along - line.center;
    line.along2_sum += s.weight * along * along;
    mixed += s.weight * along * (s.across - line.offset);
  }
  if (!(line.along2_sum > 0)) return std::nullopt;
  line.slope = mixed / line.along2_sum;
  return line;
}

double MedianAbsolute(const Line& line,
                      const std::vector<EdgeSample>& samples) {
  std::vector<double> residuals;
  for (const EdgeSample& s : samples) {
    residuals.push_back(std::abs(line.Residual(s)));
  }
  const auto middle =
      residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return *middle;
}

// Tukey's weights from a start at the median offset.
std::optional<Line> RobustFit(std::vector<EdgeSample>* samples) {
  std::optional<Line> line = WeightedFit(*samples);
  for (int i = 0; line && i < kIterations; ++i) {
    const double scale =
        std::max(4.685 / kMedianOfNorm<1> * MedianAbsolute(*line, *samples),
                 4 * kMinStddevPx);
    for (EdgeSample& s : *samples) {
      const double u = line->Residual(s) / scale;
      s.weight = std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
    }
    line = WeightedFit(*samples);
  }
  return line;
}

// Fits the support line of a segment to the edge beneath it.
//
// Along the segment, the place of the steepest rise towards its bright side
// is searched within `reach_px` across, to a fraction of a pixel; a line goes
// through these places by iteratively reweighted least squares, and the
// segment is cut back to the part where they are on the line. The standard
// deviation of its end points follows from the scatter.
//
// `blurred`: CV_32F grey values, smoothed by about one pixel. All positions
// are pixels of this image. nullopt: no such edge under most of the segment.
std::optional<LineSegment> FitEdge(const cv::Mat& blurred, const Vec2& start_px,
                                   const Vec2& end_px, double reach_px) {
  const double length = (end_px - start_px).norm();
  if (!(length > 1)) return std::nullopt;
  const Vec2 direction = (end_px - start_px) / length;
  const Vec2 bright(direction.y(), -direction.x());
  const int count =
      std::clamp(static_cast<int>(std::lround(length)), 4, kMaxSamples);
  std::vector<EdgeSample> samples;
  for (int i = 0; i < count; ++i) {
    const double along = length * (i + 0.5) / count;
    const auto across =
        SteepestRise(blurred, start_px + along * direction, bright, reach_px);
    if (across) samples.push_back({along, *across, 1});
  }
  if (samples.size() < std::max(3.0, kMinSupport * count)) return std::nullopt;
  const std::optional<Line> line = RobustFit(&samples);
  if (!line) return std::nullopt;

  int num_inliers = 0;
  double low = length, high = 0, squares = 0;
  for (const EdgeSample& s : samples) {
    const double residual = line->Residual(s);
    if (std::abs(residual) > kInlierPx) continue;
    ++num_inliers;
    squares += residual * residual;
    low = std::min(low, s.along);
    high = std::max(high, s.along);
  }
  if (num_inliers < std::max(3.0, kMinSupport * count)) return std::nullopt;
  // Samples stand for the step around them.
  const double half_step = 0.5 * length / count;
  low -= half_step;
  high += half_step;

  const double spacing = length / count;
  const double correlation = std::max(1.0, kCorrelationLengthPx / spacing);
  const double variance = std::max(squares / std::max(1, num_inliers - 2),
                                   kMinStddevPx * kMinStddevPx) *
                          correlation;
  const auto variance_at = [&](double along) {
    const double a = along - line->center;
    return variance * (1 / line->weight_sum + a * a / line->along2_sum);
  };
  const auto point_at = [&](double along) -> Vec2 {
    return start_px + along * direction +
           (line->offset + line->slope * (along - line->center)) * bright;
  };
  LineSegment segment;
  segment.start_px = point_at(low);
  segment.end_px = point_at(high);
  segment.stddev_px = std::sqrt(std::max(variance_at(low), variance_at(high)));
  return segment;
}

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
  std::sort(fitted.begin(), fitted.end(), LongerFirst<LineSegment>);
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
