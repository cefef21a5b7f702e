#include "lowlap/averaging/internal/pose_warnings.h"

#include <utility>

#include "lowlap/core/internal/format.h"

namespace lowlap {
namespace {

class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {}

  std::string Names(const std::vector<ViewId>& views) const {
    std::string list;
    for (const ViewId view : views) {
      list += (list.empty() ? "" : ", ") + Name(view);
    }
    return list;
  }

  std::string Pairs(const std::vector<ViewPair>& pairs) const {
    std::string list;
    for (const ViewPair& pair : pairs) {
      list += (list.empty() ? "" : ", ") + Name(pair.first) + " - " +
              Name(pair.second);
    }
    return list;
  }

  std::string Triplets(const std::vector<ViewTriplet>& triplets) const {
    std::string list;
    for (const ViewTriplet& views : triplets) {
      list += (list.empty() ? "" : "; ") +
              Names({views.first, views.middle, views.last});
    }
    return list;
  }

  std::string Why(const ReliabilityWarning& doubt) const {
    switch (doubt.reason) {
      case WarningReason::kContradictedPoses:
        return "more of the evidence of its relative poses contradicts its "
               "place than agrees with it; they contradict: " +
               Pairs(doubt.against);
      case WarningReason::kWeakScale:
        return "only weak scale ratios join them to the others: " +
               Triplets(doubt.ratios);
      case WarningReason::kContradictedRatios:
        return "the scale ratios that join them to the others disagree; "
               "rejected were: " +
               Triplets(doubt.ratios);
      case WarningReason::kUntoldPoses:
        return "they hang on relative poses of too few matches to tell whether "
               "they are right, which no other confirms: " +
               Pairs(doubt.untold);
      case WarningReason::kUnheld:
        return "nothing that agrees with their places holds them" +
               (doubt.against.empty()
                    ? std::string()
                    : "; relative poses that contradict these were kept: " +
                          Pairs(doubt.against));
      case WarningReason::kDoubtfulNeighbors:
        return "they hang on views that are doubtful";
      case WarningReason::kLostFeatures:
        return "only " + Format("%.0f", 100 * doubt.share) +
               " % of what was matched in it fits its place";
    }
    return "";
  }

 private:
  std::string Name(ViewId view) const {
    const auto found = scene_.views.find(view);
    return found == scene_.views.end() ? std::to_string(view.value())
                                       : found->second.filename;
  }

  const Scene& scene_;
};

}  // namespace

std::vector<PoseWarning> PoseWarningsByView(const PoseSummary& summary,
                                            const Scene& scene) {
  const Writer writer(scene);
  std::vector<PoseWarning> warnings;
  if (!summary.unplaced.empty()) {
    warnings.push_back(
        {"Not placed, since no reliable relative pose and scale joins them to "
         "the others: " +
             writer.Names(summary.unplaced) + ".",
         summary.unplaced});
  }
  for (const ContestedLink& link : summary.contested) {
    warnings.push_back(
        {"Doubtful: only the relative pose " + writer.Pairs({link.edge}) +
             " places " + writer.Names(link.views) +
             ", and it is contradicted by " +
             writer.Pairs(link.contradictions) + ", which have less evidence.",
         link.views});
  }
  for (const Contest& contest : summary.contests) {
    warnings.push_back({"Doubtful: " + writer.Names(contest.views) + ": only " +
                            writer.Pairs(contest.links) +
                            " join them to the others, and are contradicted, "
                            "with hardly less evidence, by " +
                            writer.Pairs(contest.contradictions) + ".",
                        contest.views});
  }
  for (const LoopClosing& loop : summary.loops) {
    warnings.push_back(
        {"Doubtful: a loop of " + std::to_string(loop.edges.size()) +
             " relative poses does not close by " +
             Format("%.2f", loop.closing_deg) + " degrees (" +
             Format("%.2f", loop.expected_deg) +
             " expected). Nothing tells which is wrong; " +
             (loop.left_out
                  ? "the one of least evidence, " +
                        writer.Pairs({*loop.left_out}) + ", was left out: "
                  : std::string("all are used: ")) +
             writer.Pairs(loop.edges) + ".",
         {}});
  }
  if (!summary.weak_ratios.empty()) {
    warnings.push_back(
        {"Doubtful: scale ratios in use that chance explains as well, since "
         "nothing else places one of their views: " +
             writer.Triplets(summary.weak_ratios) + ".",
         {}});
  }
  for (const ReliabilityWarning& doubt : summary.reliability_warnings) {
    warnings.push_back({"Doubtful: " + writer.Names(doubt.views) + ": " +
                            writer.Why(doubt) + ".",
                        doubt.views});
  }
  if (!summary.unchecked.empty()) {
    warnings.push_back(
        {"Relative poses in use that lie on no cycle, so that no "
         "other one can confirm them: " +
             std::to_string(summary.unchecked.size()) + " of " +
             std::to_string(summary.num_edges) + ".",
         {}});
  }
  if (!summary.kept_outliers.empty()) {
    warnings.push_back(
        {"Relative poses in use though their directions contradict the solved "
         "centres, since views would be lost without them (" +
             std::to_string(summary.kept_outliers.size()) +
             "): " + writer.Pairs(PairsOf(summary.kept_outliers)) + ".",
         {}});
  }
  if (!summary.matches.replaced.empty()) {
    std::vector<ViewPair> pairs;
    for (const ReplacedDirection& replaced : summary.matches.replaced) {
      pairs.push_back(replaced.views);
    }
    warnings.push_back(
        {"Relative poses whose own matches contradict their directions and "
         "bear out others, which took their place (" +
             std::to_string(pairs.size()) + "): " + writer.Pairs(pairs) + ".",
         {}});
  }
  const auto left_out = [&](OutlierReason reason, const std::string& why) {
    std::vector<ViewPair> pairs;
    for (const OutlierEdge& edge : summary.outlier_edges) {
      if (edge.reason == reason) pairs.push_back(edge.views);
    }
    if (pairs.empty()) return;
    warnings.push_back({"Relative poses left out because " + why + " (" +
                            std::to_string(pairs.size()) +
                            "): " + writer.Pairs(pairs) + ".",
                        {}});
  };
  left_out(OutlierReason::kRotation, "their rotations contradict the others");
  left_out(OutlierReason::kDirection,
           "their directions contradict the solved centres");
  left_out(OutlierReason::kContradicted,
           "no cycle confirms them and what contradicts them has more "
           "evidence");
  left_out(OutlierReason::kMatches, "their own matches contradict them");
  return warnings;
}

std::vector<std::string> PoseWarnings(const PoseSummary& summary,
                                      const Scene& scene) {
  std::vector<std::string> texts;
  for (PoseWarning& warning : PoseWarningsByView(summary, scene)) {
    texts.push_back(std::move(warning.text));
  }
  return texts;
}

}  // namespace lowlap
