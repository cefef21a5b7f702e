#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// Views whose mutual positions the measured directions fix, up to one scale
/// and translation, and the directions between them.
struct DirectionPart {
  std::vector<std::size_t> views;    // indices into problem.views, ascending
  std::vector<DirectionEdge> edges;  // first and second are indices into views
};

/// The part of some of the edges, which are between views of a problem.
DirectionPart MakePart(const std::vector<DirectionEdge>& edges,
                       const std::vector<std::size_t>& members);

/// The parts of at least three views that directions alone determine
/// (parallel rigidity; Ozyesil & Singer 2015, section 2), most views first.
///
/// Unlike AnalyzeRigidity this looks at the measured directions, not at generic
/// ones: an intersection counts if its directions are ten standard deviations
/// from parallel, so that collinear centres determine nothing. Edges are joined
/// by triangles, by views that two directions from one part intersect, by parts
/// that share two views, and by rings of parts (CloseComponents; at most the
/// 100 largest parts that are in a ring at all). Ratios are ignored. Parts may
/// share single views. Whether an edge is an outlier is not asked here.
/// kCancelled.
Result<std::vector<DirectionPart>> FindDirectionParts(
    const TranslationProblem& problem, const RunContext& context = {});

/// Centres of the views of one part, in any gauge of positive scale; adds to
/// `num_iterations`.
using PartSolver = std::function<Result<std::vector<Vec3>>(
    const DirectionPart& part, const RunContext& context, int* num_iterations)>;

/// The common frame of strategies that use directions only: validates, solves
/// every part by itself, and gives each a component. A view of several parts
/// goes to the largest; a view of none, and one that its part would leave alone
/// in a component, gets component -1.
Result<TranslationSolution> SolveDirectionParts(
    const TranslationProblem& problem, const RunContext& context,
    const PartSolver& solve);

/// The strategy of a name that solves every part by itself (ratios and
/// deviations are ignored; only parallel-rigid parts of three or more views are
/// placed, each in a component of its own).
class DirectionAverager : public TranslationAverager {
 public:
  DirectionAverager(std::string name, PartSolver solve)
      : name_(std::move(name)), solve_(std::move(solve)) {}
  std::string Name() const override { return name_; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override {
    return SolveDirectionParts(problem, context, solve_);
  }

 private:
  std::string name_;
  PartSolver solve_;
};

}  // namespace lowlap
