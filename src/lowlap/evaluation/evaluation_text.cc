#include "lowlap/core/internal/format.h"
#include "lowlap/evaluation/internal/relative_errors.h"
#include "lowlap/evaluation/pose_errors.h"

namespace lowlap {
namespace {

std::string SummaryLine(const std::string& name,
                        const ErrorStatistics& statistics) {
  return name + Format(": mean %.6g, median %.6g, max %.6g, RMSE %.6g\n",
                       statistics.mean, statistics.median, statistics.max,
                       statistics.rmse);
}

std::string TripletName(const ViewTriplet& views) {
  return Format("%u-%u-%u", views.first.value(), views.middle.value(),
                views.last.value());
}

}  // namespace

std::string ToText(const PoseEvaluation& evaluation) {
  std::string text;
  const bool full = evaluation.scope == EvaluationScope::kFull;
  if (evaluation.scope != EvaluationScope::kNothing) {
    text += Format("%-24s %14s %14s\n", "view", "position", "rotation_deg");
    for (const ViewPoseError& error : evaluation.views) {
      const std::string position =
          full ? Format("%.6g", error.position_error) : "-";
      text += Format("%-24s %14s %14.6f\n", error.name.c_str(),
                     position.c_str(), error.rotation_error_deg);
    }
  }
  for (const std::string& name : evaluation.unsolved) {
    text += Format("%-24s %14s\n", name.c_str(), "not solved");
  }
  for (const std::string& name : evaluation.without_truth) {
    text += Format("%-24s %14s\n", name.c_str(), "no truth");
  }
  text += Format("cameras: %d of %d\n", evaluation.num_solved,
                 evaluation.num_total);
  if (full) {
    text +=
        SummaryLine("position error (unit of the truth)", evaluation.position);
  }
  if (evaluation.scope != EvaluationScope::kNothing) {
    text += SummaryLine("rotation error (degrees)", evaluation.rotation_deg);
  }
  if (full) {
    text += Format(
        "turn between the frames of positions and of rotations (degrees): "
        "%.6g\n",
        evaluation.frame_disagreement_deg);
  }
  if (!evaluation.note.empty()) text += "note: " + evaluation.note + "\n";
  return text;
}

std::string ToText(const RelativePoseEvaluation& evaluation) {
  std::string text =
      Format("%-16s %14s %14s\n", "pair", "rotation_deg", "direction_deg");
  for (const RelativePoseError& error : evaluation.pairs) {
    const std::string direction =
        error.direction_error_deg ? Format("%.4f", *error.direction_error_deg)
                                  : "-";
    text += Format("%-16s %14.4f %14s\n", PairName(error.views).c_str(),
                   error.rotation_error_deg, direction.c_str());
  }
  text += Format("relative poses: %zu, without truth: %d\n",
                 evaluation.pairs.size(), evaluation.num_without_truth);
  text += SummaryLine("rotation error (degrees)", evaluation.rotation_deg);
  text += SummaryLine("direction error (degrees)", evaluation.direction_deg);
  return text;
}

std::string ToText(const ScaleRatioEvaluation& evaluation) {
  std::string text = Format("%-20s %14s %12s %12s %12s\n", "triplet", "verdict",
                            "true_log", "log_error", "stddev");
  for (const ScaleRatioError& error : evaluation.ratios) {
    text += Format("%-20s %14s %12.5f %12.5f %12.5f\n",
                   TripletName(error.views).c_str(),
                   RatioVerdictName(error.verdict), error.true_log_ratio,
                   error.log_error, error.stddev);
  }
  text += Format(
      "ratios: %zu, meaningful: %d, no candidates: %d, without truth: %d\n",
      evaluation.ratios.size(), evaluation.abs_log_error.count,
      evaluation.num_no_candidates, evaluation.num_without_truth);
  text += SummaryLine("log error of the meaningful ratios",
                      evaluation.abs_log_error);
  return text;
}

}  // namespace lowlap
