#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "lowlap/pipeline/output_folder.h"
#include "lowlap/pipeline/robustness_output.h"
#include "lowlap/pipeline/robustness_study.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  RobustnessOptions options;
  std::string output;
};

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += (text.empty() ? "" : ", ") + name;
  return text;
}

int StudyAndWrite(const Flags& flags) {
  if (const Status valid = flags.options.Validate(); !valid) {
    return Fail(valid.error());
  }
  if (const Status made = PrepareOutputFolder(flags.output); !made) {
    return Fail(made.error());
  }
  const auto study = StudyRobustness(flags.options, MakeContext(flags.common));
  if (!study) return Fail(study.error());
  if (const Status written = WriteRobustness(*study, flags.output); !written) {
    return Fail(written.error());
  }
  std::printf(
      "%zu scenarios, %zu simulations, %zu strategies\n"
      "written to %s: curves.csv trials.csv and plots (.svg)\n",
      study->scenarios.size(), study->trials.size(),
      study->options.strategies.size(), flags.output.c_str());
  return 0;
}

}  // namespace

void AddRobustness(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  RobustnessOptions& o = flags->options;
  CLI::App* command = program->add_subcommand(
      "robustness",
      "Breakdown curves of every strategy on simulated rooms, corridors and "
      "rings");
  command
      ->add_option("-o,--output", flags->output, "Folder for tables and plots")
      ->required();
  command
      ->add_option("--scenario", o.scenarios,
                   "What gets worse, separated by commas; all if left out: " +
                       Joined(RobustnessScenarioNames()))
      ->delimiter(',');
  command
      ->add_option("--strategies", o.strategies,
                   "Strategies, separated by commas; all if left out")
      ->delimiter(',');
  command->add_option("--seeds", o.num_seeds, "Simulations per value");
  command->add_option("--tolerance", o.tolerance,
                      "A centre is right within this share of the spread");
  command->add_option("--max-views-of-others", o.max_views_of_others,
                      "Larger graphs are left to the strategies graph and "
                      "chain");
  command->add_flag("--quick", o.quick,
                    "The room alone, few values, small graphs: a minute");
  AddCommonFlags(command, &flags->common);
  command->callback(
      [flags, action] { *action = [flags] { return StudyAndWrite(*flags); }; });
}

}  // namespace lowlap::cli
