#include "lowlap/pipeline/stage_log.h"

#include <sys/resource.h>

#include <chrono>
#include <utility>

namespace lowlap {
namespace {

double WallSeconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) +
           1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

StageLog::Scope::Scope(StageLog* log, std::string name)
    : log_(log), wall_start_s_(WallSeconds()), cpu_start_s_(CpuSeconds()) {
  cost_.name = std::move(name);
}

StageLog::Scope::~Scope() {
  cost_.wall_s = WallSeconds() - wall_start_s_;
  cost_.cpu_s = CpuSeconds() - cpu_start_s_;
  if (log_ != nullptr) log_->stages_.push_back(std::move(cost_));
}

double PeakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace lowlap
