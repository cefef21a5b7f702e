#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap {

/// An 8-bit grey image, row by row from the top, without padding. The centre
/// of the top-left pixel is (0, 0).
struct GrayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  // width * height

  /// Both sizes positive and as many pixels as they say.
  Status Validate() const;
};

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

/// Larger images are refused before they are decoded: a file of a hundred
/// kilobytes can ask for gigabytes.
inline constexpr double kMaxImagePixels = 3e8;
/// The longest side that OpenCV decodes.
inline constexpr int kMaxImageSidePx = 1 << 20;

/// Reads a JPEG, PNG, TIFF, BMP, WebP, PBM, PGM or PPM file, colour converted
/// to grey. The pixels are as stored: an EXIF orientation is ignored, because
/// intrinsics refer to the sensor. Errors: kNotFound, kParse (not an image, or
/// a JPEG file that is cut off), kUnsupported (more than kMaxImagePixels, or
/// longer than kMaxImageSidePx), with the path.
Result<GrayImage> ReadGrayImage(const std::string& path);

/// The same from a file's bytes; `path` is for messages only.
Result<GrayImage> DecodeGrayImage(const std::string& bytes,
                                  const std::string& path);

/// The size of an image as ReadGrayImage would return it; the file is not
/// decoded for it. Errors as there, as far as they show.
Result<ImageSize> ReadImageSize(const std::string& path);

/// The same from a file's bytes; `path` is for messages only.
Result<ImageSize> DecodeImageSize(const std::string& bytes,
                                  const std::string& path);

/// The version of the library that decodes images and finds features.
std::string ImageLibraryVersion();

}  // namespace lowlap
