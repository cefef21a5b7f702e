#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct SimulateFlags {
  CommonFlags common;
  SyntheticOptions options;
  std::string kind = "room";
  std::string output;
  std::string truth;
};

// Options that do not change scenes of every kind.
Status CheckOptionsOfKind(const SyntheticOptions& options) {
  using Kind = SyntheticKind;
  struct OfKinds {
    const char* option;
    bool is_given;
    std::vector<Kind> kinds;
  };
  const std::vector<Kind> with_walls = {
      Kind::kRoom,   Kind::kCorridor,  Kind::kRing,         Kind::kHouse,
      Kind::kPlanar, Kind::kCollinear, Kind::kPureRotation, Kind::kTwins};
  for (const auto& [option, is_given, kinds] : std::vector<OfKinds>{
           {"--off-line", options.off_line_m > 0, {Kind::kCollinear}},
           {"--twin-baseline", options.twin_baseline_m > 0, {Kind::kTwins}},
           {"--wall-bulge", options.wall_bulge_m > 0, with_walls},
           {"--box-offset", options.box_offset_m > 0, with_walls},
           {"--look-outwards",
            options.look_outwards,
            {Kind::kRoom, Kind::kCloud, Kind::kPureRotation, Kind::kTwins}}}) {
    if (!is_given ||
        std::find(kinds.begin(), kinds.end(), options.kind) != kinds.end()) {
      continue;
    }
    return MakeError(ErrorCode::kInvalidArgument,
                     std::string(option) + " has no effect with --kind " +
                         SyntheticKindName(options.kind) + ", only with " +
                         Joined(kinds, ", ", SyntheticKindName));
  }
  return {};
}

Result<int> RunSimulation(const SimulateFlags& flags) {
  const auto kind = SyntheticKindFromName(flags.kind);
  if (!kind) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "unknown kind of scene '" + flags.kind +
                         "'; known: room, corridor, ring, house, cloud, "
                         "planar, collinear, pure_rotation, twins");
  }
  SyntheticOptions options = flags.options;
  options.kind = *kind;
  LOWLAP_RETURN_IF_ERROR(CheckOptionsOfKind(options));
  LOWLAP_RETURN_IF_ERROR(CheckDistinct(
      {}, {{"--truth", flags.truth}, {"--output", flags.output}}));
  LOWLAP_RETURN_IF_ERROR(CheckScenePlace(flags.output));
  if (!flags.truth.empty()) {
    LOWLAP_RETURN_IF_ERROR(CheckScenePlace(flags.truth));
  }
  options.seed = flags.common.seed;
  LOWLAP_ASSIGN_OR_RETURN(const auto synthetic, Simulate(options));
  FileSet files;
  LOWLAP_ASSIGN_OR_RETURN(
      const SceneNotes notes,
      WriteScene(synthetic.scene, flags.output, {}, &files));
  if (!flags.truth.empty()) {
    LOWLAP_RETURN_IF_ERROR(
        WriteScene(TrueSolution(synthetic), flags.truth, {}, &files));
  }
  LOWLAP_RETURN_IF_ERROR(files.Commit());
  const RunContext context = MakeContext(flags.common);
  for (const std::string& note : notes) {
    context.Log(LogLevel::kWarning, note);
  }
  std::printf(
      "%zu views, %zu pairs, %zu point tracks, %zu line tracks\n",
      synthetic.scene.views.size(), synthetic.scene.relative_poses.size(),
      synthetic.scene.point_tracks.size(), synthetic.scene.line_tracks.size());
  return 0;
}

}  // namespace

void AddSimulate(CLI::App* program, Action* action) {
  auto flags = std::make_shared<SimulateFlags>();
  SyntheticOptions& o = flags->options;
  CLI::App* command = AddCommand(program, "simulate",
                                 "Make a synthetic scene whose truth is known");
  ShowDefaultsFromHereOn(command);
  AddOption(command, "--kind", flags->kind,
            "room, corridor, ring, house, cloud; degenerate: planar, "
            "collinear, pure_rotation, twins");
  AddOption(command, "-o,--output", flags->output, "Scene file to write")
      .Required();
  AddOption(command, "--truth", flags->truth,
            "Also write the scene with its true solution, to this file");
  AddOption(command, "--views", o.num_views, "Number of views")
      .Must(Check::Between(2, 100000));
  AddOption(command, "--pairs", o.pairs,
            "chain, cycle, window:N, loop:N or all");
  AddOption(command, "--points", o.points_per_wall, "Points per wall")
      .Must(Check::Between(0, 1000000));
  AddOption(command, "--lines", o.lines_per_wall, "Lines per wall")
      .Must(Check::Between(0, 1000000));
  AddOption(command, "--trifocal-points", o.trifocal_point_share,
            "Share of points that three or more views may see")
      .Must(Check::Between(0.0, 1.0));
  AddOption(command, "--trifocal-lines", o.trifocal_line_share,
            "Share of lines that three or more views may see")
      .Must(Check::Between(0.0, 1.0));
  AddOption(command, "--noise", o.noise_px, "Noise of features, in pixels")
      .Must(Check::NonNegative());
  AddOption(command, "--wrong-points", o.wrong_point_share,
            "Share of wrong point tracks")
      .Must(Check::Between(0.0, 1.0));
  AddOption(command, "--wrong-lines", o.wrong_line_share,
            "Share of wrong line tracks")
      .Must(Check::Between(0.0, 1.0));
  AddOption(command, "--wrong-candidates", o.wrong_candidate_share,
            "Share of candidate line pairs that are not coplanar")
      .Must(Check::Between(0.0, 1.0));
  AddOption(command, "--broken-lines", o.broken_line_share,
            "Share of lines that fall into two segments")
      .Must(Check::Between(0.0, 1.0));
  AddOption(command, "--rotation-noise", o.rotation_noise_deg,
            "Error of relative rotations, in degrees")
      .Must(Check::NonNegative());
  AddOption(command, "--direction-noise", o.direction_noise_deg,
            "Error of relative directions, in degrees")
      .Must(Check::NonNegative());
  AddOption(command, "--pose-noise-of-points", o.pose_noise_factor,
            "Errors of relative poses as the points with their noise "
            "leave them, times this factor")
      .Must(Check::NonNegative());
  AddOption(command, "--wrong-directions", o.wrong_direction_share,
            "Share of relative poses with any direction")
      .Must(Check::Between(0.0, 1.0));
  AddOption(command, "--off-line", o.off_line_m,
            "Collinear: how far centres are off the line, in metres")
      .Must(Check::NonNegative());
  AddOption(command, "--twin-baseline", o.twin_baseline_m,
            "Twins: distance of every odd view from the one before "
            "it, in metres")
      .Must(Check::NonNegative());
  AddOption(command, "--wall-bulge", o.wall_bulge_m,
            "How far the middle of every wall bows out, in metres")
      .Must(Check::NonNegative());
  AddOption(command, "--box-offset", o.box_offset_m,
            "How far the front of a box, in the middle of every wall, is "
            "before it, in metres")
      .Must(Check::NonNegative());
  AddFlag(command, "--look-outwards", o.look_outwards,
          "Rooms: look at the wall behind the camera's back");
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, RunSimulation, action);
}

}  // namespace lowlap::cli
