#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  SyntheticOptions options;
  std::string kind = "room";
  std::string output;
  std::string truth;
};

int RunSimulation(Flags flags) {
  const auto kind = SyntheticKindFromName(flags.kind);
  if (!kind) {
    return Fail({ErrorCode::kInvalidArgument,
                 "unknown kind of scene '" + flags.kind +
                     "'; known: room, corridor, ring, planar, collinear, "
                     "pure_rotation, twins",
                 {},
                 {}});
  }
  flags.options.kind = *kind;
  flags.options.seed = flags.common.seed;
  const auto synthetic = Simulate(flags.options);
  if (!synthetic) return Fail(synthetic.error());
  FileSet files;
  const auto added = WriteScene(synthetic->scene, flags.output, {}, &files);
  if (!added) return Fail(added.error());
  if (!flags.truth.empty()) {
    const auto truth_added =
        WriteScene(TrueSolution(*synthetic), flags.truth, {}, &files);
    if (!truth_added) return Fail(truth_added.error());
  }
  if (const Status written = files.Commit(); !written) {
    return Fail(written.error());
  }
  std::printf("%zu views, %zu pairs, %zu point tracks, %zu line tracks\n",
              synthetic->scene.views.size(),
              synthetic->scene.relative_poses.size(),
              synthetic->scene.point_tracks.size(),
              synthetic->scene.line_tracks.size());
  return 0;
}

}  // namespace

void AddSimulate(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  SyntheticOptions& o = flags->options;
  CLI::App* command = program->add_subcommand(
      "simulate", "Make a synthetic scene whose truth is known");
  command->option_defaults()->always_capture_default();
  command->add_option("--kind", flags->kind,
                      "room, corridor, ring; degenerate: planar, collinear, "
                      "pure_rotation, twins");
  command->add_option("-o,--output", flags->output, "Scene file to write")
      ->required();
  command->add_option(
      "--truth", flags->truth,
      "Also write the scene with its true solution, to this file");
  command->add_option("--views", o.num_views, "Number of views");
  command->add_option("--pairs", o.pairs,
                      "chain, cycle, window:N, loop:N or all");
  command->add_option("--points", o.points_per_wall, "Points per wall");
  command->add_option("--lines", o.lines_per_wall, "Lines per wall");
  command->add_option("--trifocal-points", o.trifocal_point_share,
                      "Share of points that three or more views may see");
  command->add_option("--trifocal-lines", o.trifocal_line_share,
                      "Share of lines that three or more views may see");
  command->add_option("--noise", o.noise_px, "Noise of features, in pixels");
  command->add_option("--wrong-points", o.wrong_point_share,
                      "Share of wrong point tracks");
  command->add_option("--wrong-lines", o.wrong_line_share,
                      "Share of wrong line tracks");
  command->add_option("--wrong-candidates", o.wrong_candidate_share,
                      "Share of candidate line pairs that are not coplanar");
  command->add_option("--broken-lines", o.broken_line_share,
                      "Share of lines that fall into two segments");
  command->add_option("--rotation-noise", o.rotation_noise_deg,
                      "Error of relative rotations, in degrees");
  command->add_option("--direction-noise", o.direction_noise_deg,
                      "Error of relative directions, in degrees");
  command->add_option("--pose-noise-of-points", o.pose_noise_factor,
                      "Errors of relative poses as the points with their noise "
                      "leave them, times this factor");
  command->add_option("--wrong-directions", o.wrong_direction_share,
                      "Share of relative poses with any direction");
  command->add_option("--off-line", o.off_line_m,
                      "Collinear: how far centres are off the line, in metres");
  command->add_option("--twin-baseline", o.twin_baseline_m,
                      "Twins: distance of every odd view from the one before "
                      "it, in metres");
  command->add_flag("--look-outwards", o.look_outwards,
                    "Rooms: look at the wall behind the camera's back");
  AddCommonFlags(command, &flags->common);
  command->callback(
      [flags, action] { *action = [flags] { return RunSimulation(*flags); }; });
}

}  // namespace lowlap::cli
