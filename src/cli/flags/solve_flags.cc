#include "cli/flags/solve_flags.h"

#include <cstdio>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "cli/command.h"
#include "cli/flags/truth.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/adjustment/internal/uncertainty/rival_optima.h"
#include "lowlap/averaging/averager_registry.h"
#include "lowlap/averaging/reliability/internal/pose_warnings.h"
#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/report/internal/table_text.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

constexpr char kRefinementFlag[] = "--refine-intrinsics";
constexpr char kRefinedWithoutList[] = "focal,distortion";

int CountFirm(const PoseSummary& poses) {
  int count = 0;
  for (const auto& entry : GradeViews(poses)) {
    count += entry.second.grade == ViewGrade::kFirm ? 1 : 0;
  }
  return count;
}

void PrintPoses(const PoseSummary& poses, const Scene& scene) {
  std::printf("cameras placed: %d/%d, firm: %d\n", poses.num_placed,
              poses.num_views, CountFirm(poses));
  const std::vector<std::string> warnings = PoseWarningsByCause(poses, scene);
  for (const std::string& warning : warnings) {
    // Lists of many names are for the report.
    constexpr std::size_t kLongest = 300;
    std::printf("warning: %s\n",
                warning.size() <= kLongest
                    ? warning.c_str()
                    : (warning.substr(0, kLongest) + "...").c_str());
  }
  if (!warnings.empty()) std::printf("(details: report.html)\n");
}

void PrintCost(const std::vector<StageCost>& stages) {
  std::printf("%-16s %8s %8s\n", "stage", "wall s", "CPU s");
  double wall = 0, cpu = 0;
  StageCost front_end;
  for (const StageCost& stage : stages) {
    if (stage.name == "features" || stage.name == "matching" ||
        stage.name == "tilted views" || stage.name == "relative poses") {
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
    AddFlag(command, "--" + entry.flag + ",!--no-" + entry.flag,
            flags->asked.emplace(entry.name, true).first->second,
            "Whether " + entry.feature + " includes " + entry.help);
  }
  const std::string known =
      Joined(registry.Features(), ", ", [&](const std::string& word) {
        return word + " (" + help_of[word] + ")";
      });
  AddOption(command, "--features", flags->features,
            "Kinds that determine the scale ratios, separated by "
            "commas: " +
                known)
      .SeparatedBy(',')
      .ShowDefault();
  AddOption(command, "--criterion", flags->criterion,
            "How a ratio is chosen: ac (a contrario, no threshold) or "
            "ransac (most inliers within --threshold)")
      .Must(Check::OneOf({"ac", "ransac"}))
      .ShowDefault();
  AddOption(command, "--nfa", flags->nfa,
            "Number of false alarms: calibrated, or as in the paper")
      .Must(Check::OneOf({"calibrated", "paper"}))
      .ShowDefault();
  AddOption(command, "--threshold", flags->threshold_px,
            "Inlier threshold of --criterion ransac, in pixels")
      .Must(Check::Positive())
      .ShowDefault(NumberText(ScaleOptions{}.threshold_px, 6));
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
  if (flags.threshold_px && options.criterion == ScaleCriterion::kAContrario) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "--threshold needs --criterion ransac: a contrario there "
                     "is none");
  }
  options.threshold_px = flags.threshold_px.value_or(options.threshold_px);
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  return options;
}

void AddStrategyFlag(CLI::App* command, std::string* strategy) {
  AddOption(command, "--strategy", *strategy,
            "How poses are composed; the strategies and their options "
            "are listed below")
      .Must(Check(
          [](const std::string& request) {
            const auto made = AveragerRegistry::WithBuiltIns().Make(request);
            return made ? std::string() : made.error().message;
          },
          "NAME[:key=value,...]"))
      .ShowDefault();
  SetFooter(command, AveragerRegistry::WithBuiltIns().Describe());
}

Option AddStrategiesFlag(CLI::App* command,
                         std::vector<std::string>* strategies) {
  SetFooter(command, AveragerRegistry::WithBuiltIns().Describe());
  return AddOption(
             command, "--strategies",
             [strategies](const std::vector<std::string>& lists) {
               strategies->clear();
               for (const std::string& list : lists) {
                 for (std::string& request : SplitRequests(list)) {
                   strategies->push_back(std::move(request));
                 }
               }
             },
             "Strategies, separated by commas (those before key=value belong "
             "to "
             "one strategy); all: every one that is listed below")
      .ShowType("NAME[:key=value,...],...");
}

