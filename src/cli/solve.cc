#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

// Values of OpenMVG's flags, by their letters; empty: not given.
struct HostFlags {
  std::map<char, std::string> values;
  // lowlap's own that have no effect with -e NONE, by name.
  std::vector<std::pair<std::string, Option>> of_adjustment;
  bool priors = false;
};

struct SolveCommandFlags {
  CommonFlags common;
  SceneInputFlags input;
  std::string output;
  SolveFlags solve;
  HostFlags host;
};

// What says nothing to lowlap is ignored, with the reason. Of these OpenMVG's
// GLOBAL engine reads -R alone.
struct IgnoredFlag {
  const char* names;
  const char* reason;
};
constexpr IgnoredFlag kIgnored[] = {
    {"-R,--rotationAveraging",
     "GLOBAL's choice between L1 and L2; rotations are averaged robustly, by "
     "one method"},
    {"-t,--triangulation_method", "it is of INCREMENTAL"},
    {"-r,--resection_method", "it is of INCREMENTAL"},
    {"-c,--camera_model", "it is of INCREMENTAL"},
    {"-a,--initial_pair_a", "it is of INCREMENTAL"},
    {"-b,--initial_pair_b", "it is of INCREMENTAL"},
    {"-S,--sfm_initializer", "it is of INCREMENTALV2"},
    {"-G,--graph_simplification", "it is of STELLAR"},
    {"-g,--graph_simplification_value", "it is of STELLAR"}};

// OpenMVG's translation methods as lowlap's strategies.
const std::map<std::string, std::string>& StrategyOfMethod() {
  static const std::map<std::string, std::string> strategies = {
      {"1", "linf"}, {"2", "l2_chordal"}, {"3", "soft_l1"}};
  return strategies;
}

// What -f asks for, as --refine-intrinsics takes it; nullopt: nothing known.
std::optional<std::string> PartsToRefine(const std::string& host_parts) {
  static const std::map<std::string, std::string> kParts = {
      {"ADJUST_ALL", "focal,principal-point,distortion,"},
      {"ADJUST_FOCAL_LENGTH", "focal,"},
      {"ADJUST_PRINCIPAL_POINT", "principal-point,"},
      {"ADJUST_DISTORTION", "distortion,"},
      {"NONE", ""}};
  std::string parts;
  std::istringstream list(host_parts);
  for (std::string part; std::getline(list, part, '|');) {
    const auto known = kParts.find(part);
    if (known == kParts.end()) return std::nullopt;
    parts += known->second;
  }
  return parts;
}

// Flags of openMVG_main_SfM that are not lowlap's own.
void AddHostFlags(CLI::App* command, HostFlags* host) {
  AddOption(command, "-s,--sfm_engine", host->values['s'],
            "As in OpenMVG; lowlap takes the place of GLOBAL")
      .Must(Check(
          [](const std::string& engine) {
            return engine == "GLOBAL" ? std::string()
                                      : "lowlap takes the place of GLOBAL, "
                                        "not of " +
                                            engine;
          },
          "GLOBAL"));
  AddOption(command, "-f,--refine_intrinsic_config", host->values['f'],
            "--refine-intrinsics in OpenMVG's words: NONE (default, unlike "
            "OpenMVG's), ADJUST_ALL, or some of "
            "ADJUST_FOCAL_LENGTH|ADJUST_PRINCIPAL_POINT|ADJUST_DISTORTION")
      .Must(Check(
          [](const std::string& parts) {
            return PartsToRefine(parts)
                       ? std::string()
                       : "'" + parts + "' names no parts of an intrinsic";
          },
          "PARTS"))
      .Excludes(FindOption(command, "--refine-intrinsics"));
  AddOption(command, "-e,--refine_extrinsic_config", host->values['e'],
            "As in OpenMVG: ADJUST_ALL (default), or NONE: --no-adjust")
      .Must(Check::OneOf({"ADJUST_ALL", "NONE"}));
  for (const std::string& name : OptionsOfAdjustment()) {
    host->of_adjustment.emplace_back(
        name == "--directions" ? "--[no-]directions" : name,
        FindOption(command, name));
  }
  AddOption(command, "-T,--translationAveraging", host->values['T'],
            "--strategy by OpenMVG's number: 1 is linf, 2 l2_chordal, 3 "
            "soft_l1; lowlap's own is the default")
      .Must(Check(
          [](const std::string& method) {
            return StrategyOfMethod().count(method) > 0
                       ? std::string()
                       : "lowlap has the methods 1, 2 and 3, not " + method;
          },
          "NUMBER"))
      .Excludes(FindOption(command, "--strategy"));
  AddFlag(command, "-P,--prior_usage", host->priors,
          "Refused: lowlap does not use measured positions (GPS)");
  for (const IgnoredFlag& flag : kIgnored) {
    AddOption(command, flag.names, host->values[flag.names[1]],
              std::string("Ignored: ") + flag.reason);
  }
}

