#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// lowlap's strategy for any view graph: log edge lengths averaged over all
/// ratios (AverageEdgeScales), centres from directions of known length
/// (SolveCenters), groups of edges that share no ratio joined where directions
/// alone fix their scale (two shared views, or a ring of groups: CloseBodies),
/// then the joint refinement (RefineCenters). On a chain it equals
/// ScaleChainAverager; on a loop the closing error is spread.
class GraphScalesAverager : public TranslationAverager {
 public:
  std::string Name() const override { return "graph"; }
  std::string Needs() const override {
    return "a scale ratio, or directions that fix a scale, across every camera "
           "on the way to the others";
  }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;
};

}  // namespace lowlap
