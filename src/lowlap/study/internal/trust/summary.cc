#include "lowlap/study/internal/trust/summary.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/report/internal/svg_plot.h"
#include "lowlap/study/internal/trust/position_errors.h"
#include "lowlap/study/internal/trust/table.h"

namespace lowlap {
namespace {

const std::vector<TrustFamily>& FamiliesWithTruth() {
  static const std::vector<TrustFamily> families = {
      TrustFamily::kWrongDirections, TrustFamily::kMixed,
      TrustFamily::kAlikeSides, TrustFamily::kTwoSessions};
  return families;
}

bool IsWrong(const JudgedView& judged) {
  return judged.IsPlaced() && judged.error > kWrongCamera;
}

bool IsGood(const JudgedView& judged) {
  return judged.IsPlaced() && judged.error <= kGoodCamera;
}

// By label, in the order of their kinds: worlds, pairs, flaws.
std::vector<std::string> LabelsOf(const TrustStudy& study, TrustFamily family) {
  std::set<std::string> worlds, pairs, flaws;
  for (const auto& [key, trial] : study.trials) {
    if (key.first != family) continue;
    for (const std::string& label : trial.labels) {
      (label.rfind("world ", 0) == 0   ? worlds
       : label.rfind("pairs ", 0) == 0 ? pairs
                                       : flaws)
          .insert(label);
    }
  }
  std::vector<std::string> labels(worlds.begin(), worlds.end());
  labels.insert(labels.end(), pairs.begin(), pairs.end());
  labels.insert(labels.end(), flaws.begin(), flaws.end());
  return labels;
}

TextTable ReasonTable(const TrustStudy& study) {
  struct Count {
    int wrong = 0, good = 0;
  };
  std::map<std::string, Count> counts;
  for (const auto& [key, trial] : study.trials) {
    if (key.first == TrustFamily::kNoise) continue;
    for (const JudgedView& judged : trial.views) {
      for (const std::string& reason : judged.graded.reasons) {
        counts[reason].wrong += IsWrong(judged) ? 1 : 0;
        counts[reason].good += IsGood(judged) ? 1 : 0;
      }
    }
  }
  TextTable table;
  table.columns = {"reason", "wrong cameras", "good cameras"};
  for (const auto& [reason, count] : counts) {
    table.rows.push_back(
        {reason, std::to_string(count.wrong), std::to_string(count.good)});
  }
  return table;
}

std::string SilentText(const TrustStudy& study) {
  std::string text;
  for (const auto& [key, trial] : study.trials) {
    if (key.first == TrustFamily::kNoise) continue;
    std::vector<std::string> views;
    for (const JudgedView& judged : trial.views) {
      if (!judged.IsFirm() || !IsWrong(judged)) continue;
      views.push_back(std::to_string(judged.view.value()) + " (" +
                      NumberText(judged.error, 2) + ")");
    }
    if (views.empty()) continue;
    text += std::string(TrustFamilyName(key.first)) + " " +
            std::to_string(key.second) + ": cameras " + Joined(views, ", ") +
            (trial.is_doubtful ? "; the scene is doubtful" : "") + "; " +
            Joined(trial.labels, ", ") + "\n";
  }
  return text.empty() ? "none\n" : text;
}

std::string NoiseText(const TrustStudy& study) {
  TextTable table;
  table.columns = {"label",      "scenes", "triplets",
                   "meaningful", "placed", "firm"};
  std::vector<std::string> labels = LabelsOf(study, TrustFamily::kNoise);
  labels.insert(labels.begin(), "");
  for (const std::string& label : labels) {
    int triplets = 0, meaningful = 0;
    for (const auto& [key, trial] : study.trials) {
      if (key.first != TrustFamily::kNoise ||
          (!label.empty() &&
           std::count(trial.labels.begin(), trial.labels.end(), label) == 0)) {
        continue;
      }
      triplets += trial.num_triplets;
      meaningful += trial.num_meaningful;
    }
    const TrustCounts counts = CountTrust(study, TrustFamily::kNoise, label);
    table.rows.push_back(
        {label.empty() ? "all" : label, std::to_string(counts.scenes),
         std::to_string(triplets), std::to_string(meaningful),
         std::to_string(counts.placed), std::to_string(counts.firm)});
  }
  return ToAlignedText(table);
}

}  // namespace

TrustCounts CountTrust(const TrustStudy& study, TrustFamily family,
                       const std::string& label) {
  TrustCounts counts;
  for (const auto& [key, trial] : study.trials) {
    if (key.first != family ||
        (!label.empty() &&
         std::count(trial.labels.begin(), trial.labels.end(), label) == 0)) {
      continue;
    }
    ++counts.scenes;
    for (const JudgedView& judged : trial.views) {
      const bool is_firm = judged.IsFirm();
      ++counts.cameras;
      counts.placed += judged.IsPlaced() ? 1 : 0;
      counts.firm += is_firm ? 1 : 0;
      counts.firm_off +=
          is_firm && judged.error > std::max(kGoodCamera, 5 * judged.deviation)
              ? 1
              : 0;
      counts.wrong += IsWrong(judged) ? 1 : 0;
      counts.silent += is_firm && IsWrong(judged) ? 1 : 0;
      counts.good += IsGood(judged) ? 1 : 0;
      counts.good_doubted += !is_firm && IsGood(judged) ? 1 : 0;
    }
  }
  return counts;
}

TextTable TrustTable(const TrustStudy& study) {
  TextTable table;
  table.columns = {"scenes of", "scenes",   "cameras", "placed",
                   "firm",      "firm off", "wrong",   "silent",
                   "good",      "doubted",  "share"};
  for (const TrustFamily family : FamiliesWithTruth()) {
    std::vector<std::string> labels = LabelsOf(study, family);
    labels.insert(labels.begin(), "");
    for (const std::string& label : labels) {
      const TrustCounts counts = CountTrust(study, family, label);
      std::vector<std::string> row = {label.empty() ? TrustFamilyName(family)
                                                    : "  " + label};
      for (const int count :
           {counts.scenes, counts.cameras, counts.placed, counts.firm,
            counts.firm_off, counts.wrong, counts.silent, counts.good,
            counts.good_doubted}) {
        row.push_back(std::to_string(count));
      }
      row.push_back(
          counts.good == 0
              ? ""
              : NumberText(100.0 * counts.good_doubted / counts.good, 3) +
                    " %");
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

std::string SummaryText(const TrustStudy& study) {
  const auto percent = [](double share) {
    return NumberText(100 * share, 3) + " %";
  };
  return "Cameras of simulated scenes. Errors are shares of the scene's size; "
         "wrong: more than " +
         percent(kWrongCamera) + ", good: at most " + percent(kGoodCamera) +
         ".\nfirm off: graded firm, and off by more than " +
         percent(kGoodCamera) +
         " and five stated deviations; silent: graded firm, and wrong; "
         "doubted: good, and not firm; share: doubted of the good.\n\n" +
         ToAlignedText(TrustTable(study)) + "\nCameras that a reason names:\n" +
         ToAlignedText(ReasonTable(study)) + "\nSilent, by seed:\n" +
         SilentText(study) +
         "\nFeatures that have nothing to do with each other:\n" +
         NoiseText(study);
}

Result<std::string> DrawFirmShare(const TrustStudy& study) {
  constexpr std::array kBounds = {0.001, 0.002, 0.005, 0.01, 0.02,
                                  0.05,  0.1,   0.2,   0.5,  1.0};
  struct Bin {
    int placed = 0, firm = 0;
  };
  using Bins = std::array<Bin, kBounds.size() + 1>;
  std::map<TrustFamily, Bins> bins;
  for (const auto& [key, trial] : study.trials) {
    for (const JudgedView& judged : trial.views) {
      if (!judged.IsPlaced()) continue;
      const auto bin =
          std::lower_bound(kBounds.begin(), kBounds.end(), judged.error) -
          kBounds.begin();
      ++bins[key.first][bin].placed;
      bins[key.first][bin].firm += judged.IsFirm() ? 1 : 0;
    }
  }
  BarPlot plot;
  plot.title = "Share of cameras graded firm, by their error";
  plot.note =
      "Errors in shares of the scene's size; in brackets: how many of the "
      "cameras placed are firm";
  plot.value.label = "share graded firm";
  plot.value.min = 0;
  plot.value.max = 1;
  for (const TrustFamily family : FamiliesWithTruth()) {
    BarSeries series;
    series.name = TrustFamilyName(family);
    for (const Bin& bin : bins[family]) {
      series.values.push_back(bin.placed == 0
                                  ? std::optional<double>()
                                  : static_cast<double>(bin.firm) / bin.placed);
    }
    plot.series.push_back(std::move(series));
  }
  for (std::size_t n = 0; n <= kBounds.size(); ++n) {
    const auto percent = [&](std::size_t bound) {
      return NumberText(100 * kBounds[bound], 3);
    };
    const std::string range = n == 0 ? "up to " + percent(0)
                              : n == kBounds.size()
                                  ? "over " + percent(n - 1)
                                  : percent(n - 1) + " to " + percent(n);
    plot.groups.push_back(range + " % (" +
                          Joined(FamiliesWithTruth(), ", ",
                                 [&](TrustFamily family) {
                                   const Bin& bin = bins[family][n];
                                   return std::to_string(bin.firm) + " of " +
                                          std::to_string(bin.placed);
                                 }) +
                          ")");
  }
  return DrawBarPlot(plot);
}

Result<std::vector<std::pair<std::string, std::string>>> TrustFiles(
    const TrustStudy& study) {
  LOWLAP_ASSIGN_OR_RETURN(auto plot, DrawFirmShare(study));
  return std::vector<std::pair<std::string, std::string>>{
      {"cameras.csv", CamerasCsv(study)},
      {"summary.txt", SummaryText(study)},
      {"firm_share.svg", std::move(plot)}};
}

}  // namespace lowlap
