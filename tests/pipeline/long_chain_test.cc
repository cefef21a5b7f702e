#include <gtest/gtest.h>

#include <set>

#include "lowlap/averaging/averager_registry.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

constexpr int kNumViews = 100;

// A walk along a corridor: every view is matched with the next one only, and
// no feature is seen in three.
SyntheticScene Corridor() {
  SyntheticOptions options;
  options.kind = SyntheticKind::kCorridor;
  options.num_views = kNumViews;
  options.pairs = "chain";
  options.trifocal_point_share = 0;
  options.trifocal_line_share = 0;
  options.points_per_wall = 100;
  options.lines_per_wall = 300;
  options.noise_px = 0.3;
  options.rotation_noise_deg = 0.02;
  options.direction_noise_deg = 0.05;
  return *Simulate(options);
}

Result<SolveResult> SolveByCoplanarPairs(const std::string& strategy,
                                         Scene* scene) {
  SolveOptions options;
  ScaleOptions coplanar;
  coplanar.features = {"coplanar"};
  options.scale_estimator = MakeScaleEstimator(coplanar);
  options.poses.averager = *AveragerRegistry::WithBuiltIns().Make(strategy);
  options.adjust = false;
  StageLog stages;
  return SolveScene(scene, options, RunContext(), &stages);
}

TEST(LongChain, CoplanarPairsAlonePlaceEveryView) {
  SyntheticScene corridor = Corridor();
  for (const auto& [id, track] : corridor.scene.line_tracks) {
    ASSERT_LE(track.size(), 2u);
  }
  const auto result = SolveByCoplanarPairs("graph", &corridor.scene);
  ASSERT_TRUE(result) << result.error().ToString();
  EXPECT_EQ(result->poses.num_placed, kNumViews);
  EXPECT_EQ(result->ratios.num_meaningful, kNumViews - 2);
  // Errors of a chain add up: 80 m of corridor.
  EXPECT_LT(EvaluatePoses(corridor.scene, corridor.true_poses).position.median,
            2.0);
}

// Directions and tracks leave the scale of every link open: a strategy without
// ratios places two views, or none, and says so.
TEST(LongChain, StrategiesWithoutRatiosPlaceNoMoreThanAPair) {
  SyntheticScene corridor = Corridor();
  ASSERT_TRUE(SolveByCoplanarPairs("graph", &corridor.scene));
  const std::set<std::string> with_ratios = {"graph", "chain"};
  const AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  for (const std::string& name : registry.Names()) {
    PoseOptions options;
    options.averager = *registry.Make(name);
    const auto poses = SolveScenePoses(&corridor.scene, options, RunContext());
    ASSERT_TRUE(poses) << name << ": " << poses.error().ToString();
    if (with_ratios.count(name) > 0) {
      EXPECT_EQ(poses->num_placed, kNumViews) << name;
    } else {
      EXPECT_LE(poses->num_placed, 2) << name;
      EXPECT_GE(poses->unplaced.size(), kNumViews - 2u) << name;
    }
  }
}

}  // namespace
}  // namespace lowlap
