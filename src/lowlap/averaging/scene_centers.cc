#include "lowlap/averaging/internal/scene_centers.h"

#include <algorithm>
#include <utility>

#include "lowlap/averaging/internal/contradicted_ratio.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/strategies/internal/graph_scales.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// Edges whose direction is beyond `reach` deviations from the centres of
// component 0. `sigma_rad` is found first if it is 0, and then stays: what is
// right must not be eroded round by round.
std::vector<OutlierEdge> DirectionOutliers(const TranslationProblem& problem,
                                           const TranslationSolution& solution,
                                           const PoseOptions& options,
                                           double* sigma_rad) {
  struct Residual {
    const DirectionEdge* edge;
    double angle_rad;
  };
  std::vector<Residual> residuals;
  std::vector<double> angles;
  for (const DirectionEdge& edge : problem.edges) {
    if (solution.component[edge.first] != 0 ||
        solution.component[edge.second] != 0) {
      continue;
    }
    const Vec3 baseline = solution.center_in_world[edge.second] -
                          solution.center_in_world[edge.first];
    if (!(baseline.norm() > 0)) continue;
    residuals.push_back(
        {&edge, AngleBetween(baseline, edge.direction_in_world)});
    angles.push_back(residuals.back().angle_rad);
  }
  if (*sigma_rad == 0) *sigma_rad = ResidualStddev<2>(std::move(angles));
  const ErrorLimits limits = LimitsOf(options);
  std::vector<OutlierEdge> outliers;
  for (const Residual& residual : residuals) {
    const DirectionEdge& edge = *residual.edge;
    if (residual.angle_rad > limits.DirectionRad(*sigma_rad, edge.stddev_rad)) {
      outliers.push_back(
          {ViewPair{problem.views[edge.first], problem.views[edge.second]},
           OutlierReason::kDirection, DegFromRad(residual.angle_rad)});
    }
  }
  return outliers;
}

// Ratios that are not meaningful, but the only ones on which candidates agree,
// enough of them to bear each other out or any two, for a view that has not
// been placed.
std::set<ViewTriplet> WeakRatios(const Scene& scene,
                                 const TranslationProblem& problem,
                                 const TranslationSolution& solution,
                                 bool with_agreement) {
  std::set<ViewId> unplaced;
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution.component[n] != 0) unplaced.insert(problem.views[n]);
  }
  std::set<ViewTriplet> weak;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    const ViewTriplet& views = ratio.views;
    if (ratio.verdict == RatioVerdict::kNotMeaningful &&
        (ratio.HasAgreement() ||
         (!with_agreement && ratio.NumInliers() >= 2)) &&
        unplaced.count(views.first) + unplaced.count(views.middle) +
                unplaced.count(views.last) >
            0) {
      weak.insert(views);
    }
  }
  return weak;
}

class CenterSearch {
 public:
  CenterSearch(const Scene& scene, const SceneRotations& rotations,
               const PoseOptions& options, const RunContext& context)
      : scene_(scene),
        rotations_(rotations),
        options_(options),
        context_(context),
        averager_(options.averager ? *options.averager : graph_) {}

  Result<SceneCenters> Run() && {
    now_.outlier_edges = rotations_.outliers;
    LOWLAP_ASSIGN_OR_RETURN(Solved first,
                            Solve(now_.outlier_edges, now_.weak_ratios));
    Take(std::move(first));
    LOWLAP_RETURN_IF_ERROR(AddWeakRatios());
    LOWLAP_RETURN_IF_ERROR(LeaveOutContradictions());
    std::sort(now_.outlier_edges.begin(), now_.outlier_edges.end(),
              [](const OutlierEdge& a, const OutlierEdge& b) {
                return a.views < b.views;
              });
    return std::move(now_);
  }

 private:
  struct Solved {
    TranslationProblem problem;
    TranslationSolution solution;
  };

  Result<Solved> Solve(const std::vector<OutlierEdge>& outliers,
                       const std::set<ViewTriplet>& weak) const {
    Solved solved;
    solved.problem = MakeTranslationProblem(scene_, rotations_.cam_from_world,
                                            PairsOf(outliers), weak,
                                            averager_.NeedsTracks());
    LOWLAP_ASSIGN_OR_RETURN(solved.solution,
                            averager_.Solve(solved.problem, context_));
    return solved;
  }

  void Take(Solved solved) {
    now_.problem = std::move(solved.problem);
    now_.solution = std::move(solved.solution);
  }

  Status AddWeakRatios() {
    for (const bool with_agreement : {true, false}) {
      std::set<ViewTriplet> more =
          WeakRatios(scene_, now_.problem, now_.solution, with_agreement);
      more.insert(now_.weak_ratios.begin(), now_.weak_ratios.end());
      if (more.size() == now_.weak_ratios.size()) continue;
      LOWLAP_ASSIGN_OR_RETURN(Solved wider, Solve(now_.outlier_edges, more));
      if (wider.solution.NumPlaced() > now_.solution.NumPlaced()) {
        Take(std::move(wider));
        now_.weak_ratios = std::move(more);
      }
    }
    return {};
  }

  std::vector<OutlierEdge> OutliersOf(const TranslationSolution& solution) {
    return DirectionOutliers(now_.problem, solution, options_, &now_.sigma_rad);
  }

  Status LeaveOutContradictions() {
    while (true) {
      const std::vector<OutlierEdge> wrong = OutliersOf(now_.solution);
      if (wrong.empty()) return {};
      std::vector<OutlierEdge> more = now_.outlier_edges;
      more.insert(more.end(), wrong.begin(), wrong.end());
      LOWLAP_ASSIGN_OR_RETURN(Solved smaller, Solve(more, now_.weak_ratios));
      if (smaller.solution.NumPlaced() < now_.solution.NumPlaced()) {
        return KeepOrExplain(wrong);
      }
      now_.outlier_edges = std::move(more);
      Take(std::move(smaller));
    }
  }

  // Without these edges views would be lost: a false ratio explains them, or
  // they stay.
  Status KeepOrExplain(const std::vector<OutlierEdge>& wrong) {
    LOWLAP_ASSIGN_OR_RETURN(auto without,
                            SolveWithoutContradictedRatio(
                                now_.problem, averager_, now_.solution,
                                [&](const TranslationSolution& other) {
                                  return OutliersOf(other).empty();
                                },
                                context_));
    if (without) {
      now_.left_out_ratios = {without->ratio};
      now_.solution = std::move(without->solution);
    } else {
      now_.kept_outliers = wrong;
    }
    return {};
  }

  const Scene& scene_;
  const SceneRotations& rotations_;
  const PoseOptions& options_;
  const RunContext& context_;
  const GraphScalesAverager graph_;
  const TranslationAverager& averager_;
  SceneCenters now_;
};

}  // namespace

Result<SceneCenters> SolveSceneCenters(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const PoseOptions& options,
                                       const RunContext& context) {
  return CenterSearch(scene, rotations, options, context).Run();
}

}  // namespace lowlap
