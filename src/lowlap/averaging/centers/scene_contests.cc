#include "lowlap/averaging/centers/internal/scene_contests.h"

#include <algorithm>
#include <set>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/internal/problem_errors.h"

namespace lowlap {
namespace {

bool IsContested(const std::vector<ContestedLink>& contested,
                 const Contest& contest) {
  return std::any_of(contested.begin(), contested.end(),
                     [&](const ContestedLink& link) {
                       return contest.links == std::vector<ViewPair>{link.edge};
                     });
}

}  // namespace

std::vector<Contest> FindSceneContests(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const SceneCenters& centers) {
  const std::set<ViewId> placed = centers.PlacedViews();
  const auto is_placed = [&](const ViewPair& views) {
    return placed.count(views.first) > 0 && placed.count(views.second) > 0;
  };
  EvidenceOfPairs in_use;
  for (const DirectionEdge& edge : centers.problem.edges) {
    const ViewPair views = ViewsOf(centers.problem, edge);
    if (!is_placed(views)) continue;
    in_use[views] = EvidenceOfNfa(scene.relative_poses.at(views).log10_nfa);
  }
  for (const OutlierEdge& edge : centers.kept_outliers) {
    in_use.erase(edge.views);
  }
  const std::vector<ViewPair>& untold = rotations.matches.untold;
  RejectedPoses rejected;
  for (const auto* edges : {&centers.kept_outliers, &centers.outlier_edges}) {
    for (const OutlierEdge& edge : *edges) {
      if (!is_placed(edge.views) || !edge.IsFalse() ||
          std::find(untold.begin(), untold.end(), edge.views) != untold.end()) {
        continue;
      }
      const RelativePose& pose = scene.relative_poses.at(edge.views);
      const Mat3 turn =
          rotations.cam_from_world.at(edge.views.second).transpose() *
          pose.rotation * rotations.cam_from_world.at(edge.views.first);
      rejected[edge.views] = {EvidenceOfNfa(pose.log10_nfa), turn,
                              RotationStddev(pose)};
    }
  }
  EvidenceOfRatios ratios;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    if (ratio.verdict == RatioVerdict::kMeaningful) {
      ratios[ratio.views] = EvidenceOfNfa(ratio.log10_nfa);
    }
  }
  std::vector<Contest> contests = FindContests(in_use, ratios, rejected);
  contests.erase(std::remove_if(contests.begin(), contests.end(),
                                [&](const Contest& contest) {
                                  return IsContested(rotations.contested,
                                                     contest);
                                }),
                 contests.end());
  return contests;
}

}  // namespace lowlap
