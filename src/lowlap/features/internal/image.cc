#include "lowlap/features/internal/image.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/core/version.hpp>
#include <opencv2/imgcodecs.hpp>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/features/internal/image_head.h"
#include "lowlap/features/internal/jpeg_damage.h"
#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

// The size of an image that may be decoded.
Result<ImageSize> CheckedSize(const std::string& bytes,
                              const std::string& path) {
  const auto head = ReadImageHead(bytes);
  if (!head) {
    return MakeError(ErrorCode::kParse, "not an image that can be read", path);
  }
  if (head->is_cut_off) {
    return MakeError(ErrorCode::kParse,
                     "the JPEG file is cut off: its " +
                         std::to_string(bytes.size()) +
                         " bytes end before the image does",
                     path);
  }
  const ImageSize size = head->size;
  const auto refuse = [&](const std::string& most) {
    return MakeError(ErrorCode::kUnsupported,
                     "an image of " + std::to_string(size.width_px) + " x " +
                         std::to_string(size.height_px) + " pixels; " + most +
                         " is the most",
                     path);
  };
  if (static_cast<double>(size.width_px) * size.height_px > kMaxImagePixels) {
    return refuse("300 megapixels");
  }
  if (std::max(size.width_px, size.height_px) > kMaxImageSidePx) {
    return refuse("a side of " + std::to_string(kMaxImageSidePx));
  }
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
  LOWLAP_RETURN_IF_ERROR(CheckedSize(bytes, path));
  if (const auto damage = JpegDamage(bytes)) {
    return MakeError(ErrorCode::kParse,
                     "a part of the image is lost: " + *damage, path);
  }
  return ReadWithOpenCv(path, [&]() -> Result<GrayImage> {
    GrayImage image;
    LOWLAP_ASSIGN_OR_RETURN(const cv::Mat pixels,
                            DecodeAsStored(bytes, cv::IMREAD_GRAYSCALE, path));
    image.width = pixels.cols;
    image.height = pixels.rows;
    image.pixels.assign(pixels.begin<std::uint8_t>(),
                        pixels.end<std::uint8_t>());
    return image;
  });
}

Result<ImageSize> ReadImageSize(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
  return DecodeImageSize(bytes, path);
}

Result<ImageSize> DecodeImageSize(const std::string& bytes,
                                  const std::string& path) {
  return CheckedSize(bytes, path);
}

std::string ImageLibraryVersion() { return CV_VERSION; }

}  // namespace lowlap
