#include "lowlap/features/internal/opencv.h"

#include <mutex>

namespace lowlap {
namespace {

std::mutex g_mutex;
int g_num_holders = 0;
int g_threads_before = 0;

}  // namespace

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
