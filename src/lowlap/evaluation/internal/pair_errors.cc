#include "lowlap/evaluation/internal/pair_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/evaluation/internal/relative_errors.h"

namespace lowlap {
namespace {

std::set<ViewPair> ConsecutivePairs(const Scene& scene,
                                    const GroundTruth& truth) {
  std::vector<ViewId> views;
  for (const auto& entry : truth) {
    if (scene.views.count(entry.first)) views.push_back(entry.first);
  }
  std::set<ViewPair> pairs;
  for (std::size_t n = 0; n + 1 < views.size(); ++n) {
    pairs.insert({views[n], views[n + 1]});
  }
  if (views.size() > 2) pairs.insert({views.front(), views.back()});
  return pairs;
}

PairGroupErrors Group(const std::vector<PairError>& pairs,
                      bool consecutive_only) {
  PairGroupErrors group;
  std::vector<double> rotations, directions;
  for (const PairError& pair : pairs) {
    if (consecutive_only && !pair.consecutive) continue;
    ++group.num_pairs;
    group.num_without_pose += pair.has_pose ? 0 : 1;
    group.num_failed += pair.failed ? 1 : 0;
    if (pair.rotation_error_deg) rotations.push_back(*pair.rotation_error_deg);
    if (pair.direction_error_deg) {
      directions.push_back(*pair.direction_error_deg);
    }
  }
  group.rotation_deg = QuantilesOf(std::move(rotations));
  group.direction_deg = QuantilesOf(std::move(directions));
  return group;
}

}  // namespace

Status PairEvaluationOptions::Validate() const {
  if (!(max_rotation_deg > 0) || !(max_direction_deg > 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "evaluation of pairs: the limits must be positive");
  }
  for (const ViewPair& views : expected) {
    if (!(views.first < views.second)) {
      return MakeError(
          ErrorCode::kInvalidArgument,
          "evaluation of pairs: " + std::to_string(views.first.value()) + "-" +
              std::to_string(views.second.value()) +
              " is not a pair, the smaller view first");
    }
  }
  return {};
}

ErrorQuantiles QuantilesOf(std::vector<double> values) {
  ErrorQuantiles quantiles;
  if (values.empty()) return quantiles;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  quantiles.count = static_cast<int>(values.size());
  quantiles.median = at(0.5);
  quantiles.p90 = at(0.9);
  quantiles.worst = values.back();
  return quantiles;
}

Result<PairEvaluation> EvaluatePairs(const Scene& scene,
                                     const GroundTruth& truth,
                                     const PairEvaluationOptions& options) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::map<ViewPair, PairError> by_views;
  const std::set<ViewPair> consecutive = ConsecutivePairs(scene, truth);
  for (const ViewPair& views : consecutive) by_views[views].consecutive = true;
  for (const ViewPair& views : options.expected) {
    for (const ViewId view : {views.first, views.second}) {
      if (truth.count(view) == 0) {
        return MakeError(ErrorCode::kInvalidArgument,
                         "evaluation of pairs: view " +
                             std::to_string(view.value()) +
                             " of an expected pair has no true pose");
      }
    }
    by_views[views];
  }
  const RelativePoseEvaluation errors = EvaluateRelativePoses(scene, truth);
  for (const RelativePoseError& error : errors.pairs) {
    const RelativePose& pose = scene.relative_poses.at(error.views);
    PairError& pair = by_views[error.views];
    pair.has_pose = true;
    pair.rotation_error_deg = error.rotation_error_deg;
    pair.direction_error_deg = error.direction_error_deg;
    pair.num_point_inliers = static_cast<int>(pose.point_inliers.size());
    pair.num_line_inliers = static_cast<int>(pose.line_inliers.size());
    pair.log10_nfa = pose.log10_nfa;
  }

  PairEvaluation result;
  result.num_without_truth = errors.num_without_truth;
  for (auto& [views, pair] : by_views) {
    pair.views = views;
    pair.failed =
        !pair.has_pose ||
        pair.rotation_error_deg.value_or(0) > options.max_rotation_deg ||
        pair.direction_error_deg.value_or(0) > options.max_direction_deg;
    result.pairs.push_back(pair);
  }
  result.consecutive = Group(result.pairs, true);
  result.all = Group(result.pairs, false);
  return result;
}

}  // namespace lowlap
