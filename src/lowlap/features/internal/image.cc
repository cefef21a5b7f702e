#include "lowlap/features/internal/image.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <opencv2/core/version.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
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

// Width and height of a BMP file with any of its usual headers; the height is
// negative where rows run from the top.
std::optional<ImageSize> BmpSize(const std::string& bytes) {
  if (bytes.size() < 26 || bytes.compare(0, 2, "BM") != 0) return std::nullopt;
  std::int32_t size[2];
  std::memcpy(size, bytes.data() + 18, sizeof(size));
  if (size[1] == INT32_MIN) return std::nullopt;
  return ImageSize{size[0], std::abs(size[1])};
}

// What the markers of a JPEG file say.
struct JpegFrame {
  ImageSize size;         // 0 x 0: no frame
  bool complete = false;  // the image's end is there
};

// Walks over the segments of a JPEG file, and over the coded data that follow
// each start of scan: an embedded thumbnail, with an end of its own, lies
// inside a segment. nullopt: no JPEG file.
std::optional<JpegFrame> ReadJpegFrame(const std::string& bytes) {
  if (bytes.compare(0, 2, "\xff\xd8") != 0) return std::nullopt;
  JpegFrame frame;
  std::size_t at = 2;
  while (at + 2 <= bytes.size()) {
    if (BigEndian(bytes, at, 1) != 0xff) return frame;
    const std::size_t marker = BigEndian(bytes, at + 1, 1);
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    if (marker == 0xd9) {
      frame.complete = true;
      return frame;
    }
    if (at + 9 > bytes.size()) return frame;
    // C0..CF are frames, except for tables of Huffman codes (C4), arithmetic
    // conditioning (CC) and the reserved C8.
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 &&
        marker != 0xcc) {
      frame.size = SizeAt(bytes, at + 7, at + 5, 2);
    }
    at += 2 + BigEndian(bytes, at + 2, 2);
    if (marker != 0xda) continue;
    // Coded data: ff is followed by 00, or by a restart marker.
    for (; (at = bytes.find('\xff', at)) != std::string::npos; at += 2) {
      if (at + 2 > bytes.size()) return frame;
      const std::size_t next = BigEndian(bytes, at + 1, 1);
      if (next != 0 && !(next >= 0xd0 && next <= 0xd7)) break;
    }
    if (at == std::string::npos) return frame;
  }
  return frame;
}

Status CheckSize(const ImageSize& size, const std::string& path) {
  if (static_cast<double>(size.width_px) * size.height_px <= kMaxImagePixels) {
    return {};
  }
  return MakeError(ErrorCode::kUnsupported,
                   "an image of " + std::to_string(size.width_px) + " x " +
                       std::to_string(size.height_px) +
                       " pixels; 300 megapixels is the most",
                   path);
}

// The size that the head of the file gives, nullopt if that takes decoding.
Result<std::optional<ImageSize>> SizeFromHead(const std::string& bytes,
                                              const std::string& path) {
  std::optional<ImageSize> size = PngSize(bytes);
  if (!size) size = BmpSize(bytes);
  if (const auto frame = ReadJpegFrame(bytes); frame && frame->size.width_px) {
    size = frame->size;
    if (!frame->complete) {
      return MakeError(ErrorCode::kParse,
                       "the JPEG file is cut off: its " +
                           std::to_string(bytes.size()) +
                           " bytes end before the image does",
                       path);
    }
  }
  if (!size || size->width_px <= 0 || size->height_px <= 0) {
    return std::optional<ImageSize>();
  }
  LOWLAP_RETURN_IF_ERROR(CheckSize(*size, path));
  return size;
}

}  // namespace

Status GrayImage::Validate() const {
  const std::string size =
      "an image of " + std::to_string(width) + " x " + std::to_string(height);
  return Require(
      {{width > 0 && height > 0, size + " pixels"},
       {pixels.size() ==
            static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
        size + " with " + std::to_string(pixels.size()) + " pixels"}});
}

Result<GrayImage> ReadGrayImage(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
  return DecodeGrayImage(bytes, path);
}

Result<GrayImage> DecodeGrayImage(const std::string& bytes,
                                  const std::string& path) {
  LOWLAP_RETURN_IF_ERROR(SizeFromHead(bytes, path));
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
    LOWLAP_RETURN_IF_ERROR(CheckSize({image.width, image.height}, path));
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
  LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
  return DecodeImageSize(bytes, path);
}

Result<ImageSize> DecodeImageSize(const std::string& bytes,
                                  const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const auto size, SizeFromHead(bytes, path));
  if (size) return *size;
  LOWLAP_ASSIGN_OR_RETURN(const GrayImage image, DecodeGrayImage(bytes, path));
  return ImageSize{image.width, image.height};
}

std::string ImageLibraryVersion() { return CV_VERSION; }

}  // namespace lowlap
