#include "lowlap/adjustment/internal/uncertainty/rival_optima.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/adjustment/internal/uncertainty/center_shift.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/robust/internal/chi_square.h"

namespace lowlap {
namespace {

bool IsOutside95(const Vec3& step, const Mat3& covariance) {
  return LogChiSquareTail(step.dot(covariance.ldlt().solve(step)), 3) <
         std::log(0.05);
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
      if (covariance != stated.end() && IsOutside95(step, covariance->second)) {
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
    std::vector<std::string> names;
    for (const auto& [id, view] : scene.views) {
      const auto found = rival.distances.find(view.pose_id);
      if (found == rival.distances.end()) continue;
      farthest = std::max(farthest, found->second);
      names.push_back(scene.NameOf(id));
    }
    sentences.push_back(
        "from another start (" + rival.start +
        ") the adjustment ends elsewhere and explains the measurements as "
        "well; by up to " +
        Format("%.3g", farthest) +
        " world units these differ: " + Joined(names, ", "));
  }
  return sentences;
}

}  // namespace lowlap
