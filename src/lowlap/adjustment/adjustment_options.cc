#include "lowlap/adjustment/adjustment_options.h"

#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/requirement.h"

namespace lowlap {

Status AdjustmentOptions::Validate() const {
  if (Status status = Require(
          {{use_points || use_lines,
            "points or lines must be used in the adjustment"},
           {max_iterations >= 1, "max_iterations must be positive"},
           {max_pairs_per_line >= 1, "max_pairs_per_line must be positive"},
           {max_outlier_rounds >= 0, "max_outlier_rounds must not be negative"},
           {min_threshold_px > 0 && std::isfinite(max_threshold_px) &&
                max_threshold_px > min_threshold_px,
            "need 0 < min_threshold_px < max_threshold_px"}});
      !status) {
    return status;
  }
  return RequireNotNegative(
      {{outlier_round_tolerance, "outlier_round_tolerance"},
       {max_relative_depth_stddev, "max_relative_depth_stddev"},
       {max_relative_line_depth_stddev, "max_relative_line_depth_stddev"},
       {min_two_view_line_overlap, "min_two_view_line_overlap"},
       {principal_point_stddev, "principal_point_stddev"},
       {function_tolerance, "function_tolerance"}});
}

Status StructureOptions::Validate() const {
  return RequireNotNegative(
      {{max_point_error_px, "max_point_error_px"},
       {max_line_error_px, "max_line_error_px"},
       {max_relative_depth_stddev, "max_relative_depth_stddev"},
       {max_relative_line_depth_stddev, "max_relative_line_depth_stddev"},
       {min_two_view_line_overlap, "min_two_view_line_overlap"},
       {min_coplanar_angle_deg, "min_coplanar_angle_deg"}});
}

Status SetAdjustedFeatures(const std::vector<std::string>& features,
                           AdjustmentOptions* options) {
  const auto has = [&](const char* name) {
    return std::find(features.begin(), features.end(), name) != features.end();
  };
  for (const std::string& name : features) {
    if (name != "points" && name != "lines" && name != "coplanar") {
      return MakeError(ErrorCode::kInvalidArgument,
                       "unknown kind of feature '" + name +
                           "'; known: points, lines, coplanar");
    }
  }
  options->use_points = has("points");
  options->use_coplanar = has("coplanar");
  options->use_lines = has("lines") || options->use_coplanar;
  return {};
}

Result<CoplanarTies> ParseCoplanarTies(const std::string& name) {
  if (name == "pairs") return CoplanarTies::kPairs;
  if (name == "planes") return CoplanarTies::kPlanes;
  if (name == "both") return CoplanarTies::kBoth;
  return MakeError(
      ErrorCode::kInvalidArgument,
      "unknown coplanar ties '" + name + "'; known: pairs, planes, both");
}

}  // namespace lowlap
