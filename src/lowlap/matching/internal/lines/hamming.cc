#include "lowlap/matching/internal/lines/hamming.h"

#include <cstdint>
#include <opencv2/core.hpp>

namespace lowlap {

void HammingDistances(const LineDescriptor& query,
                      const std::vector<LineDescriptor>& others,
                      std::vector<int>* distances) {
  distances->resize(others.size());
  if (others.empty()) return;
  // Views; OpenCV has no const matrix.
  const int length = static_cast<int>(query.size());
  const int count = static_cast<int>(others.size());
  const cv::Mat one(1, length, CV_8U, const_cast<std::uint8_t*>(query.data()));
  const cv::Mat all(count, length, CV_8U,
                    const_cast<std::uint8_t*>(others.front().data()));
  cv::Mat result(1, count, CV_32S, distances->data());
  cv::batchDistance(one, all, result, CV_32S, cv::noArray(), cv::NORM_HAMMING,
                    0);
}

}  // namespace lowlap
