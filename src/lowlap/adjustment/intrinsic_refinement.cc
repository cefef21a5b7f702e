#include "lowlap/adjustment/intrinsic_refinement.h"

#include <algorithm>
#include <cstdio>
#include <optional>

namespace lowlap {
namespace {

std::string Numbers(const std::vector<double>& values, const char* format) {
  std::string text;
  for (const double value : values) {
    char number[64];
    std::snprintf(number, sizeof number, format, value);
    text += (text.empty() ? "" : ", ") + std::string(number);
  }
  return text;
}

std::string Change(const char* name, const std::vector<double>& before,
                   const std::vector<double>& after, const char* format) {
  if (before == after) return {};
  return std::string("; ") + name + ' ' + Numbers(before, format) + " -> " +
         Numbers(after, format);
}

}  // namespace

void RefineAllIntrinsics(const IntrinsicRefinement& refinement, Scene* scene,
                         AdjustmentOptions* options) {
  options->refine_intrinsics.clear();
  if (!refinement.Any()) return;
  for (auto& [id, intrinsic] : scene->intrinsics) {
    if (intrinsic.model == CameraModel::kSpherical) continue;
    if (refinement.distortion && intrinsic.model == CameraModel::kPinhole) {
      intrinsic.model = CameraModel::kRadialK1;
      intrinsic.distortion = {0};
    }
    options->refine_intrinsics[id] = refinement;
  }
}

double LargestIntrinsicShiftPx(const Scene& before, const Scene& after) {
  double largest_px = 0;
  for (const auto& [id, now] : after.intrinsics) {
    const auto found = before.intrinsics.find(id);
    if (found == before.intrinsics.end()) continue;
    for (const double x : {0.0, 0.5, 1.0}) {
      for (const double y : {0.0, 0.5, 1.0}) {
        const Vec2 pixel(x * now.width_px, y * now.height_px);
        const std::optional<Vec3> ray = found->second.Bearing(pixel);
        if (ray) {
          largest_px = std::max(largest_px, (now.Project(*ray) - pixel).norm());
        }
      }
    }
  }
  return largest_px;
}

std::vector<std::string> DescribeIntrinsicChanges(const Scene& before,
                                                  const Scene& after) {
  std::vector<std::string> lines;
  for (const auto& [id, now] : after.intrinsics) {
    const auto found = before.intrinsics.find(id);
    if (found == before.intrinsics.end() || found->second == now) continue;
    const Intrinsic& old = found->second;
    std::vector<double> coefficients = old.distortion;
    coefficients.resize(now.distortion.size(), 0);
    lines.push_back(
        "intrinsic " + std::to_string(id) + " (" + CameraModelName(now.model) +
        ")" +
        Change("focal", {old.fx_px, old.fy_px}, {now.fx_px, now.fy_px},
               "%.2f") +
        Change("principal point",
               {old.principal_point_px.x(), old.principal_point_px.y()},
               {now.principal_point_px.x(), now.principal_point_px.y()},
               "%.2f") +
        Change("distortion", coefficients, now.distortion, "%.5f"));
  }
  return lines;
}

}  // namespace lowlap
