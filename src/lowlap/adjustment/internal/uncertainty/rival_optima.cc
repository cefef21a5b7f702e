#include "lowlap/adjustment/internal/uncertainty/rival_optima.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/adjustment/internal/uncertainty/center_shift.h"

namespace lowlap {
namespace {

// Chi-square, three degrees of freedom.
constexpr double kRegion95 = 7.815;

bool IsOutside(const Vec3& step, const Mat3& covariance) {
  return step.dot(covariance.ldlt().solve(step)) > kRegion95;
}

std::string ViewsAt(const Scene& scene, PoseId pose) {
  std::string names;
  for (const auto& [id, view] : scene.views) {
    if (view.pose_id != pose) continue;
    names += (names.empty() ? "" : ", ") + scene.NameOf(id);
  }
  return names;
}

}  // namespace

std::vector<RivalOptimum> AddRivals(const AdjustmentOptions& options,
                                    const std::vector<Rival>& rivals,
                                    const CameraSet& cameras,
                                    const StructureState& state,
                                    CenterUncertainty* uncertainty) {
  std::vector<RivalOptimum> elsewhere;
  if (rivals.empty()) return elsewhere;
  const std::vector<Component> components =
      FindComponents(cameras, state, SelectForSolve(cameras, state, options));
  const std::map<PoseId, Mat3> stated = uncertainty->covariances;
  for (const Rival& rival : rivals) {
    const CenterShift shift(cameras, components, rival.cameras);
    RivalOptimum found{rival.start, {}};
    for (const auto& [pose, step] : shift.steps()) {
      const auto covariance = stated.find(pose);
      if (covariance != stated.end() && IsOutside(step, covariance->second)) {
        found.distances[pose] = step.norm();
      }
    }
    if (found.distances.empty()) continue;
    shift.AddTo(uncertainty);
    elsewhere.push_back(std::move(found));
  }
  return elsewhere;
}

std::vector<std::string> DescribeRivals(const Scene& scene,
                                        const AdjustmentSummary& summary) {
  std::vector<std::string> sentences;
  for (const RivalOptimum& rival : summary.rivals) {
    double farthest = 0;
    std::string names;
    for (const auto& [pose, distance] : rival.distances) {
      farthest = std::max(farthest, distance);
      names += (names.empty() ? "" : ", ") + ViewsAt(scene, pose);
    }
    char distance[32];
    std::snprintf(distance, sizeof distance, "%.3g", farthest);
    sentences.push_back("from another start (" + rival.start +
                        ") the adjustment ends elsewhere and explains the "
                        "measurements as well; by up to " +
                        distance + " world units these differ: " + names);
  }
  return sentences;
}

}  // namespace lowlap
