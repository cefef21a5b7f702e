#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/feature_options.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/features/internal/lines/line_descriptor.h"
#include "lowlap/features/internal/lines/line_detector.h"
#include "lowlap/features/internal/points/point_detector.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The features of a view with what matching needs to know of them; all
/// vectors of a kind have the same length and order.
struct DetectedFeatures {
  ViewFeatures features;
  std::vector<Keypoint> keypoints;
  std::vector<PointDescriptor> point_descriptors;
  std::vector<LineDescriptor> line_descriptors;
};

/// Adds points after those that are there.
void AddPoints(const PointFeatures& points, DetectedFeatures* detected);

Result<DetectedFeatures> DetectFeatures(const GrayImage& image,
                                        const FeatureOptions& options);

/// The same for an image with lens distortion: straight edges are bent in it,
/// so segments are detected and described on an UndistortedImage, and their end
/// points are moved back to the image's own pixels. A panorama has points only.
Result<DetectedFeatures> DetectFeatures(const GrayImage& image,
                                        const Intrinsic& intrinsic,
                                        const FeatureOptions& options);

/// The image of a view from its file's bytes; one whose size is not that of the
/// view is kInvalidScene.
Result<GrayImage> DecodeImageOfView(const Scene& scene, ViewId id,
                                    const std::string& image_bytes);

/// The features of one view from its image file's bytes. kUnsupported: an image
/// whose points take more memory than the machine has.
Result<DetectedFeatures> DetectFeaturesOfView(const Scene& scene, ViewId id,
                                              const std::string& image_bytes,
                                              const FeatureOptions& options);

/// The context with as many threads as max_memory_gb leaves room for.
RunContext WithinMemory(const Scene& scene, const FeatureOptions& options,
                        const RunContext& context);

/// Reads the images of all views of the scene (Scene::ImagePath) and detects
/// their features, one image per thread. An image whose size is not that of
/// its view is kInvalidScene. Views whose images fail are left out and go to
/// `failed`; without it (null), the error of the lowest view id is returned.
Result<std::map<ViewId, DetectedFeatures>> DetectFeatures(
    const Scene& scene, const FeatureOptions& options,
    const RunContext& context, std::map<ViewId, Error>* failed = nullptr);

}  // namespace lowlap
