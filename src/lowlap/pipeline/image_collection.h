#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Where the interior orientation comes from. At most one is set; with none,
/// focal lengths come from the EXIF data of the photographs (ReadExif),
/// as a start: principal point in the middle, no distortion.
struct IntrinsicSource {
  /// fx 0 cx / 0 fy cy / 0 0 1, for all images.
  std::optional<Mat3> calibration;
  /// One focal length in pixels; the principal point is the image centre.
  std::optional<double> focal_px;
  /// The intrinsics of this scene's views, any camera model, found by file
  /// name, and by folders where views of one name have different ones; for an
  /// image it does not list, its only intrinsic.
  std::optional<Scene> scene;
};

/// A scene of all images of a folder (not of its subfolders, and none whose
/// name starts with a dot): views numbered from 0 in the order of the file
/// names, one intrinsic for equal sizes and focal lengths (of
/// IntrinsicSource::scene: its own ids), nothing else. Files that are no images
/// (.jpg .jpeg .png .tif .tiff .bmp .pgm .ppm .webp) are skipped.
///
/// The intrinsics must fit the photographs: they are scaled to photographs of
/// another size, and turned with those whose EXIF orientation says that they
/// lie on their side; for people, `notes` (may be null) tells of each. A
/// photograph of another shape, turned who knows which way, or with its
/// principal point far off the middle is kInvalidArgument.
///
/// `excluded` names files, with or without extension, that are left out; a
/// name that fits none is kInvalidArgument. Errors, with the file: kNotFound
/// (no folder), kIo (a link in a circle), kInsufficientData (fewer than two
/// images, or an image without a focal length in its EXIF data),
/// kInvalidArgument (a name that is not UTF-8, too), and those of
/// ReadImageSize.
Result<Scene> SceneFromImages(const std::string& folder,
                              const IntrinsicSource& intrinsics,
                              const std::vector<std::string>& excluded,
                              std::vector<std::string>* notes = nullptr);

/// The ids of views as ViewNames finds them; kInvalidArgument for a name that
/// fits no view, or several.
Result<std::vector<ViewId>> FindViews(const Scene& scene,
                                      const std::vector<std::string>& names);

}  // namespace lowlap
