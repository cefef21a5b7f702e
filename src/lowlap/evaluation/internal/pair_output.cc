#include <nlohmann/json.hpp>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/view_json.h"
#include "lowlap/evaluation/internal/pair_errors.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

std::string Angle(const std::optional<double>& value) {
  return value ? Format("%.3f", *value) : "-";
}

std::string GroupText(const char* name, const PairGroupErrors& group) {
  std::string text =
      Format("%s: %d pairs, %d failed (%d without a relative pose)\n", name,
             group.num_pairs, group.num_failed, group.num_without_pose);
  for (const auto& [what, q] : {std::pair("rotation ", &group.rotation_deg),
                                std::pair("direction", &group.direction_deg)}) {
    if (q->count == 0) {
      text += Format("  %s error (degrees): -\n", what);
      continue;
    }
    text += Format("  %s error (degrees): median %.3f, 90%% %.3f, worst %.3f\n",
                   what, q->median, q->p90, q->worst);
  }
  return text;
}

Json QuantilesJson(const ErrorQuantiles& quantiles) {
  return {{"count", quantiles.count},
          {"median", quantiles.median},
          {"p90", quantiles.p90},
          {"worst", quantiles.worst}};
}

Json GroupJson(const PairGroupErrors& group) {
  return {{"num_pairs", group.num_pairs},
          {"num_without_pose", group.num_without_pose},
          {"num_failed", group.num_failed},
          {"rotation_deg", QuantilesJson(group.rotation_deg)},
          {"direction_deg", QuantilesJson(group.direction_deg)}};
}

}  // namespace

std::string ToText(const PairEvaluation& evaluation) {
  std::string text =
      Format("%-12s %4s %13s %14s %7s %6s %10s\n", "pair", "next",
             "rotation_deg", "direction_deg", "points", "lines", "log10_nfa");
  for (const PairError& pair : evaluation.pairs) {
    const std::string name = PairName(pair.views);
    text += Format("%-12s %4s ", name.c_str(), pair.consecutive ? "*" : "");
    text += pair.has_pose ? Format("%13s %14s %7d %6d %10.1f",
                                   Angle(pair.rotation_error_deg).c_str(),
                                   Angle(pair.direction_error_deg).c_str(),
                                   pair.num_point_inliers,
                                   pair.num_line_inliers, pair.log10_nfa)
                          : std::string("no relative pose");
    text += pair.failed ? "  FAILED\n" : "\n";
  }
  text += GroupText("consecutive", evaluation.consecutive);
  text += GroupText("all", evaluation.all);
  if (evaluation.num_without_truth > 0) {
    text += Format("relative poses without truth: %d\n",
                   evaluation.num_without_truth);
  }
  return text;
}

std::string ToJson(const PairEvaluation& evaluation) {
  Json pairs = Json::array();
  for (const PairError& pair : evaluation.pairs) {
    Json entry = {{"views", pair.views},
                  {"consecutive", pair.consecutive},
                  {"has_pose", pair.has_pose},
                  {"failed", pair.failed}};
    if (pair.rotation_error_deg) {
      entry["rotation_error_deg"] = *pair.rotation_error_deg;
    }
    if (pair.direction_error_deg) {
      entry["direction_error_deg"] = *pair.direction_error_deg;
    }
    if (pair.has_pose) {
      entry["num_point_inliers"] = pair.num_point_inliers;
      entry["num_line_inliers"] = pair.num_line_inliers;
      entry["log10_nfa"] = pair.log10_nfa;
    }
    pairs.push_back(std::move(entry));
  }
  const Json json = {{"consecutive", GroupJson(evaluation.consecutive)},
                     {"all", GroupJson(evaluation.all)},
                     {"num_without_truth", evaluation.num_without_truth},
                     {"pairs", std::move(pairs)}};
  return json.dump(2);
}

}  // namespace lowlap
