#pragma once

#include <optional>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"

namespace lowlap {

/// What the EXIF data of a JPEG file tell of its geometry.
struct ExifGeometry {
  /// The focal length in pixels of the image, from
  ///   FocalLength (mm) x FocalPlaneResolution (pixels per mm), scaled by the
  ///   image's longer side over that of the photograph as taken, or
  ///   FocalLengthIn35mmFilm x diagonal (pixels) / 43.27 mm,
  /// the latter, though rounded to millimetres, where the first is not there
  /// or is more than a tenth off it (some cameras write a wrong resolution).
  std::optional<double> focal_px;
  /// The size of the photograph as taken; 0 x 0: unknown.
  ImageSize taken;
  /// How the stored pixels lie to the upright picture: 1 as they are, 6 or 8 a
  /// quarter turn; 1 if unknown. See the EXIF standard.
  int orientation = 1;
};

/// Of an image of this size; nothing is known of other formats than JPEG.
/// Errors: kNotFound, kIo.
Result<ExifGeometry> ReadExif(const std::string& path, const ImageSize& size);

}  // namespace lowlap
