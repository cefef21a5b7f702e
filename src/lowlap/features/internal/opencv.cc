#include "lowlap/features/internal/opencv.h"

#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "lowlap/features/internal/image_head.h"

namespace lowlap {
namespace {

std::mutex g_mutex;
int g_num_holders = 0;
int g_threads_before = 0;

}  // namespace

Result<cv::Mat> DecodeAsStored(const std::string& bytes, int flags,
                               const std::string& path) {
  // OpenCV turns a TIFF image even if it is told not to.
  const std::optional<std::string> upright = WithoutTiffOrientation(bytes);
  const std::string& file = upright ? *upright : bytes;
  // A view; OpenCV has no const matrix.
  const cv::Mat encoded(1, static_cast<int>(file.size()), CV_8UC1,
                        const_cast<char*>(file.data()));
  cv::Mat image = cv::imdecode(encoded, flags | cv::IMREAD_IGNORE_ORIENTATION);
  if (image.empty()) {
    return MakeError(ErrorCode::kParse, "not an image that can be read", path);
  }
  return image;
}

SingleThreadedOpenCv::SingleThreadedOpenCv() {
  const std::lock_guard<std::mutex> lock(g_mutex);
  if (g_num_holders++ > 0) return;
  g_threads_before = cv::getNumThreads();
  cv::setNumThreads(1);
}

SingleThreadedOpenCv::~SingleThreadedOpenCv() {
  const std::lock_guard<std::mutex> lock(g_mutex);
  if (--g_num_holders == 0) cv::setNumThreads(g_threads_before);
}

}  // namespace lowlap
