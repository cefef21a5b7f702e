#include "lowlap/averaging/centers/internal/evidence_against.h"

#include <cstddef>
#include <map>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/centers/internal/length_balance.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/internal/problem_errors.h"

namespace lowlap {

double EvidenceAgainstPoses(const Scene& scene, const PoseOptions& options) {
  std::map<ViewId, Mat3> cam_from_world;
  TranslationSolution solution;
  for (const auto& entry : scene.views) {
    const Pose* pose = scene.FindPose(entry.first);
    if (pose == nullptr) continue;
    cam_from_world[entry.first] = pose->rotation;
    solution.component.push_back(0);
    solution.center_in_world.push_back(pose->center);
  }
  const TranslationProblem problem =
      MakeTranslationProblem(scene, cam_from_world, {});
  const ErrorLimits limits = LimitsOf(options);
  const auto evidence_of = [&](const DirectionEdge& edge) {
    return EvidenceOfNfa(
        scene.relative_poses.at(ViewsOf(problem, edge)).log10_nfa);
  };
  double sum = 0;
  for (const DirectionEdge& edge : problem.edges) {
    if (DirectionErrorRad(solution, edge) >
        limits.DirectionRad(0, edge.stddev_rad)) {
      sum += evidence_of(edge);
    }
  }
  for (const std::size_t n :
       ContradictedLengths(problem, solution, limits, 0)) {
    sum += evidence_of(problem.edges[n]);
  }
  return sum;
}

}  // namespace lowlap
