#include "lowlap/pipeline/internal/decisions/decide_by_structure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"
#include "lowlap/pipeline/internal/decisions/motion_trials.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxPairs = 8;
constexpr double kDecisiveLogLikelihood = 46;  // times minus two
constexpr double kDecisiveCostShare = 0.1;

// By how much `worse` is behind, if that is finite.
struct Lead {
  double margin = 0;
  bool is_decisive = false;

  Lead(double better, double worse) {
    if (!std::isfinite(worse)) return;
    margin = std::max(0.0, worse - better);
    is_decisive =
        margin >= std::max(kDecisiveLogLikelihood, kDecisiveCostShare * better);
  }
};

std::vector<ViewPair> UndecidedInUse(const Scene& scene,
                                     const PoseSummary& poses,
                                     const std::set<ViewPair>& changed) {
  const std::set<ViewId> unplaced(poses.unplaced.begin(), poses.unplaced.end());
  const std::vector<ViewPair> outliers = PairsOf(poses.outlier_edges);
  std::set<ViewPair> left_out = changed;
  left_out.insert(outliers.begin(), outliers.end());
  std::vector<std::pair<double, ViewPair>> by_spread;
  for (const auto& [views, pose] : scene.relative_poses) {
    if (!pose.alternatives.empty() && unplaced.count(views.first) == 0 &&
        unplaced.count(views.second) == 0 && left_out.count(views) == 0) {
      by_spread.emplace_back(-MotionSpread(pose), views);
    }
  }
  std::sort(by_spread.begin(), by_spread.end());
  if (by_spread.size() > kMaxPairs) by_spread.resize(kMaxPairs);
  std::vector<ViewPair> pairs;
  pairs.reserve(by_spread.size());
  for (const auto& entry : by_spread) pairs.push_back(entry.second);
  return pairs;
}

// The present motions, and every other one of the pairs.
std::vector<MotionTrial> TrialsOf(const std::vector<ViewPair>& pairs,
                                  const Scene& scene,
                                  const PoseSummary& poses) {
  std::vector<MotionTrial> trials(1);
  trials.front().scene = scene;
  trials.front().poses = poses;
  for (const ViewPair& views : pairs) {
    const RelativePose& pose = scene.relative_poses.at(views);
    for (std::size_t n = 1; n < NumHypotheses(pose); ++n) {
      trials.emplace_back();
      trials.back().views = views;
      trials.back().motion = n;
    }
  }
  return trials;
}

// The least cost of another motion of the pair than that of `chosen`;
// +infinity, which decides nothing, if any could not be tried.
double LeastOfOthers(const std::vector<MotionTrial>& trials,
                     const ViewPair& views, const MotionTrial& chosen) {
  double least = kInfinity;
  for (const MotionTrial& trial : trials) {
    const bool is_of_pair = trial.motion == 0 || trial.views == views;
    if (!is_of_pair || &trial == &chosen) continue;
    if (!std::isfinite(trial.cost)) return kInfinity;
    least = std::min(least, trial.cost);
  }
  return least;
}

class Decider {
 public:
  Decider(Scene* scene, SolveResult* result) : scene_(scene), result_(result) {
    for (HypothesisDecision& decision : result->motions) {
      decisions_[decision.views] = &decision;
    }
  }

  // The motion of `chosen`, one of the trials, for the pair.
  void Decide(const std::vector<MotionTrial>& trials, const ViewPair& views,
              const MotionTrial& chosen) {
    const Lead lead(chosen.cost, LeastOfOthers(trials, views, chosen));
    HypothesisDecision& decision = *decisions_.at(views);
    decision.margin = lead.margin;
    decision.replaced = chosen.motion != 0;
    if (!lead.is_decisive) return;
    decision.grounds = HypothesisGrounds::kStructure;
    RelativePose& pose = scene_->relative_poses.at(views);
    pose = WithHypothesis(pose, 0);
  }

  void Take(MotionTrial* trial) {
    *scene_ = std::move(trial->scene);
    result_->ratios = trial->ratios;
    result_->poses = std::move(trial->poses);
  }

 private:
  Scene* scene_;
  SolveResult* result_;
  std::map<ViewPair, HypothesisDecision*> decisions_;
};

Status ChooseMotions(const SceneRotations& rotations,
                     const SolveOptions& options, const RunContext& context,
                     StageLog* stages, Scene* scene, SolveResult* result) {
  Decider decider(scene, result);
  std::set<ViewPair> changed;
  std::optional<StageLog::Scope> scope;
  for (;;) {
    const auto pairs = UndecidedInUse(*scene, result->poses, changed);
    if (pairs.empty()) return {};
    if (!scope) scope.emplace(stages, "ambiguous planes");
    std::vector<MotionTrial> trials = TrialsOf(pairs, *scene, result->poses);
    LOWLAP_RETURN_IF_ERROR(
        RunMotionTrials(rotations, options, context, &trials));
    const auto best = std::min_element(
        trials.begin(), trials.end(),
        [](const auto& a, const auto& b) { return a.cost < b.cost; });
    if (!Lead(best->cost, trials.front().cost).is_decisive) {
      for (const ViewPair& views : pairs) {
        decider.Decide(trials, views, trials.front());
      }
      return {};
    }
    changed.insert(best->views);
    decider.Take(&*best);
    decider.Decide(trials, best->views, *best);
  }
}

}  // namespace

Status DecideHypothesesByStructure(const SceneRotations& rotations,
                                   const SolveOptions& options,
                                   const RunContext& context, StageLog* stages,
                                   Scene* scene, SolveResult* result) {
  if (options.adjust) {
    LOWLAP_RETURN_IF_ERROR(
        ChooseMotions(rotations, options, context, stages, scene, result));
  }
  LogDecisions(result->motions, *scene, context);
  return {};
}

}  // namespace lowlap
