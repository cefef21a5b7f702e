#include "lowlap/pipeline/internal/judge_views.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/adjustment/internal/structure/prediction_evidence.h"
#include "lowlap/averaging/centers/internal/scene_contests.h"
#include "lowlap/averaging/reliability/internal/find_reliability_warnings.h"
#include "lowlap/averaging/reliability/internal/hanging_views.h"
#include "lowlap/averaging/reliability/internal/imprecise_views.h"
#include "lowlap/averaging/reliability/internal/look_alikes.h"
#include "lowlap/averaging/reliability/internal/lost_features.h"
#include "lowlap/averaging/reliability/internal/missing_matches.h"
#include "lowlap/averaging/reliability/internal/solution_agreement.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scale/scale_ratios.h"

namespace lowlap {
namespace {

// The ratios between the cameras as they are.
Result<std::map<ViewTriplet, ScaleRatio>> MeasureBetweenCameras(
    Scene* scene, const std::vector<ViewTriplet>& triplets,
    const ScaleEstimator& estimator, const RunContext& context) {
  std::map<ViewPair, RelativePose> given;
  const auto take_over = [&](ViewId a, ViewId b) {
    RelativePose& pose = scene->relative_poses.at(OrderedPair(a, b));
    given.emplace(pose.views, pose);
    const RigidTransform cam2_from_cam1 =
        scene->FindPose(pose.views.second)->CamFromWorld() *
        scene->FindPose(pose.views.first)->CamFromWorld().Inverse();
    pose.rotation = cam2_from_cam1.rotation;
    pose.direction = cam2_from_cam1.translation.normalized();
  };
  for (const ViewTriplet& views : triplets) {
    take_over(views.first, views.middle);
    take_over(views.middle, views.last);
  }
  auto estimated = EstimateScaleRatios(*scene, triplets, estimator, context);
  for (auto& [views, pose] : given) {
    scene->relative_poses.at(views) = std::move(pose);
  }
  if (!estimated) return tl::unexpected<Error>(estimated.error());
  std::map<ViewTriplet, ScaleRatio> ratios;
  for (ScaleRatio& ratio : *estimated) {
    ratios.emplace(ratio.views, std::move(ratio));
  }
  return ratios;
}

// The poses and the structure of the scene are those of the adjustment.
Result<AdjustedEvidence> FindAdjustedEvidence(
    Scene* scene, const SolutionAgreement& agreement,
    const AdjustmentSummary& adjustment, const ScaleEstimator& estimator,
    const RunContext& context) {
  AdjustedEvidence evidence;
  for (const auto& [views, stddev] : adjustment.log_ratio_stddevs) {
    const Vec3& middle = scene->FindPose(views.middle)->center;
    const double before =
        (scene->FindPose(views.first)->center - middle).norm();
    const double after = (scene->FindPose(views.last)->center - middle).norm();
    evidence.ratios[views] = {std::log(after / before), stddev};
  }
  evidence.direction_stddevs_rad = adjustment.direction_stddevs_rad;
  std::vector<ViewPair> poor_poses = agreement.vague;
  poor_poses.insert(poor_poses.end(), agreement.untold.begin(),
                    agreement.untold.end());
  std::vector<ViewTriplet> weak_ratios;
  const std::set<ViewTriplet> agreeing(agreement.agreeing_ratios.begin(),
                                       agreement.agreeing_ratios.end());
  for (const ScaleRatio& ratio : scene->scale_ratios) {
    const auto adjusted = evidence.ratios.find(ratio.views);
    if (adjusted != evidence.ratios.end() &&
        std::isfinite(adjusted->second.log_ratio) &&
        agreeing.count(ratio.views) > 0 && IsWeak(ratio, {})) {
      weak_ratios.push_back(ratio.views);
    }
  }
  PredictionEvidence by_structure =
      FindPredictionEvidence(*scene, poor_poses, weak_ratios);
  evidence.evidence_of_pairs = std::move(by_structure.pairs);
  evidence.evidence_of_triplets = std::move(by_structure.triplets);
  for (const ViewPair& views : by_structure.contradicted) {
    evidence.contradicted.insert({views.first, views.second});
  }
  LOWLAP_ASSIGN_OR_RETURN(
      evidence.measured_again,
      MeasureBetweenCameras(scene, weak_ratios, estimator, context));
  return evidence;
}

// Weak ratios that turned out strong, or without which their views are held.
void DropNeedless(PoseSummary* poses) {
  const std::set<ViewTriplet> strong(poses->firm_evidence.ratios.begin(),
                                     poses->firm_evidence.ratios.end());
  std::set<ViewId> doubtful;
  for (const ReliabilityWarning& warning : poses->reliability_warnings) {
    doubtful.insert(warning.views.begin(), warning.views.end());
  }
  const auto is_needless = [&](const ViewTriplet& v) {
    return strong.count(v) > 0 ||
           (doubtful.count(v.first) == 0 && doubtful.count(v.middle) == 0 &&
            doubtful.count(v.last) == 0);
  };
  poses->weak_ratios.erase(
      std::remove_if(poses->weak_ratios.begin(), poses->weak_ratios.end(),
                     is_needless),
      poses->weak_ratios.end());
}

}  // namespace

Status JudgeViews(Scene* scene,
                  const std::optional<AdjustmentSummary>& adjustment,
                  const ScaleEstimator& estimator, const RunContext& context,
                  PoseSummary* poses) {
  if (adjustment && poses->agreement != nullptr) {
    LOWLAP_ASSIGN_OR_RETURN(
        const AdjustedEvidence evidence,
        FindAdjustedEvidence(scene, *poses->agreement, *adjustment, estimator,
                             context));
    poses->reliability_warnings = FindReliabilityWarnings(
        *scene, *poses->agreement, evidence, &poses->firm_evidence);
    DropNeedless(poses);
    poses->contests = ContestsThatStay(*scene, poses->contests);
  }
  for (ReliabilityWarning& doubt : FindLostFeatures(*scene)) {
    poses->reliability_warnings.push_back(std::move(doubt));
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto overlaps,
                          PredictOverlaps(*scene, context));
  for (ReliabilityWarning& doubt :
       FindMissingMatches(*scene, *poses, overlaps)) {
    poses->reliability_warnings.push_back(std::move(doubt));
  }
  LOWLAP_ASSIGN_OR_RETURN(auto found,
                          FindLookAlikes(*scene, *poses, overlaps, context));
  auto look_alikes = std::make_shared<LookAlikes>(std::move(found));
  if (!look_alikes->doubtful.empty()) {
    ReliabilityWarning doubt;
    doubt.reason = WarningReason::kLookAlikes;
    doubt.views = look_alikes->doubtful;
    doubt.missing = look_alikes->different;
    poses->reliability_warnings.push_back(std::move(doubt));
  }
  poses->look_alikes = std::move(look_alikes);
  WarnOfHangingViews(poses);
  // Last: what hangs on a view that is known to a little less states so itself.
  for (ReliabilityWarning& doubt : FindImpreciseViews(*scene, *poses)) {
    poses->reliability_warnings.push_back(std::move(doubt));
  }
  return {};
}

}  // namespace lowlap
