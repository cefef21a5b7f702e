#include "cli/solve_flags.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include "cli/command.h"
#include "lowlap/adjustment/intrinsic_refinement.h"
#include "lowlap/averaging/pose_warnings.h"
#include "lowlap/averaging/strategies.h"
#include "lowlap/pipeline/output_folder.h"
#include "third_party_adapters/onedsfm/problem.h"
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
  for (const std::string& warning : PoseWarnings(poses, scene)) {
    // Lists of many names are for the report.
    constexpr std::size_t kLongest = 300;
    std::printf(
        "warning: %s\n",
        warning.size() <= kLongest
            ? warning.c_str()
            : (warning.substr(0, kLongest) + "... (see report.html)").c_str());
  }
}

// A truth that says nothing about the scene is a mistake in the command.
Result<std::optional<GroundTruth>> KnownTruth(GroundTruth truth,
                                              const Scene& scene,
                                              const std::string& path) {
  for (const auto& entry : truth) {
    if (scene.views.count(entry.first) > 0) {
      return std::optional<GroundTruth>(std::move(truth));
    }
  }
  return MakeError(
      ErrorCode::kInsufficientData,
      truth.empty()
          ? "holds no camera poses to compare with"
          : "no view of the scene has the name or the id of a true camera",
      path);
}

void PrintCost(const std::vector<StageCost>& stages) {
  std::printf("%-16s %8s %8s\n", "stage", "wall s", "CPU s");
  double wall = 0, cpu = 0;
  StageCost front_end;
  for (const StageCost& stage : stages) {
    if (stage.name == "features" || stage.name == "matching" ||
        stage.name == "relative poses") {
      front_end.wall_s += stage.wall_s;
      front_end.cpu_s += stage.cpu_s;
    }
    std::printf("%-16s %8.2f %8.2f\n", stage.name.c_str(), stage.wall_s,
                stage.cpu_s);
    wall += stage.wall_s;
    cpu += stage.cpu_s;
  }
  std::printf("%-16s %8.2f %8.2f   peak memory %.0f MB\n", "total", wall, cpu,
              PeakMemoryMb());
  if (front_end.cpu_s > 0) {
    std::printf(
        "features, matching and relative poses together: %.2f s, %.2f s of "
        "CPU\n",
        front_end.wall_s, front_end.cpu_s);
  }
}

}  // namespace

void AddScaleFlags(CLI::App* command, ScaleFlags* flags) {
  std::map<std::string, std::string> help_of;
  const EvidenceRegistry& registry = EvidenceRegistry::BuiltIn();
  for (const EvidenceRegistry::Entry& entry : registry.entries()) {
    if (entry.flag.empty()) {
      help_of[entry.feature] = entry.help;
      continue;
    }
    command->add_flag("--" + entry.flag + ",!--no-" + entry.flag,
                      flags->asked.emplace(entry.name, true).first->second,
                      "Whether " + entry.feature + " includes " + entry.help);
  }
  std::string known;
  for (const std::string& word : registry.Features()) {
    known += (known.empty() ? "" : ", ") + word + " (" + help_of[word] + ")";
  }
  command
      ->add_option("--features", flags->features,
                   "Kinds that determine the scale ratios, separated by "
                   "commas: " +
                       known)
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--criterion", flags->criterion,
                   "How a ratio is chosen: ac (a contrario, no threshold) or "
                   "ransac (most inliers within --threshold)")
      ->check(CLI::IsMember({"ac", "ransac"}))
      ->capture_default_str();
  command
      ->add_option("--nfa", flags->nfa,
                   "Number of false alarms: calibrated, or as in the paper")
      ->check(CLI::IsMember({"calibrated", "paper"}))
      ->capture_default_str();
  command
      ->add_option("--threshold", flags->threshold_px,
                   "Inlier threshold of --criterion ransac, in pixels")
      ->check(Positive())
      ->capture_default_str();
}

Result<ScaleOptions> MakeScaleOptions(const ScaleFlags& flags) {
  ScaleOptions options;
  options.features = flags.features;
  for (const auto& [kind, asked] : flags.asked) {
    if (!asked) options.without.push_back(kind);
  }
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
                   "How poses are composed: graph (average over all ratios), "
                   "chain (the paper's composition), or another strategy of "
                   "'lowlap compare', such as lud or 1dsfm+lud")
      ->check(CLI::Validator(
          [](const std::string& name) {
            const auto averager = MakeTranslationAverager(name);
            return averager ? std::string() : averager.error().message;
          },
          "NAME"))
      ->capture_default_str();
  AddAdjustFlags(command, flags);
  AddRefinementFlag(command, &flags->refine_intrinsics)
      ->excludes(command->get_option("--no-adjust"));
  AddTruthFlag(command, &flags->ground_truth);
}

