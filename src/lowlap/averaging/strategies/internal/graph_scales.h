#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct GraphScalesOptions {
  int max_scale_iterations = 30;
  int max_refinement_iterations = 50;  // 0: no refinement

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("max_scale_iterations", &max_scale_iterations,
          "at most so many to average the ratios");
    visit("max_refinement_iterations", &max_refinement_iterations,
          "at most so many for the joint refinement; 0: none");
  }
};

/// lowlap's strategy for any view graph: log edge lengths averaged over all
/// ratios (AverageEdgeScales), centres from directions of known length
/// (SolveCenters), groups of edges that share no ratio joined where directions
/// alone fix their scale (two shared views, or a ring of groups:
/// CloseComponents), then the joint refinement (RefineCenters). On a chain it
/// equals ScaleChainAverager; on a loop the closing error is spread.
class GraphScalesAverager : public TranslationAverager {
 public:
  explicit GraphScalesAverager(GraphScalesOptions options = {})
      : options_(options) {}
  std::string Name() const override { return "graph"; }
  std::string Needs() const override {
    return "a scale ratio, or directions that fix a scale, across every camera "
           "on the way to the others";
  }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;

 private:
  GraphScalesOptions options_;
};

}  // namespace lowlap