void AddSolveFlags(CLI::App* command, SolveFlags* flags) {
  AddScaleFlags(command, &flags->scale);
  AddStrategyFlag(command, &flags->strategy);
  AddAdjustFlags(command, flags);
  AddRefinementFlag(command, &flags->refine_intrinsics)
      .Excludes(FindOption(command, "--no-adjust"));
  AddTruthFlag(command, &flags->ground_truth);
}

void AddAdjustFlags(CLI::App* command, SolveFlags* flags) {
  AddOption(command, "--adjust-features", flags->adjust_features,
            "Kinds in the bundle adjustment, separated by commas")
      .SeparatedBy(',')
      .ShowDefault();
  AddCoplanarTiesFlag(command, &flags->coplanar_ties);
  AddDirectionsFlag(command, &flags->directions);
  AddPrincipalPointFlag(command, &flags->principal_point_stddev);
  Option no_adjust = AddFlag(command, "--no-adjust", flags->no_adjust,
                             "Stop before the bundle adjustment");
  for (const std::string& of_adjustment : OptionsOfAdjustment()) {
    no_adjust.Excludes(FindOption(command, of_adjustment));
  }
}

void AddStrictFlag(CLI::App* command, bool* strict) {
  AddFlag(command, "--strict", *strict,
          "Exit code 2 if a camera is not graded firm; the results are "
          "written all the same");
}

Option AddRefinementFlag(CLI::App* command, std::string* parts) {
  return AddOption(command, kRefinementFlag, *parts,
                   "Free these parts of every intrinsic in the bundle "
                   "adjustment, and hold the rest: a list of focal, aspect "
                   "(fy / fx), principal-point, distortion (of a pinhole: "
                   "k1), or all; without a list, or before the name of a "
                   "file: focal,distortion. Without this flag all is held, and "
                   "said if the images contradict it")
      .ValueIsOptional()
      .ShowDefault(kRefinedWithoutList);
}

std::vector<std::string> WithRefinedParts(std::vector<std::string> arguments) {
  for (std::size_t n = 0; n + 1 < arguments.size(); ++n) {
    std::error_code ignored;
    if (arguments[n] == kRefinementFlag && !ParseRefinement(arguments[n + 1]) &&
        std::filesystem::exists(arguments[n + 1], ignored)) {
      arguments[n] += std::string("=") + kRefinedWithoutList;
    }
  }
  return arguments;
}

Status SetRefinement(const std::string& parts, Scene* scene,
                     AdjustmentOptions* options) {
  LOWLAP_ASSIGN_OR_RETURN(const auto refinement, ParseRefinement(parts));
  RefineAllIntrinsics(refinement, scene, options);
  return {};
}

void PrintAdjustment(const Scene& scene, const AdjustmentOptions& options,
                     const AdjustmentSummary& summary) {
  if (!options.refine_intrinsics.empty()) {
    IntrinsicRefinement refined = options.refine_intrinsics.begin()->second;
    refined.principal_point |= options.principal_point_stddev > 0;
    const std::string held = DescribeParts(Others(refined));
    std::printf("intrinsics: %s refined, %s held\n",
                DescribeParts(refined).c_str(),
                held.empty() ? "nothing" : held.c_str());
  }
  for (const std::string& line : DescribeIntrinsicChanges(scene)) {
    std::printf("%s\n", line.c_str());
  }
  for (const std::string& line : DescribeCalibrationPreferences(summary)) {
    std::printf("note: %s\n", line.c_str());
  }
  for (const std::string& line : DescribeRivals(scene, summary)) {
    std::printf("note: %s\n", line.c_str());
  }
}

