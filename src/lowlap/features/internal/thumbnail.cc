#include "lowlap/features/internal/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/opencv.h"

namespace lowlap {
namespace {

// JPEG files are decoded at an eighth to the whole of their size, which is
// quicker the smaller it is.
int DecodingFlags(int width_px, int max_width_px) {
  const int reduction = width_px / std::max(1, max_width_px);
  return reduction >= 8   ? cv::IMREAD_REDUCED_COLOR_8
         : reduction >= 4 ? cv::IMREAD_REDUCED_COLOR_4
         : reduction >= 2 ? cv::IMREAD_REDUCED_COLOR_2
                          : cv::IMREAD_COLOR;
}

}  // namespace

Result<std::string> MakeThumbnail(const std::string& bytes, int max_width_px,
                                  const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const ImageSize size, DecodeImageSize(bytes, path));
  const auto make = [&]() -> Result<std::string> {
    const SingleThreadedOpenCv single_threaded;
    LOWLAP_ASSIGN_OR_RETURN(
        cv::Mat image,
        DecodeAsStored(bytes, DecodingFlags(size.width_px, max_width_px),
                       path));
    if (image.cols > max_width_px) {
      const int height = std::max<int>(
          1, static_cast<int>(std::lround(static_cast<double>(max_width_px) *
                                          size.height_px / size.width_px)));
      cv::resize(image, image, {max_width_px, height}, 0, 0, cv::INTER_AREA);
    }
    std::vector<std::uint8_t> jpeg;
    cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, 80});
    return std::string(jpeg.begin(), jpeg.end());
  };
  return ReadWithOpenCv(path, make);
}

}  // namespace lowlap
