#include "lowlap/features/internal/points/point_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "lowlap/core/internal/format.h"

namespace lowlap {
namespace {

double MemoryLimitGb() {
  double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                 static_cast<double>(sysconf(_SC_PAGESIZE));
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  }
  return 1e-9 * bytes;
}

}  // namespace

Status CheckMemoryOfPoints(int width_px, int height_px,
                           const std::string& path) {
  const double needed_gb =
      1e-9 * kPointBytesPerPixel * static_cast<double>(width_px) * height_px;
  if (needed_gb <= MemoryLimitGb()) return {};
  return MakeError(ErrorCode::kUnsupported,
                   Format("the points of an image of %d x %d pixels take about "
                          "%.1f GB of memory, there are at most %.1f",
                          width_px, height_px, needed_gb, MemoryLimitGb()),
                   path);
}

RunContext WithinPointMemory(const RunContext& context, double pixels,
                             double max_memory_gb) {
  RunContext limited = context;
  limited.num_threads = static_cast<int>(
      std::clamp(max_memory_gb * 1e9 / (kPointBytesPerPixel * pixels), 1.0,
                 static_cast<double>(context.ThreadCount())));
  return limited;
}

}  // namespace lowlap
