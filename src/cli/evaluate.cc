#include <cstdio>
#include <memory>
#include <ostream>

#include "cli/command.h"
#include "cli/solve_flags.h"
#include "lowlap/core/atomic_file.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct Flags {
  std::string solution;
  std::string ground_truth;
  bool json = false;
};

int Evaluate(const Flags& flags) {
  const auto scene = ReadScene(flags.solution);
  if (!scene) return Fail(scene.error());
  const auto truth = LoadGroundTruth(flags.ground_truth, *scene);
  if (!truth) return Fail(truth.error());
  const PoseEvaluation evaluation = EvaluatePoses(*scene, **truth);
  std::printf("%s\n",
              (flags.json ? ToJson(evaluation) : ToText(evaluation)).c_str());
  return 0;
}

}  // namespace

void AddEvaluate(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = program->add_subcommand(
      "evaluate",
      "Compare solved cameras with true ones, after a similarity "
      "alignment of the centres");
  command->add_option("solution", flags->solution, "Solved scene file")
      ->required();
  command
      ->add_option("ground_truth", flags->ground_truth,
                   "Folder of Strecha's .camera files, or the one that holds "
                   "it as gt_dense_cameras; or a scene file with true poses")
      ->required();
  command->add_flag("--json", flags->json, "Print JSON instead of a table");
  command->callback(
      [flags, action] { *action = [flags] { return Evaluate(*flags); }; });
}

}  // namespace lowlap::cli
