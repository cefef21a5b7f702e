#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/synthetic/internal/simulate_ratios.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// One value on the axis of a scenario, and the input that belongs to it.
struct RobustnessLevel {
  double value = 0;
  SyntheticOptions scene;
  /// Ratios are estimated from the scene's features with `scale`. Otherwise the
  /// scene has no features, and ratios are drawn.
  bool has_features = true;
  /// Rotations are averaged, and relative poses that contradict them left out;
  /// otherwise the rotations are the true ones.
  bool averages_rotations = true;
  ScaleOptions scale;
  SimulatedRatioOptions ratios;

  /// Strategies on point tracks get those that the ratios come from.
  bool HasTracks() const { return has_features && scale.Asks("points"); }
};

/// What gets worse from level to level, in one simulated world.
struct RobustnessScenario {
  std::string name;   // "wrong_points"
  std::string world;  // "room", "corridor", "ring"
  std::string axis;   // what the value is, with its unit
  bool is_logarithmic = false;
  bool levels_grow = false;             // the value is the number of views
  bool hard_when_small = false;         // the smaller the value
  std::vector<RobustnessLevel> levels;  // by value

  std::string Id() const { return name + "_" + world; }
};

/// The names of the scenarios:
///   wrong_points, wrong_lines, wrong_coplanar   share of the tracks (candidate
///                   line pairs) that are wrong, when nothing else determines
///                   the ratios
///   noise           of all features, in pixels, relative poses as good as they
///                   can be with it
///   wrong_ratios, wrong_directions   share of the ratios (directions), drawn
///   wrong_poses     share of the relative poses that are anything, and the
///                   ratios beside them as well
///   views           number of views, a tenth of the ratios wrong
///   line            centres almost on a line: how far they are off it
///   twins           tiny baselines, almost pure rotations: their length
///   no_triplets     length of a chain where no three views share a feature
std::vector<std::string> RobustnessScenarioNames();

/// The scenario of that name in every world it is defined for. `quick`: the
/// room alone (or the first world) and a third of the levels, none of them
/// large. kInvalidArgument lists the known names.
Result<std::vector<RobustnessScenario>> MakeRobustnessScenarios(
    const std::string& name, bool quick);

}  // namespace lowlap
