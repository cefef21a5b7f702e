#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// The paper's composition: edge lengths multiplied up along the spanning
/// forest of the most meaningful ratios, centres laid end to end along a
/// spanning tree of those edges; nothing is averaged (Salaün, Marlet, Monasse
/// 2017, section 5). It has no options: two spanning forests, no threshold, no
/// loss, no iteration.
class ScaleChainAverager : public TranslationAverager {
 public:
  std::string Name() const override { return "chain"; }
  std::string Needs() const override {
    return "a scale ratio across every camera on the way to the others";
  }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;
};

}  // namespace lowlap