void AddAdjustFlags(CLI::App* command, SolveFlags* flags) {
  command
      ->add_option("--adjust-features", flags->adjust_features,
                   "Kinds in the bundle adjustment, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  AddPrincipalPointFlag(command, &flags->principal_point_stddev);
  command->add_flag("--no-adjust", flags->no_adjust,
                    "Stop before the bundle adjustment");
}

void AddPrincipalPointFlag(CLI::App* command, double* stddev) {
  command
      ->add_option("--principal-point-stddev", *stddev,
                   "How well the given principal points are known, as a share "
                   "of the image diagonal: the bundle adjustment moves them "
                   "within this (0: exactly)")
      ->check(NonNegative())
      ->capture_default_str();
}

CLI::Option* AddTruthFlag(CLI::App* command, std::string* path) {
  return command->add_option(
      "--gt", *path,
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

CLI::Option* AddRefinementFlag(CLI::App* command, std::string* parts) {
  return command
      ->add_option("--refine-intrinsics", *parts,
                   "Let the bundle adjustment refine the intrinsics (not done "
                   "unless asked for), each for "
                   "all its views: a list of focal, aspect (fy / fx), "
                   "principal-point, distortion (of a pinhole: k1), or all; "
                   "without a list: focal,distortion. What is not named is "
                   "held, the principal point too")
      ->expected(0, 1)
      ->default_str("focal,distortion");
}

Result<IntrinsicRefinement> ParseRefinement(const std::string& parts) {
  IntrinsicRefinement refinement;
  for (const std::string& part : CLI::detail::split(parts, ',')) {
    const bool all = part == "all";
    const bool known = all || part == "focal" || part == "aspect" ||
                       part == "principal-point" || part == "distortion";
    if (!known && !part.empty()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "--refine-intrinsics knows no '" + part +
                           "'; known: focal, aspect, principal-point, "
                           "distortion, all");
    }
    refinement.focal |= all || part == "focal";
    refinement.aspect_ratio |= all || part == "aspect";
    refinement.principal_point |= all || part == "principal-point";
    refinement.distortion |= all || part == "distortion";
  }
  return refinement;
}

Status SetRefinement(const std::string& parts, Scene* scene,
                     AdjustmentOptions* options) {
  const auto refinement = ParseRefinement(parts);
  if (!refinement) return tl::unexpected<Error>(refinement.error());
  RefineAllIntrinsics(*refinement, scene, options);
  return {};
}

void PrintIntrinsics(const Scene& before, const Scene& after) {
  for (const std::string& line : DescribeIntrinsicChanges(before, after)) {
    std::printf("%s\n", line.c_str());
  }
}

Result<SolveOptions> MakeSolveOptions(const SolveFlags& flags) {
  if (const auto refinement = ParseRefinement(flags.refine_intrinsics);
      !refinement) {
    return tl::unexpected<Error>(refinement.error());
  }
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
  options.adjustment.principal_point_stddev = flags.principal_point_stddev;
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
    const auto solved = ReadScene(path);
    if (!solved) return tl::unexpected<Error>(solved.error());
    auto truth = GroundTruthFromScene(*solved, scene);
    if (!truth) {
      truth.error().file = path;
      return tl::unexpected<Error>(truth.error());
    }
    return KnownTruth(std::move(*truth), scene, path);
  }
  if (onedsfm::IsProblemFolder(path)) {
    auto truth = onedsfm::ReadTruePoses(path);
    if (!truth) return tl::unexpected<Error>(truth.error());
    return KnownTruth(std::move(*truth), scene, path);
  }
  const auto poses = strecha::ReadGroundTruth(path);
  if (!poses) return tl::unexpected<Error>(poses.error());
  auto truth = GroundTruthByName(scene, *poses);
  if (!truth) {
    if (truth.error().file.empty()) truth.error().file = path;
    return tl::unexpected<Error>(truth.error());
  }
  return std::optional<GroundTruth>(std::move(*truth));
}

int SolveAndWrite(Scene scene, const SolveFlags& flags, RunSummary summary,
                  StageLog* stages, const RunContext& context,
                  const std::string& input, const std::string& output) {
  auto options = MakeSolveOptions(flags);
  if (!options) return Fail(options.error());
  const auto truth = LoadGroundTruth(flags.ground_truth, scene);
  if (!truth) return Fail(truth.error());
  Scene start;
  start.intrinsics = scene.intrinsics;
  if (const Status set =
          SetRefinement(flags.refine_intrinsics, &scene, &options->adjustment);
      !set) {
    return Fail(set.error());
  }

  auto result = SolveScene(&scene, *options, context, stages);
  if (!result) {
    if (result.error().file.empty()) result.error().file = input;
    return Fail(result.error());
  }
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
  if (IsInterrupted()) return Fail({ErrorCode::kCancelled, {}, {}, {}});
  Status written = PrepareOutputFolder(output);
  if (written) written = WriteOutputs(scene, summary, output);
  if (!written) return Fail(written.error());

  PrintPoses(summary.solve->poses, scene);
  PrintIntrinsics(start, scene);
  if (summary.evaluation_before_adjustment &&
      summary.evaluation_before_adjustment->scope == EvaluationScope::kFull) {
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
