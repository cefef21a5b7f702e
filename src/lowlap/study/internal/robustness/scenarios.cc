#include "lowlap/study/internal/robustness/scenarios.h"

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/joined.h"

namespace lowlap {
namespace {

using Levels = std::vector<double>;

const Levels& Shares() {
  static const Levels shares = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  return shares;
}

// Twelve views, each with the two before and the two after it.
RobustnessLevel FeatureLevel(SyntheticKind world,
                             const std::vector<std::string>& features) {
  RobustnessLevel level;
  SyntheticOptions& scene = level.scene;
  scene.kind = world;
  scene.num_views = 12;
  scene.pairs = "window:2";
  scene.points_per_wall = world == SyntheticKind::kRing ? 15 : 40;
  scene.lines_per_wall = world == SyntheticKind::kRing ? 20 : 60;
  scene.noise_px = 1.0;
  scene.pose_noise_factor = 1.0;
  level.scale.features = features;
  if (features == std::vector<std::string>{"coplanar"}) {
    // Every feature belongs to one pair only: more are needed.
    scene.points_per_wall *= 4;
    scene.lines_per_wall *= 5;
    scene.trifocal_point_share = 0;
    scene.trifocal_line_share = 0;
  }
  return level;
}

RobustnessLevel GraphLevel(SyntheticKind world, int num_views) {
  RobustnessLevel level;
  level.has_features = false;
  level.averages_rotations = false;
  level.scene.kind = world;
  level.scene.num_views = num_views;
  level.scene.pairs = "window:4";
  level.scene.points_per_wall = 0;
  level.scene.lines_per_wall = 0;
  level.scene.rotation_noise_deg = 0.1;
  level.scene.direction_noise_deg = 0.3;
  level.ratios.log_stddev = 0.02;
  return level;
}

struct Definition {
  const char* name;
  const char* axis;
  bool is_logarithmic;
  bool in_every_world;  // else only in `world`
  SyntheticKind world;
  Levels values;
  std::function<RobustnessLevel(SyntheticKind, double)> make;
};

const std::vector<Definition>& Definitions() {
  static const auto* definitions = new std::vector<Definition>{
      {"wrong_points", "share of wrong points", false, true,
       SyntheticKind::kRoom, Shares(),
       [](SyntheticKind world, double value) {
         RobustnessLevel level = FeatureLevel(world, {"points"});
         level.scene.wrong_point_share = value;
         return level;
       }},
      {"wrong_lines", "share of wrong lines", false, true, SyntheticKind::kRoom,
       Shares(),
       [](SyntheticKind world, double value) {
         RobustnessLevel level = FeatureLevel(world, {"lines"});
         level.scene.wrong_line_share = value;
         return level;
       }},
      {"wrong_coplanar", "share of wrong candidate line pairs", false, true,
       SyntheticKind::kRoom, Shares(),
       [](SyntheticKind world, double value) {
         RobustnessLevel level = FeatureLevel(world, {"coplanar"});
         level.scene.wrong_candidate_share = value;
         return level;
       }},
      {"noise",
       "noise of features (px)",
       true,
       true,
       SyntheticKind::kRoom,
       {0.1, 0.2, 0.5, 1, 1.5, 2, 3, 4, 5},
       [](SyntheticKind world, double value) {
         RobustnessLevel level = FeatureLevel(world, {});
         level.scene.noise_px = value;
         return level;
       }},
      {"wrong_ratios", "share of wrong ratios", false, true,
       SyntheticKind::kRoom, Shares(),
       [](SyntheticKind world, double value) {
         RobustnessLevel level = GraphLevel(world, 50);
         level.ratios.wrong_share = value;
         return level;
       }},
      {"wrong_directions", "share of wrong directions", false, true,
       SyntheticKind::kRoom, Shares(),
       [](SyntheticKind world, double value) {
         RobustnessLevel level = GraphLevel(world, 50);
         level.scene.wrong_direction_share = value;
         return level;
       }},
      {"wrong_poses", "share of wrong relative poses", false, true,
       SyntheticKind::kRoom, Shares(),
       [](SyntheticKind world, double value) {
         RobustnessLevel level = GraphLevel(world, 50);
         level.averages_rotations = true;
         level.scene.wrong_pose_share = value;
         level.ratios.wrong_beside_wrong_poses = true;
         return level;
       }},
      {"views",
       "number of views",
       true,
       true,
       SyntheticKind::kRoom,
       {3, 5, 10, 30, 100, 300, 1000, 5000},
       [](SyntheticKind world, double value) {
         RobustnessLevel level = GraphLevel(world, static_cast<int>(value));
         level.ratios.wrong_share = 0.1;
         return level;
       }},
      {"line",
       "distance of the centres from a line (m)",
       true,
       false,
       SyntheticKind::kCollinear,
       {0.001, 0.003, 0.01, 0.03, 0.1, 0.2, 0.3},
       [](SyntheticKind world, double value) {
         RobustnessLevel level = FeatureLevel(world, {});
         level.scene.off_line_m = value;
         return level;
       }},
      {"twins",
       "length of every other baseline (m)",
       true,
       false,
       SyntheticKind::kTwins,
       {0.001, 0.003, 0.01, 0.03, 0.1, 0.3},
       [](SyntheticKind world, double value) {
         RobustnessLevel level = FeatureLevel(world, {});
         level.scene.twin_baseline_m = value;
         return level;
       }},
      {"no_triplets",
       "number of views",
       true,
       false,
       SyntheticKind::kCorridor,
       {3, 5, 10, 30, 100},
       [](SyntheticKind world, double value) {
         RobustnessLevel level = FeatureLevel(world, {"coplanar"});
         level.scene.num_views = static_cast<int>(value);
         level.scene.pairs = "chain";
         return level;
       }},
  };
  return *definitions;
}

}  // namespace

std::vector<std::string> RobustnessScenarioNames() {
  std::vector<std::string> names;
  for (const Definition& definition : Definitions()) {
    names.emplace_back(definition.name);
  }
  return names;
}

Result<std::vector<RobustnessScenario>> MakeRobustnessScenarios(
    const std::string& name, bool quick) {
  for (const Definition& definition : Definitions()) {
    if (name != definition.name) continue;
    std::vector<SyntheticKind> worlds = {definition.world};
    if (definition.in_every_world && !quick) {
      worlds.push_back(SyntheticKind::kCorridor);
      worlds.push_back(SyntheticKind::kRing);
    }
    std::vector<RobustnessScenario> scenarios;
    for (const SyntheticKind world : worlds) {
      RobustnessScenario scenario;
      scenario.name = definition.name;
      scenario.world = SyntheticKindName(world);
      scenario.axis = definition.axis;
      scenario.is_logarithmic = definition.is_logarithmic;
      for (std::size_t n = 0; n < definition.values.size(); ++n) {
        RobustnessLevel level = definition.make(world, definition.values[n]);
        if (quick && (n % 3 != 0 || level.scene.num_views > 50)) continue;
        level.value = definition.values[n];
        scenario.levels.push_back(std::move(level));
      }
      scenario.hard_when_small =
          definition.world == SyntheticKind::kCollinear ||
          definition.world == SyntheticKind::kTwins;
      scenario.levels_grow = scenario.levels.front().scene.num_views !=
                             scenario.levels.back().scene.num_views;
      scenarios.push_back(std::move(scenario));
    }
    return scenarios;
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "unknown scenario '" + name +
                       "'; known: " + Joined(RobustnessScenarioNames(), ", "));
}

}  // namespace lowlap
