#include "lowlap/study/compare_strategies.h"

#include <algorithm>
#include <map>
#include <utility>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"
#include "lowlap/study/internal/consistency.h"

namespace lowlap {
namespace {

struct NamedAverager {
  std::string name;
  AveragerRegistry::Averager averager;
};

Result<std::vector<NamedAverager>> MakeAveragers(
    const CompareOptions& options) {
  std::vector<NamedAverager> averagers;
  for (const std::string& name : options.registry.Expand(options.strategies)) {
    LOWLAP_ASSIGN_OR_RETURN(const auto averager, options.registry.Make(name));
    averagers.push_back({name, averager});
  }
  if (averagers.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "there is no strategy to compare");
  }
  return averagers;
}

// What all strategies share.
struct Input {
  const Scene& scene;
  const CompareOptions& options;
  std::vector<ViewPair> outliers;
  TranslationProblem problem;
};

SolutionQuality Judge(const Scene& scene, const Input& input) {
  SolutionQuality quality;
  quality.consistency = EvaluateConsistency(scene, input.outliers);
  if (input.options.truth) {
    quality.errors = EvaluatePoses(scene, *input.options.truth);
  }
  return quality;
}

std::string DescribeLimit(const StrategyResult& result,
                          const TranslationSolution& solution,
                          const std::string& needs, std::size_t num_views) {
  if (result.unplaced.empty()) return {};
  const auto in_parts = static_cast<std::size_t>(
      std::count_if(solution.component.begin(), solution.component.end(),
                    [](int component) { return component > 0; }));
  const std::size_t nowhere = result.unplaced.size() - in_parts;
  std::string limit =
      "places " +
      (result.num_placed == 0 ? "none" : std::to_string(result.num_placed)) +
      " of " + std::to_string(num_views) + " cameras";
  if (in_parts > 0) {
    limit += ", " + std::to_string(in_parts) + " more in " +
             std::to_string(solution.num_components - 1) +
             " part(s) with a scale of their own";
    if (nowhere > 0) limit += ", " + std::to_string(nowhere) + " not at all";
  }
  return limit + ". A view needs " + needs + ".";
}

void Place(const TranslationProblem& problem,
           const TranslationSolution& solution, const std::string& needs,
           Scene* scene, StrategyResult* result) {
  result->num_iterations = solution.num_iterations;
  result->num_components = solution.num_components;
  SetPoses(problem, solution, scene);
  // One camera by itself has no place.
  if (scene->poses.size() < 2) scene->poses.clear();
  for (const auto& entry : scene->views) {
    if (scene->FindPose(entry.first) == nullptr) {
      result->unplaced.push_back(entry.first);
    } else {
      ++result->num_placed;
    }
  }
  result->limit = DescribeLimit(*result, solution, needs, scene->views.size());
  result->poses_before_adjustment = result->poses = scene->poses;
}

StrategyResult RunStrategy(const NamedAverager& named, const Input& input,
                           const RunContext& context) {
  const TranslationAverager& averager = *named.averager;
  StrategyResult result;
  result.strategy = named.name;
  StageLog stages;
  Scene scene = input.scene;
  const auto run = [&]() -> Status {
    {
      Result<TranslationSolution> solution;
      {
        const StageLog::Scope scope(&stages, "averaging");
        solution = averager.Solve(input.problem, context);
      }
      if (!solution) return tl::unexpected<Error>(solution.error());
      Place(input.problem, *solution, averager.Needs(), &scene, &result);
    }
    if (result.num_placed == 0) return {};
    SolveOptions structure_only = input.options.solve;
    structure_only.adjust = false;
    const auto built = RefineSolution(&scene, structure_only, context, &stages);
    result.before = Judge(scene, input);
    if (!built) return tl::unexpected<Error>(built.error());
    if (!input.options.solve.adjust) return {};
    Result<AdjustmentSummary> adjusted;
    {
      const StageLog::Scope scope(&stages, "adjustment");
      adjusted = AdjustScene(&scene, input.options.solve.adjustment, context);
    }
    if (!adjusted) return tl::unexpected<Error>(adjusted.error());
    result.num_adjustment_iterations = adjusted->iterations;
    result.poses = scene.poses;
    result.after = Judge(scene, input);
    return {};
  };
  if (const Status status = run(); !status) result.failure = status.error();
  result.costs = stages.stages();
  return result;
}

/// Compares poses with those of the reference.
class PoseComparison {
 public:
  PoseComparison(const std::map<ViewId, View>& views,
                 const StrategyResult& reference)
      : reference_(reference), views_(views) {}

