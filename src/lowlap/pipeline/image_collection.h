#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Where the interior orientation comes from. At most one is set; with none,
/// focal lengths come from the EXIF data of the photographs (ReadExifFocalPx),
/// as a start: principal point in the middle, no distortion.
struct IntrinsicSource {
  /// fx 0 cx / 0 fy cy / 0 0 1, for all images.
  std::optional<Mat3> calibration;
  /// One focal length in pixels; the principal point is the image centre.
  std::optional<double> focal_px;
  /// The intrinsics of this scene's views, any camera model, found by file
  /// name; for an image it does not list, its only intrinsic.
  std::optional<Scene> scene;
};

/// A scene of all images of a folder (not of its subfolders): views numbered
/// from 0 in the order of the file names, one intrinsic for equal sizes and
/// focal lengths (of IntrinsicSource::scene: its own ids), nothing else. Files
/// that are no images (.jpg .jpeg .png .tif .tiff .bmp .pgm .ppm .webp) are
/// skipped.
///
/// `excluded` names files, with or without extension, that are left out; a
/// name that fits none is kInvalidArgument. Errors: kNotFound (no folder),
/// kInsufficientData (fewer than two images, or an image without a focal
/// length in its EXIF data), kInvalidArgument, kParse.
Result<Scene> SceneFromImages(const std::string& folder,
                              const IntrinsicSource& intrinsics,
                              const std::vector<std::string>& excluded);

/// The ids of views by file name (with or without extension) or number; a name
/// that fits no view is kInvalidArgument.
Result<std::vector<ViewId>> FindViews(const Scene& scene,
                                      const std::vector<std::string>& names);

}  // namespace lowlap
