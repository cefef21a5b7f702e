#include "lowlap/adjustment/internal/intrinsic_refinement.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <sstream>
#include <utility>

#include "lowlap/scene/internal/intrinsic_shift.h"

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

// "; focal 800.00, 801.00 -> 810.00, 811.01; ..."
std::string Changes(const Intrinsic& before, const Intrinsic& after) {
  std::vector<double> coefficients = before.distortion;
  coefficients.resize(after.distortion.size(), 0);
  return Change("focal", {before.fx_px, before.fy_px},
                {after.fx_px, after.fy_px}, "%.2f") +
         Change("principal point",
                {before.principal_point_px.x(), before.principal_point_px.y()},
                {after.principal_point_px.x(), after.principal_point_px.y()},
                "%.2f") +
         Change("distortion", coefficients, after.distortion, "%.3g");
}

}  // namespace

void RefineAllIntrinsics(const IntrinsicRefinement& refinement, Scene* scene,
                         AdjustmentOptions* options) {
  options->refine_intrinsics.clear();
  if (!refinement.Any()) return;
  for (auto& [id, intrinsic] : scene->intrinsics) {
    if (intrinsic.model == CameraModel::kSpherical) continue;
    if (refinement.distortion && intrinsic.model == CameraModel::kPinhole) {
      scene->given_intrinsics.emplace(id, intrinsic);
      intrinsic.model = CameraModel::kRadialK1;
      intrinsic.distortion = {0};
    }
    options->refine_intrinsics[id] = refinement;
  }
}

void RestoreGivenIntrinsics(Scene* scene) {
  for (auto& [id, given] : scene->given_intrinsics) {
    scene->intrinsics.at(id) = std::move(given);
  }
  scene->given_intrinsics.clear();
}

double LargestIntrinsicShiftPx(const Scene& scene) {
  double largest_px = 0;
  for (const auto& [id, given] : scene.given_intrinsics) {
    largest_px =
        std::max(largest_px, IntrinsicShiftPx(given, scene.intrinsics.at(id)));
  }
  return largest_px;
}

std::vector<std::string> DescribeIntrinsicChanges(const Scene& scene) {
  std::vector<std::string> lines;
  for (const auto& [id, given] : scene.given_intrinsics) {
    const Intrinsic& now = scene.intrinsics.at(id);
    if (given == now) continue;
    lines.push_back("intrinsic " + std::to_string(id.value()) + " (" +
                    CameraModelName(now.model) + ")" + Changes(given, now));
  }
  return lines;
}

IntrinsicRefinement Others(const IntrinsicRefinement& refinement) {
  return {!refinement.focal, !refinement.principal_point,
          !refinement.distortion, !refinement.aspect_ratio};
}

std::string DescribeParts(const IntrinsicRefinement& refinement) {
  std::string text;
  for (const auto& [named, name] :
       {std::pair(refinement.focal, "focal"),
        std::pair(refinement.aspect_ratio, "aspect"),
        std::pair(refinement.principal_point, "principal-point"),
        std::pair(refinement.distortion, "distortion")}) {
    if (named) text += (text.empty() ? "" : ",") + std::string(name);
  }
  return text;
}

Result<IntrinsicRefinement> ParseRefinement(const std::string& parts) {
  IntrinsicRefinement refinement;
  std::istringstream list(parts);
  for (std::string part; std::getline(list, part, ',');) {
    const bool all = part == "all";
    const bool known = all || part == "focal" || part == "aspect" ||
                       part == "principal-point" || part == "distortion";
    if (!known && !part.empty()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "intrinsics have no part '" + part +
                           "'; known: focal, aspect, principal-point, "
                           "distortion, all");
    }
    refinement.focal |= all || part == "focal";
    refinement.aspect_ratio |= all || part == "aspect";
    refinement.principal_point |= all || part == "principal-point";
    refinement.distortion |= all || part == "distortion";
  }
  return refinement;
}

std::vector<std::string> DescribeCalibrationPreferences(
    const AdjustmentSummary& summary) {
  std::vector<std::string> lines;
  for (const CalibrationPreference& preference :
       summary.calibration_preferences) {
    IntrinsicRefinement flag = preference.refined;
    flag.focal |= preference.parts.focal;
    flag.aspect_ratio |= preference.parts.aspect_ratio;
    flag.principal_point |= preference.parts.principal_point;
    flag.distortion |= preference.parts.distortion;
    const std::size_t others = preference.intrinsics.size() - 1;
    lines.push_back(
        "the images prefer another calibration of intrinsic " +
        std::to_string(preference.intrinsics.front().value()) +
        (others > 0 ? " and, likewise, " + std::to_string(others) + " more"
                    : "") +
        " than the one that is held, by " +
        Numbers({preference.deviations}, "%.1f") + " deviations" +
        Changes(preference.held, preference.preferred) +
        "; --refine-intrinsics " + DescribeParts(flag) + " follows them");
  }
  return lines;
}

}  // namespace lowlap
