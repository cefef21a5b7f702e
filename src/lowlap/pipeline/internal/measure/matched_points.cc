#include "lowlap/pipeline/internal/measure/matched_points.h"

#include <string>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/pipeline/internal/measure/relative_poses.h"

namespace lowlap {
namespace {

// Segments of the photographs that there are, also in scene->features.
Result<std::map<ViewId, DetectedFeatures>> DetectSegments(
    PhotographUse use, const RunContext& context, Scene* scene) {
  FeatureOptions options;
  options.detect_points = false;
  std::map<ViewId, Error> failed;
  auto detected = DetectFeatures(*scene, options, context, &failed);
  if (!detected) return detected;
  if (detected->empty() && !failed.empty()) {
    if (use == PhotographUse::kLines) {
      return tl::unexpected<Error>(failed.begin()->second);
    }
    context.Log(LogLevel::kInfo, "no photographs, points alone: " +
                                     failed.begin()->second.ToString());
    return detected;
  }
  for (const auto& [view, error] : failed) {
    context.Log(LogLevel::kWarning,
                "no lines, points alone: " + error.ToString());
  }
  for (const auto& [view, features] : *detected) {
    scene->features[view].segments = features.features.segments;
  }
  return detected;
}

Status MatchSegments(const std::map<ViewId, DetectedFeatures>& detected,
                     const RunContext& context,
                     std::map<ViewPair, PairMatches>* matches) {
  std::vector<ViewPair> pairs;
  for (const auto& [pair, of_pair] : *matches) {
    if (detected.count(pair.first) > 0 && detected.count(pair.second) > 0) {
      pairs.push_back(pair);
    }
  }
  MatchOptions options;
  options.match_points = false;
  LOWLAP_ASSIGN_OR_RETURN(auto lines,
                          MatchFeatures(detected, pairs, options, context));
  for (auto& [pair, of_pair] : lines) {
    matches->at(pair).lines = std::move(of_pair.lines);
  }
  return {};
}

}  // namespace

Result<std::vector<PairReport>> RelateMatchedPoints(
    const MatchedPoints& points, PhotographUse use,
    const RelativePoseOptions& options, const FirstSolution& first,
    const RunContext& context, StageLog* stages, Scene* scene) {
  std::map<ViewPair, PairMatches> matches;
  for (const auto& [pair, of_pair] : points.matches) {
    matches[pair].points = of_pair;
  }
  std::map<ViewId, DetectedFeatures> detected;
  if (use != PhotographUse::kNone) {
    {
      const StageLog::Scope scope(stages, "features");
      LOWLAP_ASSIGN_OR_RETURN(detected, DetectSegments(use, context, scene));
    }
    const StageLog::Scope scope(stages, "matching");
    LOWLAP_RETURN_IF_ERROR(MatchSegments(detected, context, &matches));
  }
  RelativePoseOptions of_points = options;
  // The points have no descriptors here to be matched again by.
  of_points.pair.starved_below = 0;
  const auto relate = [&](Scene* related) {
    const StageLog::Scope scope(stages, "relative poses");
    return EstimateRelativePoses(related, matches, &detected, of_points,
                                 context, points.cam2_from_cam1);
  };
  return RelateAndRefine(relate, first, context, stages, scene);
}

}  // namespace lowlap
