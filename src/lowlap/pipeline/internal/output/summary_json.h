#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/averaging/rigidity/internal/rigidity.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/pipeline/stage_log.h"

namespace lowlap {

/// Everything a solving command has to say about its run.
struct RunSummary {
  std::string command;
  std::vector<PairReport> pairs;
  std::vector<UnrelatedView> unrelated;
  std::optional<SolveResult> solve;
  std::optional<PoseEvaluation> evaluation_before_adjustment;
  std::optional<PoseEvaluation> evaluation;
  std::vector<StageCost> stages;
};

/// The content of summary.json. Times and memory are in "cost", apart from
/// everything that is the same in every run.
std::string ToJson(const RunSummary& summary, const Scene& scene);

/// The ratios as JSON: one object per triplet.
std::string ToJson(const std::vector<ScaleRatio>& ratios);

std::string ToJson(const RigidityReport& report);

}  // namespace lowlap
