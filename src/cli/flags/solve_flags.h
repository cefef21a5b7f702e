#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/flags/adjust_flags.h"
#include "cli/flags/command_line.h"
#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/core/result.h"
#include "lowlap/pipeline/internal/measure/relate_and_refine.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scale/evidence/evidence_registry.h"

namespace lowlap::cli {

/// Flags of the scale step, shared by run, solve and scales.
struct ScaleFlags {
  std::vector<std::string> features = EvidenceRegistry::BuiltIn().Features();
  /// By name of a kind of evidence that has a flag of its own.
  std::map<std::string, bool> asked;
  std::string criterion = "ac";
  std::string nfa = "calibrated";
  std::optional<double> threshold_px;
};

void AddScaleFlags(CLI::App* command, ScaleFlags* flags);
Result<ScaleOptions> MakeScaleOptions(const ScaleFlags& flags);

/// Flags of everything after the measurements, shared by run and solve.
struct SolveFlags {
  ScaleFlags scale;
  std::string strategy = "graph";
  std::vector<std::string> adjust_features = {"points", "lines", "coplanar"};
  std::optional<std::string> coplanar_ties;
  std::optional<bool> directions;
  bool no_adjust = false;
  std::string refine_intrinsics;
  double principal_point_stddev = AdjustmentOptions{}.principal_point_stddev;
  std::string ground_truth;
  bool strict = false;
};

void AddSolveFlags(CLI::App* command, SolveFlags* flags);
Result<SolveOptions> MakeSolveOptions(const SolveFlags& flags);
/// The same, for what is related first (RelateAndRefine).
Result<FirstSolution> MakeFirstSolution(const SolveFlags& flags);

/// --no-adjust and OptionsOfAdjustment.
void AddAdjustFlags(CLI::App* command, SolveFlags* flags);

/// --strategy, of the built-in AveragerRegistry, which the help lists.
void AddStrategyFlag(CLI::App* command, std::string* strategy);
/// --strategies, a list of them (SplitRequests).
Option AddStrategiesFlag(CLI::App* command,
                         std::vector<std::string>* strategies);

/// --refine-intrinsics [focal,aspect,principal-point,distortion|all]
Option AddRefinementFlag(CLI::App* command, std::string* parts);
/// The arguments of the program, where that flag has the parts that it stands
/// for without a list ("=focal,distortion") if the word after it is no list but
/// the name of a file: this is an argument of its own.
std::vector<std::string> WithRefinedParts(std::vector<std::string> arguments);
/// Sets the options for every intrinsic of the scene (RefineAllIntrinsics).
Status SetRefinement(const std::string& parts, Scene* scene,
                     AdjustmentOptions* options);

/// What was free and what became of it, and what the images would change of the
/// rest; nothing where all is as given and the images agree. Then the rivals of
/// the optimum.
void PrintAdjustment(const Scene& scene, const AdjustmentOptions& options,
                     const AdjustmentSummary& summary);

/// --strict, of the commands that SolveAndWrite.
void AddStrictFlag(CLI::App* command, bool* strict);

/// Where the results go.
struct OutputPlace {
  std::string folder;
  /// A file of its own for the solved scene, in the format that its extension
  /// tells; empty: none.
  std::string scene_file = {};
};

/// The folder `path`, or, if this is the name of a scene file, its folder.
OutputPlace OutputPlaceOf(const std::string& path);

using Solver = std::function<Result<SolveResult>(Scene*, const SolveOptions&,
                                                 const RunContext&, StageLog*)>;

/// Solves a measured scene, writes the output folder, prints what a person
/// wants to know, and returns the exit code: with `strict` 2 if a camera is
/// not firm. `input` is what the scene came
/// from, for messages.
Result<int> SolveAndWrite(Scene scene, const SolveFlags& flags,
                          RunSummary summary, StageLog* stages,
                          const RunContext& context, const std::string& input,
                          const OutputPlace& output,
                          const Solver& solver = SolveScene);

}  // namespace lowlap::cli
