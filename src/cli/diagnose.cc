#include <cstdio>
#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/scene_input.h"
#include "cli/solve_flags.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/pipeline/internal/output/diagnosis_output.h"
#include "lowlap/scale/scale_ratios.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  SceneInputFlags input;
  ScaleFlags scale;
  DiagnosisOptions diagnosis;
  std::string json;
  bool strict = false;
};

int RunDiagnose(const Flags& flags) {
  const RunContext context = MakeContext(flags.common);
  const auto options = MakeScaleOptions(flags.scale);
  if (!options) return Fail(options.error());
  if (const Status valid = flags.diagnosis.Validate(); !valid) {
    return Fail(valid.error());
  }
  StageLog stages;
  auto loaded = LoadMeasuredScene(flags.input, context, &stages);
  if (!loaded) return Fail(loaded.error());
  Scene scene = std::move(loaded->scene);
  if (scene.scale_ratios.empty()) {
    auto ratios = EstimateScaleRatios(scene, *options, context);
    if (!ratios) return Fail(ratios.error());
    scene.scale_ratios = std::move(*ratios);
  }
  const auto diagnosis = Diagnose(scene, flags.diagnosis);
  if (!diagnosis) return Fail(diagnosis.error());
  if (!flags.json.empty()) {
    const Status written =
        WriteFileAtomically(flags.json, ToJson(*diagnosis, scene) + "\n");
    if (!written) return Fail(written.error());
  }
  std::printf("%s", ToText(*diagnosis, scene).c_str());
  return flags.strict && !diagnosis->IsFirm() ? kNotFirm : 0;
}

}  // namespace

void AddDiagnose(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = AddCommand(
      program, "diagnose",
      "Say before anything is solved which views share one scale and through "
      "what, which float or hang on one camera or on weak ratios, and what "
      "kind of photograph would mend it");
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
  WhenChosen(command, [flags, action] {
    *action = [flags] { return RunDiagnose(*flags); };
  });
}

}  // namespace lowlap::cli
