#include "lowlap/pipeline/internal/output/page_photographs.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/thumbnail.h"

namespace lowlap {
namespace {

// So that all together take a few megabytes.
int WidthFor(std::size_t num_views) {
  constexpr double kLargest = 480, kSmallest = 120;
  constexpr double kNumLargest = 100;
  const double width =
      kLargest *
      std::sqrt(kNumLargest /
                std::max(kNumLargest, static_cast<double>(num_views)));
  return static_cast<int>(std::max(kSmallest, width));
}

}  // namespace

Result<std::map<ViewId, std::string>> PagePhotographs(
    const Scene& scene, const RunContext& context) {
  std::vector<ViewId> views;
  for (const auto& [id, view] : scene.views) views.push_back(id);
  const int width_px = WidthFor(views.size());
  std::vector<std::string> jpegs(views.size());
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, "photographs", views.size(), [&](std::size_t n) {
        const std::string path = scene.ImagePath(views[n]);
        const auto bytes = ReadWholeFile(path);
        if (!bytes) return;
        auto jpeg = MakeThumbnail(*bytes, width_px, path);
        if (jpeg) jpegs[n] = *std::move(jpeg);
      }));
  std::map<ViewId, std::string> photographs;
  for (std::size_t n = 0; n < views.size(); ++n) {
    if (!jpegs[n].empty()) photographs[views[n]] = std::move(jpegs[n]);
  }
  return photographs;
}

}  // namespace lowlap
