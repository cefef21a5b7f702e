#include <nlohmann/json.hpp>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/view_json.h"
#include "lowlap/evaluation/internal/line_match_errors.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

std::string Row(const std::string& name, const LineMatchCounts& counts,
                const char* note) {
  return Format("%-12s %8d %6d %6d %8d %9d %7d %8d %10.1f %8.1f%s\n",
                name.c_str(), counts.num_matches, counts.num_right,
                counts.num_wrong, counts.num_unknown, counts.num_excluded,
                counts.num_common_edges, counts.num_matched_edges,
                100 * counts.Precision(), 100 * counts.Recall(), note);
}

Json ToJsonValue(const LineMatchCounts& counts) {
  return {{"num_matches", counts.num_matches},
          {"num_right", counts.num_right},
          {"num_wrong", counts.num_wrong},
          {"num_unknown", counts.num_unknown},
          {"num_excluded", counts.num_excluded},
          {"num_common_edges", counts.num_common_edges},
          {"num_matched_edges", counts.num_matched_edges},
          {"precision", counts.Precision()},
          {"recall", counts.Recall()}};
}

}  // namespace

std::string ToText(const LineMatchEvaluation& evaluation) {
  std::string text =
      Format("%-12s %8s %6s %6s %8s %9s %7s %8s %10s %8s\n", "pair", "matches",
             "right", "wrong", "unknown", "excluded", "common", "matched",
             "precision", "recall");
  for (const PairLineMatches& pair : evaluation.pairs) {
    text += Row(PairName(pair.views), pair.counts,
                pair.has_relative_pose ? "" : "  no relative pose");
  }
  text += Row("all", evaluation.total, "");
  if (evaluation.num_without_truth > 0) {
    text +=
        "pairs without truth: " + std::to_string(evaluation.num_without_truth) +
        "\n";
  }
  text +=
      "right: both segments on one true edge; unknown: not on listed edges; "
      "excluded: of the unknown, against the true epipolar geometry; common, "
      "matched: true edges that both images show; precision and recall in "
      "percent\n";
  return text;
}

std::string ToJson(const LineMatchEvaluation& evaluation) {
  Json pairs = Json::array();
  for (const PairLineMatches& pair : evaluation.pairs) {
    Json value = {{"views", pair.views},
                  {"has_relative_pose", pair.has_relative_pose}};
    value.update(ToJsonValue(pair.counts));
    pairs.push_back(value);
  }
  const Json json = {{"pairs", pairs},
                     {"total", ToJsonValue(evaluation.total)},
                     {"num_without_truth", evaluation.num_without_truth}};
  return json.dump(2);
}

}  // namespace lowlap
