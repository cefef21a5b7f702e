#include "lowlap/features/internal/features.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/image_memory.h"
#include "lowlap/features/internal/points/point_memory.h"
#include "lowlap/features/internal/undistorted_image.h"

namespace lowlap {
namespace {

Status AddLines(const GrayImage& image, const FeatureOptions& options,
                DetectedFeatures* detected) {
  LOWLAP_ASSIGN_OR_RETURN(std::vector<LineSegment> segments,
                          DetectLines(image, options.lines));
  LOWLAP_ASSIGN_OR_RETURN(std::vector<LineDescriptor> descriptors,
                          DescribeLines(image, segments));
  detected->features.segments = std::move(segments);
  detected->line_descriptors = std::move(descriptors);
  return {};
}

Status AddUndistortedLines(const GrayImage& image, const Intrinsic& intrinsic,
                           const FeatureOptions& options,
                           DetectedFeatures* detected) {
  LOWLAP_ASSIGN_OR_RETURN(const UndistortedImage undistorted,
                          UndistortedImage::Make(image, intrinsic));
  DetectedFeatures found;
  LOWLAP_RETURN_IF_ERROR(AddLines(undistorted.image(), options, &found));
  for (std::size_t i = 0; i < found.features.segments.size(); ++i) {
    const std::optional<LineSegment> segment =
        undistorted.ToDistorted(found.features.segments[i]);
    if (!segment) continue;
    detected->features.segments.push_back(*segment);
    detected->line_descriptors.push_back(found.line_descriptors[i]);
  }
  return {};
}

}  // namespace

void AddPoints(const PointFeatures& points, DetectedFeatures* detected) {
  for (const Keypoint& keypoint : points.keypoints) {
    detected->features.points_px.push_back(keypoint.position_px);
    const Mat2& shape = keypoint.covariance;
    detected->features.point_covariances.emplace_back(shape(0, 0), shape(0, 1),
                                                      shape(1, 1));
    detected->keypoints.push_back(keypoint);
  }
  detected->point_descriptors.insert(detected->point_descriptors.end(),
                                     points.descriptors.begin(),
                                     points.descriptors.end());
}

Status FeatureOptions::Validate() const {
  if (!(max_memory_gb > 0 && std::isfinite(max_memory_gb))) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "max_memory_gb must be positive");
  }
  LOWLAP_RETURN_IF_ERROR(points.Validate());
  LOWLAP_RETURN_IF_ERROR(tilts.Validate());
  return lines.Validate();
}

Result<DetectedFeatures> DetectFeatures(const GrayImage& image,
                                        const FeatureOptions& options) {
  Intrinsic undistorted;
  undistorted.width_px = image.width;
  undistorted.height_px = image.height;
  return DetectFeatures(image, undistorted, options);
}

Result<DetectedFeatures> DetectFeatures(const GrayImage& image,
                                        const Intrinsic& intrinsic,
                                        const FeatureOptions& options) {
  Status status = options.Validate();
  DetectedFeatures detected;
  if (status && options.detect_points) {
    LOWLAP_ASSIGN_OR_RETURN(const PointFeatures points,
                            DetectPoints(image, options.points));
    AddPoints(points, &detected);
  }
  if (status && options.detect_lines &&
      intrinsic.model != CameraModel::kSpherical) {
    status = intrinsic.HasDistortion()
                 ? AddUndistortedLines(image, intrinsic, options, &detected)
                 : AddLines(image, options, &detected);
  }
  if (!status) return tl::unexpected<Error>(status.error());
  return detected;
}

Result<GrayImage> DecodeImageOfView(const Scene& scene, ViewId id,
                                    const std::string& image_bytes) {
  const std::string path = scene.ImagePath(id);
  LOWLAP_ASSIGN_OR_RETURN(GrayImage image, DecodeGrayImage(image_bytes, path));
  const View& view = scene.views.at(id);
  if (image.width != view.width_px || image.height != view.height_px) {
    return MakeError(ErrorCode::kInvalidScene,
                     "the image has " + std::to_string(image.width) + " x " +
                         std::to_string(image.height) + " pixels, its view " +
                         std::to_string(view.width_px) + " x " +
                         std::to_string(view.height_px),
                     path, "view " + std::to_string(id.value()));
  }
  return image;
}

Result<DetectedFeatures> DetectFeaturesOfView(const Scene& scene, ViewId id,
                                              const std::string& image_bytes,
                                              const FeatureOptions& options) {
  const std::string path = scene.ImagePath(id);
  if (options.detect_points) {
    LOWLAP_ASSIGN_OR_RETURN(const ImageSize size,
                            DecodeImageSize(image_bytes, path));
    LOWLAP_RETURN_IF_ERROR(
        CheckMemoryOfPoints(size.width_px, size.height_px, path));
  }
  LOWLAP_ASSIGN_OR_RETURN(const GrayImage image,
                          DecodeImageOfView(scene, id, image_bytes));
  const Intrinsic* intrinsic = scene.FindIntrinsic(id);
  Result<DetectedFeatures> features =
      intrinsic ? DetectFeatures(image, *intrinsic, options)
                : DetectFeatures(image, options);
  if (!features && features.error().file.empty()) features.error().file = path;
  return features;
}

RunContext WithinMemory(const Scene& scene, const FeatureOptions& options,
                        const RunContext& context) {
  if (!options.detect_points) return context;
  double largest_px = 1;
  for (const auto& [id, view] : scene.views) {
    largest_px = std::max(largest_px,
                          static_cast<double>(view.width_px) * view.height_px);
  }
  return WithinPointMemory(context, largest_px, options.max_memory_gb);
}

Result<std::map<ViewId, DetectedFeatures>> DetectFeatures(
    const Scene& scene, const FeatureOptions& options,
    const RunContext& context, std::map<ViewId, Error>* failed) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::vector<ViewId> ids;
  for (const auto& [id, view] : scene.views) ids.push_back(id);
  std::vector<std::optional<Result<DetectedFeatures>>> results(ids.size());
  const RunContext limited = WithinMemory(scene, options, context);
  const ReusedImageMemory reused_memory;
  const Status done =
      ParallelFor(limited, "features", ids.size(), [&](std::size_t i) {
        const Result<std::string> bytes =
            ReadWholeFile(scene.ImagePath(ids[i]));
        if (bytes) {
          results[i] = DetectFeaturesOfView(scene, ids[i], *bytes, options);
        } else {
          results[i] = tl::unexpected<Error>(bytes.error());
        }
      });
  if (!done) return tl::unexpected<Error>(done.error());

  std::map<ViewId, DetectedFeatures> features;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Result<DetectedFeatures>& result = *results[i];
    if (result) {
      features.emplace(ids[i], std::move(*result));
    } else if (failed != nullptr) {
      failed->emplace(ids[i], result.error());
    } else {
      return tl::unexpected<Error>(result.error());
    }
  }
  return features;
}

}  // namespace lowlap
