#include "lowlap/averaging/strategies/internal/graph_scales.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/scales/internal/center_solver.h"
#include "lowlap/averaging/scales/internal/edge_groups.h"
#include "lowlap/averaging/scales/internal/edge_scales.h"
#include "lowlap/averaging/scales/internal/refine_centers.h"
#include "lowlap/averaging/strategies/internal/component_closure.h"
#include "lowlap/averaging/strategies/internal/placed_parts.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

// The centres of a group's views, in their order, in the group's own gauge.
Result<std::vector<Vec3>> SolveScaleGroup(const TranslationProblem& problem,
                                          const EdgeScales& scales,
                                          const EdgeGroup& group,
                                          const RunContext& context) {
  constexpr double kAlongLog = 0.02;
  const auto index_of = [&](std::size_t view) {
    return static_cast<std::size_t>(
        std::lower_bound(group.views.begin(), group.views.end(), view) -
        group.views.begin());
  };
  std::vector<CenterEdge> edges;
  edges.reserve(group.edges.size());
  for (const std::size_t e : group.edges) {
    const DirectionEdge& edge = problem.edges[e];
    edges.push_back({index_of(edge.first), index_of(edge.second),
                     edge.direction_in_world, std::exp(scales.log_length[e]),
                     edge.stddev_rad, kAlongLog});
  }
  return SolveCenters(group.views.size(), edges, context);
}

