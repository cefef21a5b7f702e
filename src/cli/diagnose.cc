#include <cstdio>
#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/diagnosis_output.h"
#include "lowlap/pipeline/internal/scene_in_use.h"

namespace lowlap::cli {
namespace {

struct DiagnoseFlags {
  CommonFlags common;
  SceneInputFlags input;
  ScaleFlags scale;
  DiagnosisOptions diagnosis;
  std::string json;
  bool strict = false;
};

Result<int> RunDiagnose(const DiagnoseFlags& flags) {
  LOWLAP_RETURN_IF_ERROR(CheckDistinct({{"the scene", flags.input.scene}},
                                       {{"--json", flags.json}}));
  const RunContext context = MakeContext(flags.common);
  LOWLAP_ASSIGN_OR_RETURN(const auto options, MakeScaleOptions(flags.scale));
  LOWLAP_RETURN_IF_ERROR(flags.diagnosis.Validate());
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(auto loaded,
                          LoadMeasuredScene(flags.input, context, &stages));
  SolveOptions solve;
  solve.scale_estimator = MakeScaleEstimator(options);
  LOWLAP_ASSIGN_OR_RETURN(const Scene scene,
                          SceneInUse(std::move(loaded.scene), solve, context));
  LOWLAP_ASSIGN_OR_RETURN(const auto diagnosis,
                          Diagnose(scene, flags.diagnosis));
  if (!flags.json.empty()) {
    LOWLAP_RETURN_IF_ERROR(
        WriteFileAtomically(flags.json, ToJson(diagnosis, scene) + "\n"));
  }
  std::printf("%s", ToText(diagnosis, scene).c_str());
  return flags.strict && !diagnosis.IsFirm() ? kNotFirm : 0;
}

}  // namespace

void AddDiagnose(CLI::App* program, Action* action) {
  auto flags = std::make_shared<DiagnoseFlags>();
  CLI::App* command = AddCommand(
      program, "diagnose",
      "Say which views share one scale and through what, which float or hang "
      "on one camera or on weak ratios, and what kind of photograph would mend "
      "it");
  AddSceneInputFlags(command, &flags->input);
  AddScaleFlags(command, &flags->scale);
  AddOption(command, "--min-inliers", flags->diagnosis.min_inliers,
            "A ratio with fewer inliers is weak")
      .Must(Check::NonNegative())
      .ShowDefault();
  AddOption(command, "--max-log10-nfa", flags->diagnosis.max_log10_nfa,
            "A ratio with more false alarms is weak")
      .ShowDefault();
  AddOption(command, "--max-stddev", flags->diagnosis.max_stddev,
            "A ratio whose logarithm has a larger deviation is weak")
      .Must(Check::Positive())
      .ShowDefault();
  AddOption(command, "--json", flags->json, "Also write the diagnosis as JSON");
  AddFlag(command, "--strict", flags->strict,
          "Exit code 2 unless all views hang together firmly: one "
          "scale, without weak ratios");
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, RunDiagnose, action);
}

}  // namespace lowlap::cli
