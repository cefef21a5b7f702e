#include "lowlap/pipeline/internal/ratio_table.h"

#include <cmath>

#include "lowlap/core/format.h"

namespace lowlap {
namespace {

std::string RatioText(double log_ratio) {
  return Format("%.4f", std::exp(log_ratio));
}

std::string Support(const KindSupport& kind) {
  return std::to_string(kind.inliers) + "/" + std::to_string(kind.candidates);
}

std::string Information(const ScaleRatio& ratio) {
  const auto percent = [](const KindSupport& kind) {
    return std::to_string(std::lround(100 * kind.information_share));
  };
  return percent(ratio.points) + "/" + percent(ratio.lines) + "/" +
         percent(ratio.coplanar);
}

}  // namespace

std::vector<std::string> RatioColumns() {
  return {"ratio", "95 % from", "to",     "log10 NFA",   "points",
          "lines", "coplanar",  "info %", "second mode", "verdict"};
}

std::vector<std::string> RatioRow(const ScaleRatio& ratio) {
  const std::string none = "-";
  const std::string verdict = RatioVerdictName(ratio.verdict);
  if (ratio.verdict == RatioVerdict::kNoCandidates) {
    return {none, none, none, none, none, none, none, none, none, verdict};
  }
  return {RatioText(ratio.log_ratio),
          RatioText(ratio.IntervalLow()),
          RatioText(ratio.IntervalHigh()),
          Format("%.1f", ratio.log10_nfa),
          Support(ratio.points),
          Support(ratio.lines),
          Support(ratio.coplanar),
          Information(ratio),
          ratio.second_mode
              ? RatioText(ratio.second_mode->log_ratio) + " (" +
                    Format("%.1f", ratio.second_mode->log10_nfa) + ")"
              : none,
          verdict};
}

}  // namespace lowlap