/// One component under construction.
class Growth {
 public:
  Growth(const TranslationProblem& problem, const EdgeScales& scales,
         const std::vector<EdgeGroup>& groups, const RunContext& context)
      : problem_(problem),
        context_(context),
        scales_(scales),
        groups_(groups),
        placed_(problem.views.size(), false),
        centers_(problem.views.size(), Vec3::Zero()),
        used_(groups.size(), false),
        edges_of_view_(problem.views.size()) {
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
      edges_of_view_[problem.edges[e].first].push_back(e);
      edges_of_view_[problem.edges[e].second].push_back(e);
    }
  }

  Status Start(std::size_t g) {
    const auto local = SolveScaleGroup(problem_, scales_, groups_[g], context_);
    if (!local) return tl::unexpected<Error>(local.error());
    used_[g] = true;
    for (std::size_t n = 0; n < local->size(); ++n) {
      Place(groups_[g].views[n], (*local)[n]);
    }
    return {};
  }

  /// Adds groups and views until directions alone fix no further scale.
  Status Grow() {
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (used_[g]) continue;
        LOWLAP_ASSIGN_OR_RETURN(const auto joined, JoinGroup(g));
        grown = grown || joined;
      }
      if (!grown) {
        LOWLAP_ASSIGN_OR_RETURN(grown, IntersectOneView());
      }
      if (!grown) {
        LOWLAP_ASSIGN_OR_RETURN(grown, CloseGroups());
      }
    }
    return {};
  }

  Status Refine(int max_iterations) {
    return RefineCenters(problem_, placed_, &centers_, context_,
                         max_iterations);
  }

  void AddTo(PlacedParts* parts) const {
    std::vector<std::size_t> views;
    std::vector<Vec3> centers;
    for (std::size_t view = 0; view < placed_.size(); ++view) {
      if (!placed_[view]) continue;
      views.push_back(view);
      centers.push_back(centers_[view]);
    }
    parts->Add(std::move(views), std::move(centers));
  }

 private:
  void Place(std::size_t view, const Vec3& center) {
    placed_[view] = true;
    centers_[view] = center;
  }

  // A group that shares two or more views gets its scale from their distances.
  Result<bool> JoinGroup(std::size_t g) {
    const std::vector<std::size_t>& views = groups_[g].views;
    std::vector<std::size_t> shared;  // indices into `views`
    bool adds_views = false;
    for (std::size_t n = 0; n < views.size(); ++n) {
      if (placed_[views[n]]) {
        shared.push_back(n);
      } else {
        adds_views = true;
      }
    }
    if (!adds_views || shared.size() < 2) return false;
    used_[g] = true;
    const auto local = SolveScaleGroup(problem_, scales_, groups_[g], context_);
    if (!local) return tl::unexpected<Error>(local.error());
    Vec3 local_mean = Vec3::Zero(), mean = Vec3::Zero();
    for (const std::size_t n : shared) {
      local_mean += (*local)[n] / static_cast<double>(shared.size());
      mean += centers_[views[n]] / static_cast<double>(shared.size());
    }
    double dot = 0, square = 0;
    for (const std::size_t n : shared) {
      const Vec3 offset = (*local)[n] - local_mean;
      dot += offset.dot(centers_[views[n]] - mean);
      square += offset.squaredNorm();
    }
    if (!(square > 0) || !(dot > 0)) return false;
    const double scale = dot / square;
    for (std::size_t n = 0; n < views.size(); ++n) {
      if (!placed_[views[n]]) {
        Place(views[n], mean + scale * ((*local)[n] - local_mean));
      }
    }
    return true;
  }

  // Groups that fix one another's scale around a ring.
  Result<bool> CloseGroups() {
    // The closure is dense; the largest groups come first.
    constexpr std::size_t kMaxGroups = 150;
    RigidComponent frame;
    frame.stddev_rad = 0;
    for (std::size_t view = 0; view < placed_.size(); ++view) {
      if (!placed_[view]) continue;
      frame.views.push_back(view);
      frame.centers.push_back(centers_[view]);
    }
    std::vector<RigidComponent> components = {frame};
    std::vector<std::size_t> group_of = {0};
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (used_[g] || components.size() > kMaxGroups) continue;
      LOWLAP_ASSIGN_OR_RETURN(
          const auto local,
          SolveScaleGroup(problem_, scales_, groups_[g], context_));
      RigidComponent component;
      component.stddev_rad = 0;
      for (const std::size_t e : groups_[g].edges) {
        component.stddev_rad =
            std::max(component.stddev_rad, problem_.edges[e].stddev_rad);
      }
      component.views = groups_[g].views;
      component.centers = local;
      components.push_back(std::move(component));
      group_of.push_back(g);
    }
    const auto placements = CloseComponents(components);
    bool grown = false;
    for (std::size_t b = 1; b < components.size(); ++b) {
      if (!placements[b]) continue;
      used_[group_of[b]] = true;
      for (std::size_t n = 0; n < components[b].views.size(); ++n) {
        const std::size_t view = components[b].views[n];
        if (placed_[view]) continue;
        Place(view, placements[b]->scale * components[b].centers[n] +
                        placements[b]->translation);
        grown = true;
      }
    }
    return grown;
  }

  // The best-conditioned view that two or more directions from placed views
  // determine.
  Result<bool> IntersectOneView() {
    double best_strength = 0;
    std::size_t best_view = 0;
    Vec3 best_center = Vec3::Zero();
    for (std::size_t view = 0; view < placed_.size(); ++view) {
      if (placed_[view]) continue;
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context_, view, placed_.size()));
      Mat3 normal = Mat3::Zero();
      Vec3 rhs = Vec3::Zero();
      double stddev = 0;
      int count = 0;
      for (const std::size_t e : edges_of_view_[view]) {
        const DirectionEdge& edge = problem_.edges[e];
        const std::size_t other = OtherEnd(edge, view);
        if (!placed_[other]) continue;
        const Mat3 across =
            Mat3::Identity() -
            edge.direction_in_world * edge.direction_in_world.transpose();
        normal += across;
        rhs += across * centers_[other];
        stddev = std::max(stddev, edge.stddev_rad);
        ++count;
      }
      if (count < 2) continue;
      const double weakest =
          Eigen::SelfAdjointEigenSolver<Mat3>(normal).eigenvalues()(0);
      // Two directions at angle a have the least eigenvalue a^2 / 2.
      const double strength =
          weakest / (0.5 * kSeparation * kSeparation * stddev * stddev);
      if (strength <= std::max(1.0, best_strength)) continue;
      const Vec3 center = normal.inverse() * rhs;
      if (!AllForward(view, center)) continue;
      best_strength = strength;
      best_view = view;
      best_center = center;
    }
    if (best_strength == 0) return false;
    Place(best_view, best_center);
    return true;
  }

  static std::size_t OtherEnd(const DirectionEdge& edge, std::size_t view) {
    return edge.first == view ? edge.second : edge.first;
  }

  bool AllForward(std::size_t view, const Vec3& center) const {
    for (const std::size_t e : edges_of_view_[view]) {
      const DirectionEdge& edge = problem_.edges[e];
      const std::size_t other = OtherEnd(edge, view);
      if (!placed_[other]) continue;
      const double sign = edge.second == view ? 1 : -1;
      if (sign * edge.direction_in_world.dot(center - centers_[other]) <= 0) {
        return false;
      }
    }
    return true;
  }

  const TranslationProblem& problem_;
  const RunContext& context_;
  const EdgeScales& scales_;
  const std::vector<EdgeGroup>& groups_;
  std::vector<bool> placed_;
  std::vector<Vec3> centers_;
  std::vector<bool> used_;
  std::vector<std::vector<std::size_t>> edges_of_view_;
};

}  // namespace

Status GraphScalesOptions::Validate() const {
  if (max_scale_iterations > 0 && max_refinement_iterations >= 0) return {};
  return MakeError(ErrorCode::kInvalidArgument,
                   "the number of iterations for the scales must be positive, "
                   "that of the refinement not negative");
}

Result<TranslationSolution> GraphScalesAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  LOWLAP_RETURN_IF_ERROR(ValidateProblem(problem));
  LOWLAP_RETURN_IF_ERROR(options_.Validate());
  LOWLAP_ASSIGN_OR_RETURN(
      const auto scales,
      AverageEdgeScales(problem, context, options_.max_scale_iterations));
  const std::vector<EdgeGroup> groups = RankedEdgeGroups(problem, scales);

  // A small group may grow larger than one before it.
  PlacedParts parts(problem.views.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (parts.HasAll(groups[g].views)) continue;
    Growth growth(problem, scales, groups, context);
    LOWLAP_RETURN_IF_ERROR(growth.Start(g));
    LOWLAP_RETURN_IF_ERROR(growth.Grow());
    LOWLAP_RETURN_IF_ERROR(growth.Refine(options_.max_refinement_iterations));
    growth.AddTo(&parts);
  }
  TranslationSolution solution = std::move(parts).MakeSolution();
  solution.num_iterations = scales.num_iterations;
  return solution;
}

}  // namespace lowlap
