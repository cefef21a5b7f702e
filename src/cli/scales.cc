#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/scene_input.h"
#include "cli/solve_flags.h"
#include "lowlap/core/atomic_file.h"
#include "lowlap/evaluation/relative_errors.h"
#include "lowlap/pipeline/ratio_table.h"
#include "lowlap/pipeline/summary_json.h"
#include "lowlap/scale/internal/search/ratio_profile.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  SceneInputFlags input;
  ScaleFlags scale;
  std::string json;
  std::string ground_truth;
  std::string profile;
};

// One line per ratio of the grid, mode, second mode and end of the interval.
Status WriteProfiles(const std::string& path,
                     const std::vector<RatioProfile>& profiles) {
  return WriteFileAtomically(path, [&](std::ostream& out) -> Status {
    out.precision(9);
    out << "first,middle,last,what,log_ratio,log10_nfa,points,lines,coplanar\n";
    for (const RatioProfile& profile : profiles) {
      const auto start = [&](const char* what, double log_ratio) {
        const ViewTriplet& views = profile.ratio.views;
        out << views.first << ',' << views.middle << ',' << views.last << ','
            << what << ',' << log_ratio;
      };
      const auto write = [&](const char* what, const RatioOptimum& optimum) {
        start(what, optimum.log_ratio);
        const RatioNfa& nfa = optimum.nfa;
        out << ',' << nfa.log10_nfa << ',' << nfa.points.log10_nfa << ','
            << nfa.lines.log10_nfa << ','
            << nfa.coplanar.log10_nfa + nfa.plane_points.log10_nfa << '\n';
      };
      if (profile.nodes.empty()) continue;
      write("mode", profile.mode);
      if (profile.second_mode) write("second mode", *profile.second_mode);
      start("interval low", profile.ratio.IntervalLow());
      out << ",,,,\n";
      start("interval high", profile.ratio.IntervalHigh());
      out << ",,,,\n";
      // Shares of the information in the columns of the kinds.
      const ScaleRatio& ratio = profile.ratio;
      start("information", ratio.log_ratio);
      out << ",," << ratio.points.information_share << ','
          << ratio.lines.information_share << ','
          << ratio.coplanar.information_share << '\n';
      for (const RatioOptimum& node : profile.nodes) write("node", node);
    }
    return {};
  });
}

void PrintTable(const std::vector<ScaleRatio>& ratios) {
  std::vector<std::vector<std::string>> rows = {RatioColumns()};
  rows.front().insert(rows.front().begin(), "views");
  for (const ScaleRatio& ratio : ratios) {
    rows.push_back(RatioRow(ratio));
    rows.back().insert(rows.back().begin(),
                       std::to_string(ratio.views.first) + "-" +
                           std::to_string(ratio.views.middle) + "-" +
                           std::to_string(ratio.views.last));
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

int Scales(const Flags& flags) {
  const RunContext context = MakeContext(flags.common);
  const auto options = MakeScaleOptions(flags.scale);
  if (!options) return Fail(options.error());
  StageLog stages;
  auto loaded = LoadMeasuredScene(flags.input, context, &stages);
  if (!loaded) return Fail(loaded.error());
  const auto truth = LoadGroundTruth(flags.ground_truth, loaded->scene);
  if (!truth) return Fail(truth.error());
  const auto ratios = EstimateScaleRatios(loaded->scene, *options, context);
  if (!ratios) return Fail(ratios.error());
  if (!flags.json.empty()) {
    const Status written =
        WriteFileAtomically(flags.json, [&](std::ostream& out) -> Status {
          out << ToJson(*ratios) << '\n';
          return {};
        });
    if (!written) return Fail(written.error());
  }
  if (!flags.profile.empty()) {
    const auto profiles = ProfileScaleRatios(
        loaded->scene, FindTriplets(ViewGraph(loaded->scene)), *options,
        context);
    if (!profiles) return Fail(profiles.error());
    const Status written = WriteProfiles(flags.profile, *profiles);
    if (!written) return Fail(written.error());
  }
  PrintTable(*ratios);
  if (*truth) {
    loaded->scene.scale_ratios = *ratios;
    std::printf("\n%s\n",
                ToText(EvaluateRelativePoses(loaded->scene, **truth)).c_str());
    std::printf("\n%s\n",
                ToText(EvaluateScaleRatios(loaded->scene, **truth)).c_str());
  }
  return 0;
}

}  // namespace

void AddScales(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = program->add_subcommand(
      "scales",
      "Show the relative scale of every two relative poses that "
      "share a view");
  AddSceneInputFlags(command, &flags->input);
  AddScaleFlags(command, &flags->scale);
  command->add_option("--json", flags->json, "Also write the table as JSON");
  command->add_option("--profile", flags->profile,
                      "Also write the NFA as a function of the ratio, its "
                      "modes and 95 % intervals as CSV");
  command->add_option("--gt", flags->ground_truth,
                      "True cameras to compare with (folder or scene file)");
  AddCommonFlags(command, &flags->common);
  command->callback(
      [flags, action] { *action = [flags] { return Scales(*flags); }; });
}

}  // namespace lowlap::cli
