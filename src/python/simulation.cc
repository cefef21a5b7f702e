#include <memory>
#include <string>
#include <utility>

#include "lowlap/synthetic/synthetic_scene.h"
#include "python/keywords.h"

namespace lowlap::python {
namespace {

std::pair<std::shared_ptr<Scene>, std::shared_ptr<Scene>> SimulateScene(
    const std::string& kind, const py::kwargs& kwargs) {
  SyntheticOptions options;
  const auto known = SyntheticKindFromName(kind);
  if (!known) {
    Raise({ErrorCode::kInvalidArgument,
           "unknown kind of scene '" + kind + "'",
           {},
           {}});
  }
  options.kind = *known;
  Keywords keywords("simulate", kwargs);
  keywords.Take("views", &options.num_views);
  keywords.Take("pairs", &options.pairs);
  keywords.Take("points", &options.points_per_wall);
  keywords.Take("lines", &options.lines_per_wall);
  keywords.Take("trifocal_points", &options.trifocal_point_share);
  keywords.Take("trifocal_lines", &options.trifocal_line_share);
  keywords.Take("noise", &options.noise_px);
  keywords.Take("wrong_points", &options.wrong_point_share);
  keywords.Take("wrong_lines", &options.wrong_line_share);
  keywords.Take("wrong_candidates", &options.wrong_candidate_share);
  keywords.Take("broken_lines", &options.broken_line_share);
  keywords.Take("rotation_noise", &options.rotation_noise_deg);
  keywords.Take("direction_noise", &options.direction_noise_deg);
  keywords.Take("pose_noise_of_points", &options.pose_noise_factor);
  keywords.Take("wrong_directions", &options.wrong_direction_share);
  keywords.Take("off_line", &options.off_line_m);
  keywords.Take("twin_baseline", &options.twin_baseline_m);
  keywords.Take("wall_bulge", &options.wall_bulge_m);
  keywords.Take("box_offset", &options.box_offset_m);
  keywords.Take("look_outwards", &options.look_outwards);
  keywords.Take("seed", &options.seed);
  keywords.Finish();
  SyntheticScene made = ValueOf(Simulate(options));
  auto truth = std::make_shared<Scene>(TrueSolution(made));
  return {std::make_shared<Scene>(std::move(made.scene)), std::move(truth)};
}

}  // namespace

void BindSimulation(py::module_& module) {
  module.def(
      "simulate", &SimulateScene, py::arg("kind") = "room",
      "A synthetic scene, and the same with its true solution.\n\n"
      "Options, as the flags of `lowlap simulate`: views, pairs, points,\n"
      "lines, trifocal_points, trifocal_lines, noise, wrong_points,\n"
      "wrong_lines, wrong_candidates, broken_lines, rotation_noise,\n"
      "direction_noise, pose_noise_of_points, wrong_directions,\n"
      "off_line, twin_baseline, wall_bulge, box_offset, look_outwards,\n"
      "seed.");
}

}  // namespace lowlap::python
