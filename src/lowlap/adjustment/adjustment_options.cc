#include "lowlap/adjustment/adjustment_options.h"

#include <cmath>
#include <string>
#include <utility>

namespace lowlap {

Status AdjustmentOptions::Validate() const {
  const auto invalid = [](const std::string& message) {
    return MakeError(ErrorCode::kInvalidArgument, message);
  };
  if (!use_points && !use_lines) {
    return invalid("points or lines must be used in the adjustment");
  }
  if (max_iterations < 1) return invalid("max_iterations must be positive");
  if (max_pairs_per_line < 1) {
    return invalid("max_pairs_per_line must be positive");
  }
  if (max_outlier_rounds < 0) {
    return invalid("max_outlier_rounds must not be negative");
  }
  for (const auto& [value, name] :
       {std::pair(outlier_round_tolerance, "outlier_round_tolerance"),
        std::pair(max_relative_depth_stddev, "max_relative_depth_stddev"),
        std::pair(max_relative_line_depth_stddev,
                  "max_relative_line_depth_stddev"),
        std::pair(min_two_view_line_overlap, "min_two_view_line_overlap"),
        std::pair(principal_point_stddev, "principal_point_stddev"),
        std::pair(function_tolerance, "function_tolerance")}) {
    if (!(value >= 0) || !std::isfinite(value)) {
      return invalid(std::string(name) + " must be finite and not negative");
    }
  }
  if (!(min_threshold_px > 0) || !std::isfinite(max_threshold_px) ||
      !(max_threshold_px > min_threshold_px)) {
    return invalid("need 0 < min_threshold_px < max_threshold_px");
  }
  return {};
}

}  // namespace lowlap