  void Judge(StrategyResult* result) {
    if (result == &reference_ || result->num_placed == 0) return;
    result->before.difference = Difference(
        result->poses_before_adjustment, reference_.poses_before_adjustment,
        reference_.before.consistency.mean_baseline);
    if (result->after && reference_.after) {
      result->after->difference =
          Difference(result->poses, reference_.poses,
                     reference_.after->consistency.mean_baseline);
    }
  }

 private:
  std::optional<ErrorStatistics> Difference(
      const std::map<PoseId, Pose>& poses,
      const std::map<PoseId, Pose>& reference, double mean_baseline) {
    GroundTruth truth;
    for (const auto& [id, view] : views_) {
      const auto pose = reference.find(view.pose_id);
      if (pose != reference.end()) truth.emplace(id, pose->second);
    }
    const PoseEvaluation evaluation = EvaluatePoses(views_, poses, truth);
    if (evaluation.scope != EvaluationScope::kFull || !(mean_baseline > 0)) {
      return std::nullopt;
    }
    ErrorStatistics difference = evaluation.position;
    for (double* value : {&difference.mean, &difference.median, &difference.max,
                          &difference.rmse}) {
      *value /= mean_baseline;
    }
    return difference;
  }

  const StrategyResult& reference_;
  const std::map<ViewId, View>& views_;
};

StrategyResult* FindReference(const std::string& name,
                              std::vector<StrategyResult>* results) {
  StrategyResult* reference = nullptr;
  for (StrategyResult& result : *results) {
    if (result.num_placed == 0) continue;
    if (result.strategy == name) return &result;
    if (reference == nullptr) reference = &result;
  }
  return reference;
}

}  // namespace

Status CompareOptions::Validate() const {
  LOWLAP_RETURN_IF_ERROR(solve.Validate());
  LOWLAP_RETURN_IF_ERROR(MakeAveragers(*this));
  LOWLAP_RETURN_IF_ERROR(registry.Make(reference));
  return {};
}

Result<Comparison> CompareStrategies(const Scene& scene,
                                     const CompareOptions& options,
                                     const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_ASSIGN_OR_RETURN(const auto averagers, MakeAveragers(options));

  Scene start_scene = scene;
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(
      const auto start,
      StartSolution(&start_scene, options.solve, context, &stages));
  LogDecisions(start.motions, start_scene, context);
  LOWLAP_RETURN_IF_ERROR(EstimateBelievedRatios(
      &start_scene, start, options.solve, context, &stages));
  start_scene.poses.clear();
  start_scene.structure.clear();
  start_scene.line_structure.clear();
  start_scene.coplanar_pairs.clear();

  Input input{start_scene, options, PairsOf(start.rotations.outliers), {}};
  const bool with_tracks = std::any_of(
      averagers.begin(), averagers.end(),
      [](const auto& each) { return each.averager->NeedsTracks(); });
  input.problem =
      MakeTranslationProblem(start_scene, start.rotations.cam_from_world,
                             input.outliers, {}, with_tracks);

  Comparison comparison;
  comparison.num_views = static_cast<int>(start_scene.views.size());
  comparison.num_edges = static_cast<int>(input.problem.edges.size());
  comparison.num_ratios = static_cast<int>(input.problem.ratios.size());
  comparison.num_outlier_edges = static_cast<int>(input.outliers.size());
  comparison.has_truth = options.truth.has_value();
  comparison.shared_costs = stages.stages();
  for (const NamedAverager& averager : averagers) {
    if (!context.Progress("strategies", comparison.results.size(),
                          averagers.size())) {
      return MakeError(ErrorCode::kCancelled, "stopped", {}, "strategies");
    }
    comparison.results.push_back(RunStrategy(averager, input, context));
    const std::optional<Error>& failure = comparison.results.back().failure;
    if (failure && failure->code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(*failure);
    }
  }
  context.Progress("strategies", averagers.size(), averagers.size());

  if (StrategyResult* reference =
          FindReference(options.reference, &comparison.results)) {
    comparison.reference = reference->strategy;
    PoseComparison poses(start_scene.views, *reference);
    for (StrategyResult& result : comparison.results) poses.Judge(&result);
  }
  return comparison;
}

}  // namespace lowlap
