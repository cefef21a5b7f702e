#pragma once

#include <optional>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/features/image.h"

namespace lowlap {

/// The focal length, in pixels of an image of this size, that the EXIF data of
/// a JPEG file tell, from
///   FocalLength (mm) x FocalPlaneResolution (pixels per mm), scaled by the
///   image's longer side over that of the photograph as taken, or
///   FocalLengthIn35mmFilm x diagonal (pixels) / 43.27 mm,
/// the latter, though rounded to millimetres, where the first is not there or
/// is more than a tenth off it (some cameras write a wrong resolution).
/// nullopt: no such data. Errors: kNotFound, kIo.
Result<std::optional<double>> ReadExifFocalPx(const std::string& path,
                                              const ImageSize& size);

}  // namespace lowlap
