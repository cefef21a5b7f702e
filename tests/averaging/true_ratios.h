#pragma once

#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// A simulated scene with the true ratios of all its triplets, all of them
/// meaningful.
inline SyntheticScene SceneWithTrueRatios(const SyntheticOptions& options) {
  SyntheticScene synthetic = *Simulate(options);
  synthetic.scene.scale_ratios = TrueSolution(synthetic).scale_ratios;
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log10_nfa = -50;
    ratio.log_ratio_stddev = 0.01;
  }
  return synthetic;
}

}  // namespace lowlap
