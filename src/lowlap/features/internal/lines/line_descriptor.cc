#include "lowlap/features/internal/lines/line_descriptor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/line_descriptor.hpp>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

// The band of support is 63 pixels high. It is laid over an image whose longer
// side is at most this, so that it covers the same part of the scene whatever
// the resolution.
constexpr int kMaxSidePx = 1600;
// OpenCV counts lines in 16 bits.
constexpr std::size_t kLinesPerCall = 10000;

cv::line_descriptor::KeyLine MakeKeyLine(const LineSegment& segment,
                                         const Vec2& scale, int id,
                                         const cv::Size& image) {
  // Everything lies on octave 0: with several octaves in one call, OpenCV 4.6
  // reads behind its pyramid.
  const Vec2 half(0.5, 0.5);
  const Vec2 start = (segment.start_px + half).cwiseProduct(scale) - half;
  const Vec2 end = (segment.end_px + half).cwiseProduct(scale) - half;
  const Vec2 d = end - start;
  cv::line_descriptor::KeyLine line;
  line.startPointX = line.sPointInOctaveX = static_cast<float>(start.x());
  line.startPointY = line.sPointInOctaveY = static_cast<float>(start.y());
  line.endPointX = line.ePointInOctaveX = static_cast<float>(end.x());
  line.endPointY = line.ePointInOctaveY = static_cast<float>(end.y());
  line.angle = static_cast<float>(std::atan2(d.y(), d.x()));
  line.lineLength = static_cast<float>(d.norm());
  line.numOfPixels = std::max(1, static_cast<int>(std::lround(d.norm())));
  line.octave = 0;
  line.class_id = id;
  line.size = static_cast<float>(std::abs(d.x() * d.y()));
  line.response = line.lineLength / std::max(image.width, image.height);
  line.pt = cv::Point2f(static_cast<float>(0.5 * (start.x() + end.x())),
                        static_cast<float>(0.5 * (start.y() + end.y())));
  return line;
}

std::vector<LineDescriptor> Describe(const cv::Mat& image,
                                     const std::vector<LineSegment>& segments) {
  cv::Mat small = image;
  const double factor = std::min(
      1.0, kMaxSidePx / static_cast<double>(std::max(image.cols, image.rows)));
  if (factor < 1) {
    // At least one pixel of a narrow strip is left.
    cv::resize(image, small, cv::Size(), std::max(factor, 1.0 / image.cols),
               std::max(factor, 1.0 / image.rows), cv::INTER_AREA);
  }
  const Vec2 scale(small.cols / static_cast<double>(image.cols),
                   small.rows / static_cast<double>(image.rows));
  const auto lbd =
      cv::line_descriptor::BinaryDescriptor::createBinaryDescriptor();
  std::vector<LineDescriptor> descriptors(segments.size());
  for (std::size_t begin = 0; begin < segments.size(); begin += kLinesPerCall) {
    const std::size_t end = std::min(begin + kLinesPerCall, segments.size());
    std::vector<cv::line_descriptor::KeyLine> lines;
    for (std::size_t i = begin; i < end; ++i) {
      lines.push_back(MakeKeyLine(segments[i], scale,
                                  static_cast<int>(i - begin), small.size()));
    }
    cv::Mat rows;
    lbd->compute(small, lines, rows);
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint8_t* row = rows.ptr(static_cast<int>(i - begin));
      std::copy(row, row + descriptors[i].size(), descriptors[i].begin());
    }
  }
  return descriptors;
}

}  // namespace

Result<std::vector<LineDescriptor>> DescribeLines(
    const GrayImage& image, const std::vector<LineSegment>& segments) {
  LOWLAP_RETURN_IF_ERROR(image.Validate());
  const Eigen::AlignedBox2d box(Vec2(-1, -1), Vec2(image.width, image.height));
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!box.contains(segments[i].start_px) ||
        !box.contains(segments[i].end_px)) {
      return MakeError(
          ErrorCode::kInvalidArgument,
          "segment " + std::to_string(i) + " does not lie in the image");
    }
  }
  return CatchOpenCv("line descriptors",
                     [&]() -> Result<std::vector<LineDescriptor>> {
                       if (segments.empty())
                         return std::vector<LineDescriptor>{};
                       const SingleThreadedOpenCv single_threaded;
                       return Describe(AsMat(image), segments);
                     });
}

}  // namespace lowlap
