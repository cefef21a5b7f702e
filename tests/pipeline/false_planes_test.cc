#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

constexpr std::size_t kSeeds = 30;

struct World {
  std::string name;
  SyntheticOptions options;
};

World Make(const std::string& name, SyntheticKind kind, double wall_bulge_m,
           double box_offset_m) {
  World world{name, {}};
  SyntheticOptions& options = world.options;
  options.kind = kind;
  options.wall_bulge_m = wall_bulge_m;
  options.box_offset_m = box_offset_m;
  options.num_views = 10;
  options.pairs = "window:1";
  options.points_per_wall = 40;
  options.lines_per_wall = 80;
  options.noise_px = 1;
  options.pose_noise_factor = 1;
  return world;
}

double MeanError(const SyntheticScene& synthetic, bool planes) {
  SolveOptions options;
  if (!planes) options.adjustment.coplanar_ties = CoplanarTies::kPairs;
  RunContext alone;
  alone.num_threads = 1;
  Scene scene = synthetic.scene;
  StageLog stages;
  const auto solved = SolveScene(&scene, options, alone, &stages);
  EXPECT_TRUE(solved) << solved.error().ToString();
  return EvaluatePoses(scene, synthetic.true_poses).position.mean;
}

// Median, over the seeds, of the error with planes and directions over that
// without.
double MedianRatio(SyntheticOptions options) {
  std::vector<double> ratios(kSeeds);
  EXPECT_TRUE(ParallelFor(RunContext(), "", kSeeds, [&](std::size_t n) {
    SyntheticOptions of_seed = options;
    of_seed.seed = n;
    const SyntheticScene synthetic = *Simulate(of_seed);
    ratios[n] = MeanError(synthetic, true) / MeanError(synthetic, false);
  }));
  return Median(std::move(ratios));
}

class FalsePlanes : public ::testing::TestWithParam<World> {};

TEST_P(FalsePlanes, CostNextToNothing) {
  EXPECT_LT(MedianRatio(GetParam().options), 1.05);
}

INSTANTIATE_TEST_SUITE_P(
    Worlds, FalsePlanes,
    ::testing::Values(Make("cloud", SyntheticKind::kCloud, 0, 0),
                      Make("bowed_by_10_cm", SyntheticKind::kRoom, 0.1, 0),
                      Make("bowed_by_30_cm", SyntheticKind::kRoom, 0.3, 0),
                      Make("boxes_5_cm_before", SyntheticKind::kRoom, 0, 0.05)),
    [](const auto& world) { return world.param.name; });

TEST(TruePlanes, Help) {
  EXPECT_LT(MedianRatio(Make("", SyntheticKind::kRoom, 0, 0).options), 0.97);
}

}  // namespace
}  // namespace lowlap