// What the flags of OpenMVG mean in lowlap's.
Result<SolveFlags> WithHostFlags(SolveFlags solve, const HostFlags& host,
                                 const RunContext& context) {
  if (host.priors) {
    return MakeError(ErrorCode::kUnsupported,
                     "-P: lowlap does not use measured positions (GPS); "
                     "without it the scene has a frame and scale of its own");
  }
  const auto value = [&](char letter) { return host.values.at(letter); };
  if (!value('f').empty()) {
    solve.refine_intrinsics = *PartsToRefine(value('f'));
  }
  if (!value('T').empty()) solve.strategy = StrategyOfMethod().at(value('T'));
  solve.no_adjust |= value('e') == "NONE";
  if (solve.no_adjust && !solve.refine_intrinsics.empty()) {
    return MakeError(
        ErrorCode::kInvalidArgument,
        std::string(value('f').empty() ? "--refine-intrinsics" : "-f") +
            ": the bundle adjustment, which --no-adjust (-e NONE) leaves out, "
            "refines intrinsics");
  }
  for (const auto& [name, option] : host.of_adjustment) {
    if (solve.no_adjust && option.IsGiven()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       name +
                           " has no effect with -e NONE, which leaves the "
                           "bundle adjustment out");
    }
  }
  for (const IgnoredFlag& flag : kIgnored) {
    if (value(flag.names[1]).empty()) continue;
    context.Log(LogLevel::kWarning, std::string(flag.names).substr(0, 2) +
                                        " is ignored: " + flag.reason);
  }
  return solve;
}

Result<int> Solve(const SolveCommandFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  LOWLAP_ASSIGN_OR_RETURN(const SolveFlags solve,
                          WithHostFlags(flags.solve, flags.host, context));
  LOWLAP_RETURN_IF_ERROR(MakeSolveOptions(solve));
  // What cannot be written, or evaluated, is found before the work.
  const OutputPlace output = OutputPlaceOf(flags.output);
  LOWLAP_RETURN_IF_ERROR(CheckInputsStay(InputFiles(flags.input), output.folder,
                                         output.scene_file));
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(output.folder));
  if (!output.scene_file.empty()) {
    LOWLAP_RETURN_IF_ERROR(CheckScenePlace(output.scene_file));
  }
  const auto check = [&](const Scene& views) -> Status {
    LOWLAP_RETURN_IF_ERROR(LoadGroundTruth(solve.ground_truth, views));
    return {};
  };
  StageLog stages;
  RunSummary summary;
  summary.command = "solve";
  LOWLAP_ASSIGN_OR_RETURN(
      auto loaded,
      LoadSceneToSolve(flags.input, solve, context, &stages, check));
  summary.pairs = std::move(loaded.pairs);
  return SolveAndWrite(std::move(loaded.scene), solve, std::move(summary),
                       &stages, context, flags.input.scene, output);
}

}  // namespace

void AddSolve(CLI::App* program, Action* action) {
  auto flags = std::make_shared<SolveCommandFlags>();
  CLI::App* command = AddCommand(
      program, "solve",
      "Solve a scene description (ours, an OpenMVG project, or a COLMAP "
      "database): scale ratios, poses, bundle adjustment");
  AddSceneInputFlags(command, &flags->input);
  AddOption(command, "-o,--output,--outdir,--output_dir", flags->output,
            "Folder for the results; or a scene file in it, which the solved "
            "scene is written to in the format of its extension "
            "(OUT/sfm_data.bin for OpenMVG)")
      .Required();
  AddSolveFlags(command, &flags->solve);
  AddHostFlags(command, &flags->host);
  AddStrictFlag(command, &flags->solve.strict);
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Solve, action);
}

}  // namespace lowlap::cli
