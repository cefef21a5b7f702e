#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/measure/calibration_fit.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct AdjustFlags {
  CommonFlags common;
  std::string scene;
  std::string output;
  std::vector<std::string> features = {"points", "lines", "coplanar"};
  std::optional<std::string> coplanar_ties;
  std::optional<bool> directions;
  bool retriangulate = false;
  std::string refine_intrinsics;
  double principal_point_stddev = AdjustmentOptions{}.principal_point_stddev;
  std::string ground_truth;
};

Result<int> Adjust(const AdjustFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  AdjustmentOptions options;
  LOWLAP_RETURN_IF_ERROR(ChooseAdjustment(flags.features, flags.coplanar_ties,
                                          flags.directions, &options));
  options.principal_point_stddev = flags.principal_point_stddev;
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  // What cannot be written is found before the work.
  LOWLAP_RETURN_IF_ERROR(
      CheckInputsStay({{"the scene", flags.scene}}, flags.output));
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  LOWLAP_ASSIGN_OR_RETURN(auto scene, ReadScene(flags.scene));
  if (scene.poses.empty()) {
    return MakeError(ErrorCode::kInvalidScene,
                     "holds no poses to adjust; 'lowlap solve' finds them",
                     flags.scene);
  }
  RestoreGivenIntrinsics(&scene);
  if (const auto warning = ImplausibleFocals(scene)) {
    context.Log(LogLevel::kWarning, *warning);
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto truth,
                          LoadGroundTruth(flags.ground_truth, scene));
  RunSummary summary;
  summary.command = "adjust";
  summary.has_given_poses = true;
  if (truth) {
    summary.evaluation_before_adjustment = EvaluatePoses(scene, *truth);
  }
  LOWLAP_RETURN_IF_ERROR(
      SetRefinement(flags.refine_intrinsics, &scene, &options));
  WarnOfIdleTies(flags.coplanar_ties, flags.directions, options, context);
  StageLog stages;
  SolveResult result;
  if (flags.retriangulate ||
      (scene.structure.empty() && scene.line_structure.empty())) {
    const StageLog::Scope scope(&stages, "structure");
    LOWLAP_ASSIGN_OR_RETURN(
        result.structure, BuildStructure(&scene, StructureOptions{}, context));
  }
  result.poses_before_adjustment = scene.poses;
  result.structure_before_adjustment = PositionsOf(scene);
  {
    const StageLog::Scope scope(&stages, "adjustment");
    auto adjustment = AdjustScene(&scene, options, context);
    if (!adjustment) {
      if (adjustment.error().file.empty()) {
        adjustment.error().file = flags.scene;
      }
      return tl::unexpected<Error>(adjustment.error());
    }
    result.adjustment = std::move(*adjustment);
  }
  if (truth) {
    summary.evaluation = EvaluatePoses(scene, *truth);
    summary.truth = *truth;
  }
  result.ratios = SummarizeRatios(scene.scale_ratios);
  result.poses.num_views = static_cast<int>(scene.views.size());
  for (const auto& entry : scene.views) {
    if (scene.FindPose(entry.first) != nullptr) {
      ++result.poses.num_placed;
    } else {
      result.poses.unplaced.push_back(entry.first);
    }
  }
  summary.solve = std::move(result);
  summary.stages = stages.stages();
  LOWLAP_RETURN_IF_ERROR(WriteOutputs(scene, summary, context, flags.output));
  const AdjustmentSummary& adjustment = *summary.solve->adjustment;
  std::printf("%d iterations, %d outlier rounds\n", adjustment.iterations,
              adjustment.outlier_rounds);
  PrintAdjustment(scene, options, adjustment);
  if (summary.evaluation) {
    std::printf("\n%s\n", ToText(*summary.evaluation).c_str());
  }
  return 0;
}

}  // namespace

void AddAdjust(CLI::App* program, Action* action) {
  auto flags = std::make_shared<AdjustFlags>();
  CLI::App* command = AddCommand(
      program, "adjust",
      "Bundle adjustment of a solved scene, over points, lines and "
      "coplanar line pairs; it starts from the calibration as it was given, "
      "also where the scene was adjusted to another one");
  AddOption(command, "scene", flags->scene, "Solved scene file").Required();
  AddOption(command, "-o,--output", flags->output, "Folder for the results")
      .Required();
  AddOption(command, "--adjust-features", flags->features,
            "Kinds to adjust, separated by commas: points, lines, "
            "coplanar")
      .SeparatedBy(',')
      .ShowDefault();
  AddCoplanarTiesFlag(command, &flags->coplanar_ties);
  AddDirectionsFlag(command, &flags->directions);
  AddFlag(command, "--retriangulate", flags->retriangulate,
          "Build the structure anew from the tracks first");
  AddRefinementFlag(command, &flags->refine_intrinsics);
  AddPrincipalPointFlag(command, &flags->principal_point_stddev);
  AddOption(command, "--gt", flags->ground_truth,
            "True cameras to evaluate against (folder or scene file)");
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Adjust, action);
}

}  // namespace lowlap::cli
