#include "lowlap/averaging/reliability/internal/agreeing_poses.h"

namespace lowlap {

ViewGraph AgreeingPoses(const Scene& scene, const PoseSummary& summary) {
  return ViewGraph(scene)
      .WithoutPairs(PairsOf(summary.outlier_edges))
      .WithoutPairs(PairsOf(summary.kept_outliers))
      .WithoutViews(summary.unplaced);
}

}  // namespace lowlap
