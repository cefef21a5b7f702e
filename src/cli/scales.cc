#include <cmath>
#include <cstdio>
#include <memory>
#include <ostream>
#include <string>

#include "cli/command.h"
#include "cli/scene_input.h"
#include "cli/solve_flags.h"
#include "lowlap/core/atomic_file.h"
#include "lowlap/evaluation/relative_errors.h"
#include "lowlap/pipeline/summary_json.h"
#include "lowlap/scale/ratio_profile.h"
#include "lowlap/scale/scale_ratios.h"

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

// "60/30/10": percent of the information of points, lines and coplanar pairs.
std::string InformationText(const ScaleRatio& ratio) {
  const auto percent = [](const KindSupport& kind) {
    return std::to_string(std::lround(100 * kind.information_share));
  };
  return percent(ratio.points) + '/' + percent(ratio.lines) + '/' +
         percent(ratio.coplanar);
}

// "ratio (log10 NFA)".
std::string SecondModeText(const ScaleRatio& ratio) {
  if (!ratio.second_mode) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.4f (%.1f)",
                std::exp(ratio.second_mode->log_ratio),
                ratio.second_mode->log10_nfa);
  return text;
}

void PrintTable(const std::vector<ScaleRatio>& ratios) {
  std::printf("%-12s %9s %9s %9s %9s %11s %11s %11s %10s %16s  %s\n", "views",
              "ratio", "95% from", "to", "log10 NFA", "points", "lines",
              "coplanar", "info %", "second mode", "verdict");
  for (const ScaleRatio& r : ratios) {
    const auto support = [](const KindSupport& kind) {
      return std::to_string(kind.inliers) + "/" +
             std::to_string(kind.candidates);
    };
    const std::string views = std::to_string(r.views.first) + "-" +
                              std::to_string(r.views.middle) + "-" +
                              std::to_string(r.views.last);
    std::printf("%-12s %9.4f %9.4f %9.4f %9.1f %11s %11s %11s %10s %16s  %s\n",
                views.c_str(), std::exp(r.log_ratio), std::exp(r.IntervalLow()),
                std::exp(r.IntervalHigh()), r.log10_nfa,
                support(r.points).c_str(), support(r.lines).c_str(),
                support(r.coplanar).c_str(), InformationText(r).c_str(),
                SecondModeText(r).c_str(), RatioVerdictName(r.verdict));
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
        loaded->scene, FindTriplets(loaded->scene), *options, context);
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