Result<SolveOptions> MakeSolveOptions(const SolveFlags& flags) {
  LOWLAP_RETURN_IF_ERROR(ParseRefinement(flags.refine_intrinsics));
  SolveOptions options;
  LOWLAP_ASSIGN_OR_RETURN(const auto scale, MakeScaleOptions(flags.scale));
  options.scale_estimator = MakeScaleEstimator(scale);
  LOWLAP_ASSIGN_OR_RETURN(
      options.poses.averager,
      AveragerRegistry::WithBuiltIns().Make(flags.strategy));
  LOWLAP_RETURN_IF_ERROR(ChooseAdjustment(flags.adjust_features,
                                          flags.coplanar_ties, flags.directions,
                                          &options.adjustment));
  options.adjustment.principal_point_stddev = flags.principal_point_stddev;
  options.adjust = !flags.no_adjust;
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  return options;
}

Result<FirstSolution> MakeFirstSolution(const SolveFlags& flags) {
  FirstSolution first;
  LOWLAP_ASSIGN_OR_RETURN(first.solve, MakeSolveOptions(flags));
  LOWLAP_ASSIGN_OR_RETURN(first.refinement,
                          ParseRefinement(flags.refine_intrinsics));
  return first;
}

OutputPlace OutputPlaceOf(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored) ||
      !FindSceneFormat(AllSceneFormats(), path)) {
    return {path};
  }
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return {folder.empty() ? "." : folder, path};
}

Result<int> SolveAndWrite(Scene scene, const SolveFlags& flags,
                          RunSummary summary, StageLog* stages,
                          const RunContext& context, const std::string& input,
                          const OutputPlace& output, const Solver& solver) {
  LOWLAP_ASSIGN_OR_RETURN(auto options, MakeSolveOptions(flags));
  LOWLAP_ASSIGN_OR_RETURN(const auto truth,
                          LoadGroundTruth(flags.ground_truth, scene));
  LOWLAP_RETURN_IF_ERROR(
      SetRefinement(flags.refine_intrinsics, &scene, &options.adjustment));
  WarnOfIdleTies(flags.coplanar_ties, flags.directions, options.adjustment,
                 context);

  auto result = solver(&scene, options, context, stages);
  if (!result) {
    if (result.error().file.empty()) result.error().file = input;
    return tl::unexpected<Error>(result.error());
  }
  if (truth) {
    if (result->adjustment) {
      summary.evaluation_before_adjustment =
          EvaluatePoses(scene.views, result->poses_before_adjustment, *truth);
    }
    summary.evaluation = EvaluatePoses(scene, *truth);
    summary.truth = *truth;
  }
  summary.kinds = options.scale_estimator->kinds();
  summary.solve = std::move(*result);
  summary.stages = stages->stages();
  if (IsInterrupted()) return MakeError(ErrorCode::kCancelled, {});
  // A set of its own: a format that cannot hold the scene costs none of the
  // other results; a full disk all of them.
  FileSet scene_file;
  Result<SceneNotes> notes = SceneNotes();
  const auto prepare_scene_file = [&](const Scene& solved) -> Status {
    if (output.scene_file.empty()) return {};
    notes = WriteScene(solved, output.scene_file, {}, &scene_file);
    if (notes || notes.error().code != ErrorCode::kIo) return {};
    return tl::unexpected<Error>(notes.error());
  };
  LOWLAP_RETURN_IF_ERROR(
      WriteOutputs(scene, summary, context, output.folder, prepare_scene_file));

  PrintPoses(summary.solve->poses, scene);
  if (summary.solve->adjustment) {
    PrintAdjustment(scene, options.adjustment, *summary.solve->adjustment);
  }
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
      output.folder.c_str());
  if (!output.scene_file.empty()) {
    LOWLAP_RETURN_IF_ERROR(notes);
    LOWLAP_RETURN_IF_ERROR(scene_file.Commit());
    for (const std::string& note : *notes) {
      context.Log(LogLevel::kWarning, note);
    }
    std::printf("and the scene to %s\n", output.scene_file.c_str());
  }
  const PoseSummary& poses = summary.solve->poses;
  if (poses.num_placed == 0) {
    return MakeError(ErrorCode::kInsufficientData,
                     "no camera is placed; report.html says what is missing",
                     input);
  }
  return flags.strict && CountFirm(poses) < poses.num_views ? kNotFirm : 0;
}

}  // namespace lowlap::cli
