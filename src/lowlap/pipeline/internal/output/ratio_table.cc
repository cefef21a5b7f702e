#include "lowlap/pipeline/internal/output/ratio_table.h"

#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/format.h"

namespace lowlap {
namespace {

std::string RatioText(double log_ratio) {
  return Format("%.4f", std::exp(log_ratio));
}

std::string Support(const KindSupport* kind) {
  return kind == nullptr ? "-"
                         : std::to_string(kind->inliers) + "/" +
                               std::to_string(kind->candidates);
}

std::string Percent(const KindSupport* kind) {
  return kind == nullptr
             ? "-"
             : std::to_string(std::lround(100 * kind->information_share));
}

std::vector<std::string> Row(const ScaleRatio& ratio,
                             const std::vector<std::string>& kinds) {
  const std::string none = "-";
  const std::string verdict = RatioVerdictName(ratio.verdict);
  if (ratio.verdict == RatioVerdict::kNoCandidates) {
    std::vector<std::string> row(kinds.size() + 6, none);
    row.push_back(verdict);
    return row;
  }
  std::vector<std::string> row = {
      RatioText(ratio.log_ratio), RatioText(ratio.IntervalLow()),
      RatioText(ratio.IntervalHigh()), Format("%.1f", ratio.log10_nfa)};
  std::string information;
  for (const std::string& name : kinds) {
    const KindSupport* kind = ratio.FindKind(name);
    row.push_back(Support(kind));
    information += (information.empty() ? "" : "/") + Percent(kind);
  }
  row.push_back(information);
  row.push_back(ratio.second_mode
                    ? RatioText(ratio.second_mode->log_ratio) + " (" +
                          Format("%.1f", ratio.second_mode->log10_nfa) + ")"
                    : none);
  row.push_back(verdict);
  return row;
}

}  // namespace

std::vector<std::string> KindNames(const std::vector<ScaleRatio>& ratios) {
  std::vector<std::string> names;
  for (const ScaleRatio& ratio : ratios) {
    for (const KindSupport& kind : ratio.kinds) {
      if (std::find(names.begin(), names.end(), kind.kind) == names.end()) {
        names.push_back(kind.kind);
      }
    }
  }
  return names;
}

RatioTable MakeRatioTable(const std::vector<ScaleRatio>& ratios) {
  const std::vector<std::string> kinds = KindNames(ratios);
  RatioTable table;
  table.columns = {"ratio", "95 % from", "to", "log10 NFA"};
  table.columns.insert(table.columns.end(), kinds.begin(), kinds.end());
  for (const char* column : {"info %", "second mode", "verdict"}) {
    table.columns.emplace_back(column);
  }
  for (const ScaleRatio& ratio : ratios) {
    table.rows.push_back(Row(ratio, kinds));
  }
  return table;
}

}  // namespace lowlap
