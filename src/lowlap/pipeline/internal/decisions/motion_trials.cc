#include "lowlap/pipeline/internal/decisions/motion_trials.h"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <utility>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/believed_evidence.h"

namespace lowlap {
namespace {

RelativePose WithMotionFirst(const RelativePose& pose, std::size_t n) {
  RelativePose result = WithHypothesis(pose, n);
  result.alternatives = pose.alternatives;
  if (n > 0) result.alternatives[n - 1] = pose.AsAlternative();
  return result;
}

std::vector<ViewPair> FalseInAll(const std::vector<MotionTrial>& trials) {
  std::vector<ViewPair> common = FalsePairs(trials.front().poses);
  for (const MotionTrial& trial : trials) {
    if (!trial.status) continue;
    const std::vector<ViewPair> pairs = FalsePairs(trial.poses);
    std::vector<ViewPair> both;
    std::set_intersection(common.begin(), common.end(), pairs.begin(),
                          pairs.end(), std::back_inserter(both));
    common = std::move(both);
  }
  return common;
}

class Runner {
 public:
  Runner(const SceneRotations& rotations, const SolveOptions& options,
         const RunContext& context, std::vector<MotionTrial>* trials)
      : rotations_(rotations),
        options_(options),
        context_(context),
        trials_(*trials),
        of_trial_(ContextOfItem(context, trials->size(), &mutex_)) {
    options_.reuse_ratios = true;
    of_trial_.log = nullptr;
  }

  Status Run() {
    LOWLAP_RETURN_IF_ERROR(ForEach(&Runner::Compose));
    left_out_ = FalseInAll(trials_);
    LOWLAP_RETURN_IF_ERROR(ForEach(&Runner::Adjust));
    if (!trials_.front().status) return {};
    return ForEach(&Runner::Compare);
  }

 private:
  Status ForEach(Status (Runner::*step)(MotionTrial*) const) {
    LOWLAP_RETURN_IF_ERROR(
        ParallelFor(context_, {}, trials_.size(), [&](std::size_t n) {
          if (trials_[n].status) trials_[n].status = (this->*step)(&trials_[n]);
        }));
    for (const MotionTrial& trial : trials_) {
      if (!trial.status && trial.status.error().code == ErrorCode::kCancelled) {
        return trial.status;
      }
    }
    return {};
  }

  Status Compose(MotionTrial* trial) const {
    const MotionTrial& present = trials_.front();
    if (trial == &present) return {};
    Scene& scene = trial->scene;
    scene = present.scene;
    RelativePose& pose = scene.relative_poses.at(trial->views);
    pose = WithMotionFirst(pose, trial->motion);
    SolveStart start;
    start.replaced = {trial->views};
    LOWLAP_ASSIGN_OR_RETURN(
        start.rotations, AverageSceneRotations(scene, options_.poses, of_trial_,
                                               rotations_.third_views));
    AddMatchVerdicts(rotations_.matches, &start.rotations);
    LOWLAP_ASSIGN_OR_RETURN(
        trial->ratios,
        EstimateBelievedRatios(&scene, start, options_, of_trial_, nullptr));
    LOWLAP_ASSIGN_OR_RETURN(
        trial->poses, ComposePoses(&scene, start.rotations, options_.poses,
                                   of_trial_, nullptr));
    if (trial->poses.unplaced != present.poses.unplaced) {
      return MakeError(ErrorCode::kInsufficientData, "places other views");
    }
    return {};
  }

  Status Adjust(MotionTrial* trial) const {
    Scene& scene = trial->scene;
    const BelievedEvidence believed(left_out_, &scene);
    LOWLAP_RETURN_IF_ERROR(
        BuildStructure(&scene, options_.structure, of_trial_));
    Optimum optimum = LoadOptimum(scene, options_.adjustment);
    AdjustmentSummary summary;
    OptimumSearch search(options_.adjustment, of_trial_, scene, &optimum,
                         &summary);
    LOWLAP_RETURN_IF_ERROR(search.Run());
    trial->optimum = std::move(optimum);
    return {};
  }

  Status Compare(MotionTrial* trial) const {
    LOWLAP_ASSIGN_OR_RETURN(
        trial->cost,
        CostOf(*trial->optimum, *trials_.front().optimum, of_trial_));
    return {};
  }

  const SceneRotations& rotations_;
  SolveOptions options_;
  const RunContext& context_;
  std::vector<MotionTrial>& trials_;
  std::mutex mutex_;
  RunContext of_trial_;
  std::vector<ViewPair> left_out_;
};

}  // namespace

Status RunMotionTrials(const SceneRotations& rotations,
                       const SolveOptions& options, const RunContext& context,
                       std::vector<MotionTrial>* trials) {
  return Runner(rotations, options, context, trials).Run();
}

}  // namespace lowlap
