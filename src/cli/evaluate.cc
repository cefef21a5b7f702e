#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/flags/truth.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/evaluation/internal/line_match_errors.h"
#include "lowlap/evaluation/internal/pair_errors.h"
#include "lowlap/matching/internal/pair_selection.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct EvaluateFlags {
  std::string solution;
  std::string ground_truth;
  std::string truth_option;  // --gt, the same as an option
  bool relative_poses = false;
  std::vector<std::string> expected_pairs;
  std::string true_edges;  // --gt-lines
  std::string line_pairs = "cycle";
  bool json = false;
};

Result<std::vector<ViewPair>> ParsePairs(
    const std::vector<std::string>& names) {
  std::vector<ViewPair> pairs;
  for (const std::string& name : names) {
    unsigned first = 0, second = 0;
    int length = 0;
    if (std::sscanf(name.c_str(), "%9u-%9u%n", &first, &second, &length) != 2 ||
        static_cast<std::size_t>(length) != name.size()) {
      return MakeError(
          ErrorCode::kInvalidArgument,
          "--expect: '" + name + "' is not a pair of view ids, as in 3-4");
    }
    pairs.push_back({std::min(first, second), std::max(first, second)});
  }
  return pairs;
}

Result<int> EvaluateMeasurements(const EvaluateFlags& flags, const Scene& scene,
                                 const GroundTruth& truth) {
  if (scene.relative_poses.empty()) {
    return MakeError(ErrorCode::kInvalidScene,
                     "holds no relative poses to judge", flags.solution);
  }
  PairEvaluationOptions options;
  LOWLAP_ASSIGN_OR_RETURN(options.expected, ParsePairs(flags.expected_pairs));
  LOWLAP_ASSIGN_OR_RETURN(const auto evaluation,
                          EvaluatePairs(scene, truth, options));
  std::printf("%s\n",
              (flags.json ? ToJson(evaluation) : ToText(evaluation)).c_str());
  return 0;
}

Result<int> EvaluateLines(const EvaluateFlags& flags, const Scene& scene,
                          const GroundTruth& truth) {
  LOWLAP_ASSIGN_OR_RETURN(const auto edges, ReadTrueEdges(flags.true_edges));
  LOWLAP_ASSIGN_OR_RETURN(const auto pairs,
                          SelectViewPairs(scene, flags.line_pairs));
  LOWLAP_ASSIGN_OR_RETURN(const auto evaluation,
                          EvaluateLineMatches(scene, truth, edges, pairs, {}));
  std::printf("%s\n",
              (flags.json ? ToJson(evaluation) : ToText(evaluation)).c_str());
  return 0;
}

Result<int> Evaluate(const EvaluateFlags& flags) {
  LOWLAP_ASSIGN_OR_RETURN(const auto scene, ReadScene(flags.solution));
  const auto truth = LoadGroundTruth(
      flags.ground_truth.empty() ? flags.truth_option : flags.ground_truth,
      scene);
  if (!truth) return tl::unexpected<Error>(truth.error());
  if (!*truth) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the true cameras are missing: second argument, or --gt",
                     "", "evaluate");
  }
  if (!flags.true_edges.empty()) return EvaluateLines(flags, scene, **truth);
  if (flags.relative_poses) {
    return EvaluateMeasurements(flags, scene, **truth);
  }
  const PoseEvaluation evaluation = EvaluatePoses(scene, **truth);
  if (evaluation.scope == EvaluationScope::kNothing) {
    return MakeError(ErrorCode::kInsufficientData, evaluation.note,
                     flags.solution);
  }
  std::printf("%s\n",
              (flags.json ? ToJson(evaluation) : ToText(evaluation)).c_str());
  return 0;
}

}  // namespace

void AddEvaluate(CLI::App* program, Action* action) {
  auto flags = std::make_shared<EvaluateFlags>();
  CLI::App* command =
      AddCommand(program, "evaluate",
                 "Compare solved cameras with true ones, after a similarity "
                 "alignment of the centres");
  AddOption(command, "solution", flags->solution, "Solved scene file")
      .Required();
  Option positional = AddOption(
      command, "ground_truth", flags->ground_truth,
      "Folder of Strecha's .camera files, or the one that holds it as "
      "gt_dense_cameras; or a scene or model of any format");
  AddOption(command, "--gt", flags->truth_option,
            "The same, as an option: instead of the second argument")
      .Excludes(positional);
  Option relative_poses = AddFlag(
      command, "--relative-poses", flags->relative_poses,
      "Judge the relative poses of the pairs instead of the cameras: rotation "
      "and direction errors, failures among consecutive and among all pairs");
  AddOption(command, "--expect", flags->expected_pairs,
            "Pairs of view ids that must have a relative pose, as in "
            "0-1,1-2 (with --relative-poses; consecutive views always)")
      .SeparatedBy(',')
      .Needs(relative_poses);
  Option lines = AddOption(
      command, "--gt-lines", flags->true_edges,
      "Judge the line matches of the pairs instead, by the true edges of this "
      "file. Right: both segments lie on one edge (within 2.5 degrees and 2.5 "
      "px, half of the shorter shared). Wrong: they lie on different edges, or "
      "one on an edge that the other image shows elsewhere. Else unknown. "
      "Recall: share of the edges shown by both images that have a right "
      "match");
  lines.Excludes(relative_poses);
  AddOption(command, "--line-pairs", flags->line_pairs,
            "With --gt-lines, the pairs to count: all, chain, cycle, "
            "window:N or a file, as for run; one without a relative "
            "pose has a recall of 0")
      .Needs(lines)
      .ShowDefault();
  AddFlag(command, "--json", flags->json, "Print JSON instead of a table");
  RunWhenChosen(command, flags, Evaluate, action);
}

}  // namespace lowlap::cli
