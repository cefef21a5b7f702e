#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct OneDSfmOptions {
  int num_projections = 48;
  /// An edge whose mean contradicted weight is above this is left out.
  double max_contradiction = 0.1;

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("num_projections", &num_projections, "axes that views are put on");
    visit("max_contradiction", &max_contradiction,
          "relative poses that are contradicted more are left out");
  }
};

/// Per edge: how strongly orderings of the views contradict it (Wilson,
/// Snavely, "Robust global translations with 1DSfM", ECCV 2014).
///
/// On an axis p, an edge says that `second` lies after `first` if d.p > 0, else
/// before it, with the weight |d.p|. If all edges are right, one order of the
/// views fulfils all of them. OrderVertices finds an order that breaks little;
/// an edge's contradiction is
///   z = mean over the axes of |d.p| [the order breaks the edge]   in [0, 1].
/// The axes are drawn where edges point: a random edge's direction, blurred by
/// 0.5 E^(-1/6) radians (the paper: a kernel density of the directions). Draws
/// depend on context.seed alone, the result on nothing else.
///
/// An edge on no cycle is never contradicted.
Result<std::vector<double>> EdgeContradictions(
    const TranslationProblem& problem, const OneDSfmOptions& options,
    const RunContext& context);

/// The problem without the edges in question, and without their ratios.
TranslationProblem WithoutEdges(const TranslationProblem& problem,
                                const std::vector<bool>& is_excluded);

/// Any strategy on the edges that 1DSfM keeps; called `1dsfm+<its name>`. The
/// views are not changed: one that keeps no edge is for the strategy to report.
class OneDSfmAverager : public TranslationAverager {
 public:
  explicit OneDSfmAverager(std::shared_ptr<const TranslationAverager> inner,
                           OneDSfmOptions options = {})
      : inner_(std::move(inner)), options_(options) {}
  std::string Name() const override { return "1dsfm+" + inner_->Name(); }
  bool NeedsTracks() const override { return inner_->NeedsTracks(); }
  std::string Needs() const override {
    return inner_->Needs() + ", of relative poses that 1DSfM keeps";
  }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;

 private:
  std::shared_ptr<const TranslationAverager> inner_;
  OneDSfmOptions options_;
};

}  // namespace lowlap
