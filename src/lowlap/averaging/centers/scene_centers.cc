#include "lowlap/averaging/centers/internal/scene_centers.h"

#include <algorithm>
#include <map>
#include <utility>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/centers/internal/contradicted_ratio.h"
#include "lowlap/averaging/centers/internal/length_balance.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/internal/problem_errors.h"
#include "lowlap/averaging/strategies/internal/graph_scales.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

// The angle between a direction and the centres.
struct DirectionResidual {
  ViewPair views;
  double angle_rad = 0;
  double stddev_rad = 0;  // stated
};

// Of the edges between views of component 0.
std::vector<DirectionResidual> DirectionResiduals(
    const TranslationProblem& problem, const TranslationSolution& solution) {
  std::vector<DirectionResidual> residuals;
  for (const DirectionEdge& edge : problem.edges) {
    if (!IsPlaced(solution, edge)) continue;
    if (!(BaselineOf(solution, edge).norm() > 0)) continue;
    residuals.push_back({ViewsOf(problem, edge),
                         DirectionErrorRad(solution, edge), edge.stddev_rad});
  }
  return residuals;
}

double TypicalAngle(const std::vector<DirectionResidual>& residuals) {
  std::vector<double> angles;
  angles.reserve(residuals.size());
  for (const DirectionResidual& residual : residuals) {
    angles.push_back(residual.angle_rad);
  }
  return ResidualStddev<2>(std::move(angles));
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
               const std::vector<ViewPair>& without, const PoseOptions& options,
               const RunContext& context)
      : scene_(scene),
        rotations_(rotations),
        without_(without.begin(), without.end()),
        options_(options),
        context_(context),
        averager_(options.averager ? *options.averager : graph_) {}

  Result<SceneCenters> Run() && {
    do {
      now_ = {};
      now_.outlier_edges = rotations_.outliers;
      for (const ViewPair& views : without_) {
        now_.outlier_edges.push_back({views, OutlierReason::kDirection, 0});
      }
      LOWLAP_ASSIGN_OR_RETURN(Solved first,
                              Solve(now_.outlier_edges, now_.weak_ratios));
      Take(std::move(first));
      LOWLAP_RETURN_IF_ERROR(AddWeakRatios());
      LOWLAP_RETURN_IF_ERROR(LeaveOutContradictions());
    } while (TakeInAgain());
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

  // The typical angle is that of the first solution: what is right must not be
  // eroded round by round.
  std::vector<OutlierEdge> OutliersOf(const TranslationSolution& solution) {
    const auto residuals = DirectionResiduals(now_.problem, solution);
    if (now_.sigma_rad == 0) {
      // Where false directions are the rule, they are no measure of the others.
      now_.sigma_rad =
          std::min(TypicalAngle(residuals),
                   RadFromDeg(kLittleOfDirectionsDeg) / options_.outlier_reach);
    }
    std::vector<OutlierEdge> outliers;
    for (const DirectionResidual& residual : residuals) {
      if (IsOutlier(residual)) {
        outliers.push_back({residual.views, OutlierReason::kDirection,
                            DegFromRad(residual.angle_rad)});
      }
    }
    return outliers;
  }

  bool IsOutlier(const DirectionResidual& residual) const {
    return residual.angle_rad >
           LimitsOf(options_).DirectionRad(now_.sigma_rad, residual.stddev_rad);
  }

  Status LeaveOutContradictions() {
    std::set<ViewPair> needed;
    while (true) {
      const std::vector<OutlierEdge> wrong = OutliersOf(now_.solution);
      std::vector<OutlierEdge> more = now_.outlier_edges;
      for (const OutlierEdge& edge : wrong) {
        if (needed.count(edge.views) == 0) more.push_back(edge);
      }
      if (more.size() == now_.outlier_edges.size()) {
        now_.kept_outliers = wrong;
        return {};
      }
      LOWLAP_ASSIGN_OR_RETURN(Solved smaller, Solve(more, now_.weak_ratios));
      if (smaller.solution.NumPlaced() >= now_.solution.NumPlaced()) {
        now_.outlier_edges = std::move(more);
        Take(std::move(smaller));
        continue;
      }
      if (needed.empty()) {
        LOWLAP_ASSIGN_OR_RETURN(const bool is_explained, ExplainByRatio());
        if (is_explained) return {};
      }
      AddNeeded(wrong, smaller.solution, &needed);
    }
  }

  // Whether a false ratio explains all that contradicts.
  Result<bool> ExplainByRatio() {
    LOWLAP_ASSIGN_OR_RETURN(auto without,
                            SolveWithoutContradictedRatio(
                                now_.problem, averager_, now_.solution,
                                [&](const TranslationSolution& other) {
                                  return OutliersOf(other).empty();
                                },
                                context_));
    if (!without) return false;
    now_.left_out_ratios = {without->ratio};
    now_.solution = std::move(without->solution);
    return true;
  }

  // Those of views that are lost without them; all, if none is of one.
  void AddNeeded(const std::vector<OutlierEdge>& wrong,
                 const TranslationSolution& smaller,
                 std::set<ViewPair>* needed) const {
    std::set<ViewId> lost;
    for (std::size_t n = 0; n < now_.problem.views.size(); ++n) {
      if (now_.solution.component[n] == 0 && smaller.component[n] != 0) {
        lost.insert(now_.problem.views[n]);
      }
    }
    const std::size_t num_needed = needed->size();
    for (const OutlierEdge& edge : wrong) {
      if (lost.count(edge.views.first) + lost.count(edge.views.second) > 0) {
        needed->insert(edge.views);
      }
    }
    if (needed->size() > num_needed) return;
    for (const OutlierEdge& edge : wrong) needed->insert(edge.views);
  }

  // Whether some of those that it was done without agree with the centres, and
  // their ratios as well; the others get their errors.
  bool TakeInAgain() {
    if (without_.empty()) return false;
    const std::size_t num_without = without_.size();
    const TranslationProblem with_all =
        MakeTranslationProblem(scene_, rotations_.cam_from_world,
                               PairsOf(rotations_.outliers), {}, false);
    const std::map<ViewPair, double> balance = RatioBalance(with_all);
    std::map<ViewPair, double> error_deg;
    for (const DirectionResidual& residual :
         DirectionResiduals(with_all, now_.solution)) {
      if (without_.count(residual.views) == 0) continue;
      const auto of_ratios = balance.find(residual.views);
      if (IsOutlier(residual) ||
          (of_ratios != balance.end() && of_ratios->second < 0)) {
        error_deg[residual.views] = DegFromRad(residual.angle_rad);
      } else {
        without_.erase(residual.views);
      }
    }
    for (OutlierEdge& edge : now_.outlier_edges) {
      const auto found = error_deg.find(edge.views);
      if (found != error_deg.end()) edge.error_deg = found->second;
    }
    return without_.size() < num_without;
  }

  // What the ratios to relative poses in use say of the length of each.
  std::map<ViewPair, double> RatioBalance(
      const TranslationProblem& with_all) const {
    std::set<ViewPair> in_use;
    for (const DirectionEdge& edge : now_.problem.edges) {
      if (IsPlaced(now_.solution, edge)) {
        in_use.insert(ViewsOf(now_.problem, edge));
      }
    }
    std::vector<char> is_believed;
    for (const DirectionEdge& edge : with_all.edges) {
      is_believed.push_back(in_use.count(ViewsOf(with_all, edge)) > 0);
    }
    const std::vector<double> of_edges =
        LengthBalance(with_all, now_.solution, LimitsOf(options_), is_believed);
    std::map<ViewPair, double> balance;
    for (std::size_t n = 0; n < of_edges.size(); ++n) {
      balance[ViewsOf(with_all, with_all.edges[n])] = of_edges[n];
    }
    return balance;
  }

  const Scene& scene_;
  const SceneRotations& rotations_;
  std::set<ViewPair> without_;
  const PoseOptions& options_;
  const RunContext& context_;
  const GraphScalesAverager graph_;
  const TranslationAverager& averager_;
  SceneCenters now_;
};

}  // namespace

std::set<ViewId> SceneCenters::PlacedViews() const {
  std::set<ViewId> placed;
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution.component[n] == 0) placed.insert(problem.views[n]);
  }
  return placed;
}

Result<SceneCenters> SolveSceneCenters(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const std::vector<ViewPair>& without,
                                       const PoseOptions& options,
                                       const RunContext& context) {
  return CenterSearch(scene, rotations, without, options, context).Run();
}

}  // namespace lowlap
