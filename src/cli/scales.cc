#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/evaluation/internal/relative_errors.h"
#include "lowlap/pipeline/internal/output/ratio_table.h"
#include "lowlap/pipeline/internal/output/summary_json.h"
#include "lowlap/scale/internal/search/ratio_profile.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap::cli {
namespace {

struct ScalesFlags {
  CommonFlags common;
  SceneInputFlags input;
  ScaleFlags scale;
  std::string json;
  std::string ground_truth;
  std::string profile;
};

// One line per ratio of the grid, mode, second mode and end of the interval.
std::string ProfileCsv(const std::vector<RatioProfile>& profiles) {
  std::vector<ScaleRatio> ratios;
  ratios.reserve(profiles.size());
  for (const RatioProfile& profile : profiles) ratios.push_back(profile.ratio);
  const std::vector<std::string> kinds = KindNames(ratios);
  std::ostringstream out;
  out.precision(9);
  out << "first,middle,last,what,log_ratio,log10_nfa";
  for (const std::string& kind : kinds) out << ',' << kind;
  out << '\n';
  for (const RatioProfile& profile : profiles) {
    const auto start = [&](const char* what, double log_ratio) {
      const ViewTriplet& views = profile.ratio.views;
      out << views.first << ',' << views.middle << ',' << views.last << ','
          << what << ',' << log_ratio << ',';
    };
    const auto write = [&](const char* what, const RatioOptimum& optimum) {
      start(what, optimum.log_ratio);
      out << optimum.nfa.log10_nfa;
      for (const std::string& kind : kinds) {
        double log10_nfa = 0;
        for (std::size_t k = 0; k < profile.kinds.size(); ++k) {
          if (profile.kinds[k] == kind) {
            log10_nfa = optimum.nfa.kinds[k].log10_nfa;
          }
        }
        out << ',' << log10_nfa;
      }
      out << '\n';
    };
    if (profile.nodes.empty()) continue;
    const ScaleRatio& ratio = profile.ratio;
    write("mode", profile.mode);
    if (profile.second_mode) write("second mode", *profile.second_mode);
    const std::string empty(kinds.size(), ',');
    start("interval low", ratio.IntervalLow());
    out << empty << '\n';
    start("interval high", ratio.IntervalHigh());
    out << empty << '\n';
    // Shares of the information in the columns of the kinds.
    start("information", ratio.log_ratio);
    for (const std::string& kind : kinds) {
      const KindSupport* support = ratio.FindKind(kind);
      out << ',' << (support == nullptr ? 0 : support->information_share);
    }
    out << '\n';
    for (const RatioOptimum& node : profile.nodes) write("node", node);
  }
  return out.str();
}

void PrintTable(const std::vector<ScaleRatio>& ratios) {
  const RatioTable table = MakeRatioTable(ratios);
  std::vector<std::vector<std::string>> rows = {table.columns};
  rows.front().insert(rows.front().begin(), "views");
  for (std::size_t n = 0; n < ratios.size(); ++n) {
    rows.push_back(table.rows[n]);
    rows.back().insert(rows.back().begin(),
                       std::to_string(ratios[n].views.first.value()) + "-" +
                           std::to_string(ratios[n].views.middle.value()) +
                           "-" + std::to_string(ratios[n].views.last.value()));
  }
  std::vector<int> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t n = 0; n < row.size(); ++n) {
      widths[n] = std::max(widths[n], static_cast<int>(row[n].size()));
    }
  }
  for (const auto& row : rows) {
    std::printf("%-*s", widths.front(), row.front().c_str());
    for (std::size_t n = 1; n + 1 < row.size(); ++n) {
      std::printf("  %*s", widths[n], row[n].c_str());
    }
    std::printf("  %s\n", row.back().c_str());
  }
}

Result<int> Scales(const ScalesFlags& flags) {
  LOWLAP_RETURN_IF_ERROR(
      CheckDistinct({{"the scene", flags.input.scene}},
                    {{"--json", flags.json}, {"--profile", flags.profile}}));
  const RunContext context = MakeContext(flags.common);
  LOWLAP_ASSIGN_OR_RETURN(const auto options, MakeScaleOptions(flags.scale));
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(auto loaded,
                          LoadMeasuredScene(flags.input, context, &stages));
  LOWLAP_ASSIGN_OR_RETURN(const auto truth,
                          LoadGroundTruth(flags.ground_truth, loaded.scene));
  LOWLAP_ASSIGN_OR_RETURN(const auto ratios,
                          EstimateScaleRatios(loaded.scene, options, context));
  FileSet files;
  if (!flags.json.empty()) {
    LOWLAP_RETURN_IF_ERROR(files.Add(flags.json, ToJson(ratios) + "\n"));
  }
  if (!flags.profile.empty()) {
    LOWLAP_ASSIGN_OR_RETURN(
        const auto profiles,
        ProfileScaleRatios(loaded.scene, FindTriplets(ViewGraph(loaded.scene)),
                           MakeScaleEstimator(options)->kinds(), context));
    LOWLAP_RETURN_IF_ERROR(files.Add(flags.profile, ProfileCsv(profiles)));
  }
  LOWLAP_RETURN_IF_ERROR(files.Commit());
  PrintTable(ratios);
  if (truth) {
    loaded.scene.scale_ratios = ratios;
    std::printf("\n%s\n",
                ToText(EvaluateRelativePoses(loaded.scene, *truth)).c_str());
    std::printf("\n%s\n",
                ToText(EvaluateScaleRatios(loaded.scene, *truth)).c_str());
  }
  return 0;
}

}  // namespace

void AddScales(CLI::App* program, Action* action) {
  auto flags = std::make_shared<ScalesFlags>();
  CLI::App* command =
      AddCommand(program, "scales",
                 "Show the relative scale of every two relative poses that "
                 "share a view");
  AddSceneInputFlags(command, &flags->input);
  AddScaleFlags(command, &flags->scale);
  AddOption(command, "--json", flags->json, "Also write the table as JSON");
  AddOption(command, "--profile", flags->profile,
            "Also write the NFA as a function of the ratio, its "
            "modes and 95 % intervals as CSV");
  AddOption(command, "--gt", flags->ground_truth,
            "True cameras to compare with (folder or scene file)");
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Scales, action);
}

}  // namespace lowlap::cli
