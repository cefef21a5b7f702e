#include "cli/solve_flags.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "cli/command.h"
#include "lowlap/averaging/strategies.h"
#include "lowlap/pipeline/output_folder.h"
#include "third_party_adapters/scene_formats.h"
#include "third_party_adapters/strecha/strecha.h"

namespace lowlap::cli {
namespace {

struct Kinds {
  bool points = false;
  bool lines = false;
  bool coplanar = false;
};

Result<Kinds> ParseKinds(const std::vector<std::string>& names) {
  Kinds kinds;
  for (const std::string& name : names) {
    if (name == "points") {
      kinds.points = true;
    } else if (name == "lines") {
      kinds.lines = true;
    } else if (name == "coplanar") {
      kinds.coplanar = true;
    } else {
      return MakeError(ErrorCode::kInvalidArgument,
                       "unknown kind of feature '" + name +
                           "'; known: points, lines, coplanar");
    }
  }
  return kinds;
}

void PrintPoses(const PoseSummary& poses, const Scene& scene) {
  std::printf("cameras placed: %d/%d\n", poses.num_placed, poses.num_views);
  if (!poses.unplaced.empty()) {
    std::printf("not placed (no scale joins them to the others):");
    for (const ViewId view : poses.unplaced) {
      std::printf(" %s", scene.views.at(view).filename.c_str());
    }
    std::printf("\n");
  }
  if (!poses.outlier_edges.empty()) {
    std::printf(
        "relative poses left out, since their rotations contradict the others: "
        "%zu of %zu (report.html names them)\n",
        poses.outlier_edges.size(), scene.relative_poses.size());
  }
}

void PrintCost(const std::vector<StageCost>& stages) {
  std::printf("%-16s %8s %8s\n", "stage", "wall s", "CPU s");
  double wall = 0, cpu = 0;
  for (const StageCost& stage : stages) {
    std::printf("%-16s %8.2f %8.2f\n", stage.name.c_str(), stage.wall_s,
                stage.cpu_s);
    wall += stage.wall_s;
    cpu += stage.cpu_s;
  }
  std::printf("%-16s %8.2f %8.2f   peak memory %.0f MB\n", "total", wall, cpu,
              PeakMemoryMb());
}

}  // namespace

void AddScaleFlags(CLI::App* command, ScaleFlags* flags) {
  command
      ->add_option("--features", flags->features,
                   "Kinds that determine the scale ratios, separated by "
                   "commas: points, lines (both seen in three views), coplanar "
                   "(pairs of lines seen in two views each)")
      ->delimiter(',');
  command
      ->add_option("--criterion", flags->criterion,
                   "How a ratio is chosen: ac (a contrario, no threshold) or "
                   "ransac (most inliers within --threshold)")
      ->check(CLI::IsMember({"ac", "ransac"}));
  command
      ->add_option("--nfa", flags->nfa,
                   "Number of false alarms: calibrated, or as in the paper")
      ->check(CLI::IsMember({"calibrated", "paper"}));
  command
      ->add_option("--threshold", flags->threshold_px,
                   "Inlier threshold of --criterion ransac, in pixels")
      ->check(CLI::PositiveNumber);
}

Result<ScaleOptions> MakeScaleOptions(const ScaleFlags& flags) {
  const auto kinds = ParseKinds(flags.features);
  if (!kinds) return tl::unexpected<Error>(kinds.error());
  ScaleOptions options;
  options.use_points = kinds->points;
  options.use_lines = kinds->lines;
  options.use_coplanar = kinds->coplanar;
  options.criterion = flags.criterion == "ac" ? ScaleCriterion::kAContrario
                                              : ScaleCriterion::kFixedThreshold;
  options.nfa_form =
      flags.nfa == "paper" ? NfaForm::kPaper : NfaForm::kCalibrated;
  options.threshold_px = flags.threshold_px;
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  return options;
}

void AddSolveFlags(CLI::App* command, SolveFlags* flags) {
  AddScaleFlags(command, &flags->scale);
  command
      ->add_option("--strategy", flags->strategy,
                   "How poses are composed: graph (average over all ratios) or "
                   "chain (the paper's composition)")
      ->check(CLI::IsMember(TranslationAveragerNames()));
  command
      ->add_option("--adjust-features", flags->adjust_features,
                   "Kinds in the bundle adjustment, separated by commas")
      ->delimiter(',');
  command->add_flag("--no-adjust", flags->no_adjust,
                    "Stop before the bundle adjustment");
  command->add_option("--gt", flags->ground_truth,
                      "True cameras to evaluate against, never used for "
                      "solving: a folder of Strecha's .camera files, or a "
                      "scene file");
}

Status SetAdjustedFeatures(const std::vector<std::string>& features,
                           AdjustmentOptions* options) {
  const auto kinds = ParseKinds(features);
  if (!kinds) return tl::unexpected<Error>(kinds.error());
  options->use_points = kinds->points;
  options->use_lines = kinds->lines || kinds->coplanar;
  options->use_coplanar = kinds->coplanar;
  return {};
}

Result<SolveOptions> MakeSolveOptions(const SolveFlags& flags) {
  SolveOptions options;
  const auto scale = MakeScaleOptions(flags.scale);
  if (!scale) return tl::unexpected<Error>(scale.error());
  options.scale = *scale;
  options.poses.strategy = flags.strategy;
  if (const Status set =
          SetAdjustedFeatures(flags.adjust_features, &options.adjustment);
      !set) {
    return tl::unexpected<Error>(set.error());
  }
  options.adjust = !flags.no_adjust;
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  return options;
}

Result<std::optional<GroundTruth>> LoadGroundTruth(const std::string& path,
                                                   const Scene& scene) {
  if (path.empty()) return std::optional<GroundTruth>();
  if (std::filesystem::is_regular_file(path)) {
    const auto truth = ReadScene(path);
    if (!truth) return tl::unexpected<Error>(truth.error());
    return std::optional<GroundTruth>(GroundTruthFromScene(*truth));
  }
  const auto poses = strecha::ReadGroundTruth(path);
  if (!poses) return tl::unexpected<Error>(poses.error());
  auto truth = GroundTruthByName(scene, *poses);
  if (!truth) return tl::unexpected<Error>(truth.error());
  return std::optional<GroundTruth>(std::move(*truth));
}

int SolveAndWrite(Scene scene, const SolveFlags& flags, RunSummary summary,
                  StageLog* stages, const RunContext& context,
                  const std::string& output) {
  const auto options = MakeSolveOptions(flags);
  if (!options) return Fail(options.error());
  const auto truth = LoadGroundTruth(flags.ground_truth, scene);
  if (!truth) return Fail(truth.error());

  auto result = SolveScene(&scene, *options, context, stages);
  if (!result) return Fail(result.error());
  if (*truth) {
    if (result->adjustment) {
      Scene before = scene;
      before.poses = result->poses_before_adjustment;
      summary.evaluation_before_adjustment = EvaluatePoses(before, **truth);
    }
    summary.evaluation = EvaluatePoses(scene, **truth);
  }
  summary.solve = std::move(*result);
  summary.stages = stages->stages();
  Status written = PrepareOutputFolder(output);
  if (written) written = WriteOutputs(scene, summary, output);
  if (!written) return Fail(written.error());

  PrintPoses(summary.solve->poses, scene);
  if (summary.evaluation_before_adjustment) {
    std::printf("\nbefore adjustment: mean position error %.4f\n",
                summary.evaluation_before_adjustment->position.mean);
  }
  if (summary.evaluation) {
    std::printf("\n%s\n", ToText(*summary.evaluation).c_str());
  }
  PrintCost(summary.stages);
  std::printf(
      "written to %s: report.html sfm_data.json scene.lowlap cloud.ply "
      "summary.json\n",
      output.c_str());
  return 0;
}

}  // namespace lowlap::cli
