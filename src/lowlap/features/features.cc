#include "lowlap/features/features.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "lowlap/core/parallel.h"

namespace lowlap {
namespace {

// SIFT's pyramid: 4 times the pixels, 11 images of 4 bytes, octaves 4/3.
constexpr double kBytesPerPixel = 240;

// As many threads as the images leave room for, so that a machine with many
// cores does not run out of memory.
int ThreadsWithinMemory(const Scene& scene, const FeatureOptions& options,
                        const RunContext& context) {
  if (!options.detect_points) return context.ThreadCount();
  double largest_px = 1;
  for (const auto& [id, view] : scene.views) {
    largest_px = std::max(largest_px,
                          static_cast<double>(view.width_px) * view.height_px);
  }
  const double fit =
      options.max_memory_gb * 1e9 / (kBytesPerPixel * largest_px);
  return static_cast<int>(
      std::clamp(fit, 1.0, static_cast<double>(context.ThreadCount())));
}

Result<DetectedFeatures> DetectFeaturesOfView(const Scene& scene, ViewId id,
                                              const FeatureOptions& options) {
  const std::string path = scene.ImagePath(id);
  const Result<GrayImage> image = ReadGrayImage(path);
  if (!image) return tl::unexpected<Error>(image.error());
  const View& view = scene.views.at(id);
  if (image->width != view.width_px || image->height != view.height_px) {
    return MakeError(ErrorCode::kInvalidScene,
                     "the image has " + std::to_string(image->width) + " x " +
                         std::to_string(image->height) + " pixels, its view " +
                         std::to_string(view.width_px) + " x " +
                         std::to_string(view.height_px),
                     path, "view " + std::to_string(id));
  }
  Result<DetectedFeatures> features = DetectFeatures(*image, options);
  if (!features && features.error().file.empty()) features.error().file = path;
  return features;
}

}  // namespace

Status FeatureOptions::Validate() const {
  if (!(max_memory_gb > 0 && std::isfinite(max_memory_gb))) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "max_memory_gb must be positive");
  }
  if (const Status s = points.Validate(); !s) return s;
  return lines.Validate();
}

Result<DetectedFeatures> DetectFeatures(const GrayImage& image,
                                        const FeatureOptions& options) {
  if (const Status s = options.Validate(); !s) {
    return tl::unexpected<Error>(s.error());
  }
  DetectedFeatures detected;
  if (options.detect_points) {
    Result<PointFeatures> points = DetectPoints(image, options.points);
    if (!points) return tl::unexpected<Error>(points.error());
    for (const Keypoint& keypoint : points->keypoints) {
      detected.features.points_px.push_back(keypoint.position_px);
    }
    detected.keypoints = std::move(points->keypoints);
    detected.point_descriptors = std::move(points->descriptors);
  }
  if (options.detect_lines) {
    Result<std::vector<LineSegment>> segments =
        DetectLines(image, options.lines);
    if (!segments) return tl::unexpected<Error>(segments.error());
    Result<std::vector<LineDescriptor>> descriptors =
        DescribeLines(image, *segments);
    if (!descriptors) return tl::unexpected<Error>(descriptors.error());
    detected.features.segments = std::move(*segments);
    detected.line_descriptors = std::move(*descriptors);
  }
  return detected;
}

Result<std::map<ViewId, DetectedFeatures>> DetectFeatures(
    const Scene& scene, const FeatureOptions& options,
    const RunContext& context) {
  if (const Status s = options.Validate(); !s) {
    return tl::unexpected<Error>(s.error());
  }
  std::vector<ViewId> ids;
  for (const auto& [id, view] : scene.views) ids.push_back(id);
  std::vector<std::optional<Result<DetectedFeatures>>> results(ids.size());
  RunContext limited = context;
  limited.num_threads = ThreadsWithinMemory(scene, options, context);
  const Status done =
      ParallelFor(limited, "features", ids.size(), [&](std::size_t i) {
        results[i] = DetectFeaturesOfView(scene, ids[i], options);
      });
  if (!done) return tl::unexpected<Error>(done.error());

  std::map<ViewId, DetectedFeatures> features;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Result<DetectedFeatures>& result = *results[i];
    if (!result) return tl::unexpected<Error>(result.error());
    features.emplace(ids[i], std::move(*result));
  }
  return features;
}

}  // namespace lowlap
