#include "lowlap/features/image.h"

#include <filesystem>
#include <opencv2/core/version.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "lowlap/core/atomic_file.h"
#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

std::size_t BigEndian(const std::string& bytes, std::size_t at, int count) {
  std::size_t value = 0;
  for (int i = 0; i < count; ++i) {
    value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  }
  return value;
}

ImageSize SizeAt(const std::string& bytes, std::size_t width_at,
                 std::size_t height_at, int count) {
  return {static_cast<int>(BigEndian(bytes, width_at, count)),
          static_cast<int>(BigEndian(bytes, height_at, count))};
}

// The header chunk IHDR is the first of a PNG file.
std::optional<ImageSize> PngSize(const std::string& bytes) {
  if (bytes.size() < 24 || bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") != 0) {
    return std::nullopt;
  }
  return SizeAt(bytes, 16, 20, 4);
}

// Walks over the segments of a JPEG file to its start-of-frame marker.
std::optional<ImageSize> JpegSize(const std::string& bytes) {
  if (bytes.compare(0, 2, "\xff\xd8") != 0) return std::nullopt;
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (BigEndian(bytes, at, 1) != 0xff) return std::nullopt;
    const std::size_t marker = BigEndian(bytes, at + 1, 1);
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    // C0..CF are frames, except for tables of Huffman codes (C4), arithmetic
    // conditioning (CC) and the reserved C8.
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 &&
        marker != 0xcc) {
      return SizeAt(bytes, at + 7, at + 5, 2);
    }
    at += 2 + BigEndian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

}  // namespace

Status GrayImage::Validate() const {
  if (width <= 0 || height <= 0) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "an image of " + std::to_string(width) + " x " +
                         std::to_string(height) + " pixels");
  }
  const std::size_t expected =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (pixels.size() != expected) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "an image of " + std::to_string(width) + " x " +
                         std::to_string(height) + " with " +
                         std::to_string(pixels.size()) + " pixels");
  }
  return {};
}

Result<GrayImage> ReadGrayImage(const std::string& path) {
  const Result<std::string> bytes = ReadWholeFile(path);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  return DecodeGrayImage(*bytes, path);
}

Result<GrayImage> DecodeGrayImage(const std::string& bytes,
                                  const std::string& path) {
  GrayImage image;
  try {
    cv::Mat decoded;
    if (!bytes.empty()) {
      const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1,
                            const_cast<char*>(bytes.data()));
      decoded = cv::imdecode(
          encoded, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    }
    if (decoded.empty()) {
      return MakeError(ErrorCode::kParse, "not an image that can be read",
                       path);
    }
    image.width = decoded.cols;
    image.height = decoded.rows;
    image.pixels.assign(decoded.begin<std::uint8_t>(),
                        decoded.end<std::uint8_t>());
  } catch (const std::exception& e) {
    return MakeError(ErrorCode::kParse,
                     std::string("the image cannot be read: ") + e.what(),
                     path);
  }
  return image;
}

Result<ImageSize> ReadImageSize(const std::string& path) {
  const Result<std::string> bytes = ReadWholeFile(path);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  std::optional<ImageSize> size = PngSize(*bytes);
  if (!size) size = JpegSize(*bytes);
  if (size && size->width_px > 0 && size->height_px > 0) return *size;
  const Result<GrayImage> image = ReadGrayImage(path);
  if (!image) return tl::unexpected<Error>(image.error());
  return ImageSize{image->width, image->height};
}

std::string ImageLibraryVersion() { return CV_VERSION; }

}  // namespace lowlap
