#include "lowlap/averaging/centers/internal/scene_contests.h"

#include <algorithm>
#include <set>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/internal/problem_errors.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

bool IsContested(const std::vector<ContestedLink>& contested,
                 const Contest& contest) {
  return std::any_of(contested.begin(), contested.end(),
                     [&](const ContestedLink& link) {
                       return contest.links == std::vector<ViewPair>{link.edge};
                     });
}

bool IsMet(const Scene& scene, const ViewPair& views) {
  const Pose* const first = scene.FindPose(views.first);
  const Pose* const second = scene.FindPose(views.second);
  if (first == nullptr || second == nullptr) return false;
  const RelativePose& pose = scene.relative_poses.at(views);
  const RigidTransform cam2_from_cam1 =
      second->CamFromWorld() * first->CamFromWorld().Inverse();
  return RotationAngleBetween(pose.rotation, cam2_from_cam1.rotation) <=
             RadFromDeg(kLittleDeg) &&
         AngleBetween(pose.direction, cam2_from_cam1.translation) <=
             RadFromDeg(kLittleOfDirectionsDeg);
}

}  // namespace

std::vector<Contest> FindSceneContests(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const SceneCenters& centers) {
  const std::set<ViewId> placed = centers.PlacedViews();
  const auto is_placed = [&](const ViewPair& views) {
    return placed.count(views.first) > 0 && placed.count(views.second) > 0;
  };
  const auto evidence_of = [&](const ViewPair& views) {
    const auto counting = rotations.third_views.evidence.find(views);
    return counting != rotations.third_views.evidence.end()
               ? counting->second
               : EvidenceOfNfa(scene.relative_poses.at(views).log10_nfa);
  };
  EvidenceOfPairs in_use;
  for (const DirectionEdge& edge : centers.problem.edges) {
    const ViewPair views = ViewsOf(centers.problem, edge);
    if (!is_placed(views)) continue;
    in_use[views] = evidence_of(views);
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
      rejected[edge.views] = {evidence_of(edge.views), turn,
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

std::vector<Contest> ContestsThatStay(const Scene& scene,
                                      const std::vector<Contest>& contests) {
  std::vector<Contest> staying;
  for (const Contest& contest : contests) {
    double against = 0;
    for (std::size_t n = 0; n < contest.contradictions.size(); ++n) {
      if (!IsMet(scene, contest.contradictions[n])) {
        against += contest.evidence_against[n];
      }
    }
    if (2 * against > contest.evidence) staying.push_back(contest);
  }
  return staying;
}

}  // namespace lowlap
