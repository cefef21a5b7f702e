#include "lowlap/averaging/reliability/internal/pose_warnings.h"

#include <map>
#include <set>
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
      list += (list.empty() ? "" : ", ") + scene_.NameOf(view);
    }
    return list;
  }

  std::string Pairs(const std::vector<ViewPair>& pairs) const {
    std::string list;
    for (const ViewPair& pair : pairs) {
      list += (list.empty() ? "" : ", ") + scene_.NameOf(pair.first) + " - " +
              scene_.NameOf(pair.second);
    }
    return list;
  }

  // The first of what may be many.
  std::string SomePairs(const std::vector<ViewPair>& pairs) const {
    constexpr std::size_t kMaxNamed = 5;
    if (pairs.size() <= kMaxNamed) return Pairs(pairs);
    return Pairs({pairs.begin(), pairs.begin() + kMaxNamed}) + ", and " +
           std::to_string(pairs.size() - kMaxNamed) + " more";
  }

  std::string Triplets(const std::vector<ViewTriplet>& triplets) const {
    std::string list;
    for (const ViewTriplet& views : triplets) {
      list += (list.empty() ? "" : "; ") +
              Names({views.first, views.middle, views.last});
    }
    return list;
  }

  // What the cause does not say.
  std::string Details(const ReliabilityWarning& doubt) const {
    switch (doubt.reason) {
      case WarningReason::kContradictedPoses:
        return "; they contradict: " + Pairs(doubt.against);
      case WarningReason::kWeakScale:
        return ": " + Triplets(doubt.ratios);
      case WarningReason::kContradictedRatios:
        return "; rejected were: " + Triplets(doubt.ratios);
      case WarningReason::kUntoldPoses:
        return ": " + Pairs(doubt.untold);
      case WarningReason::kUnheld:
        return doubt.against.empty()
                   ? std::string()
                   : "; relative poses that contradict these were kept: " +
                         Pairs(doubt.against);
      case WarningReason::kDoubtfulNeighbors:
        return "";
      case WarningReason::kLostFeatures:
        return ": " + Format("%.0f", 100 * doubt.share) + " % fits";
      case WarningReason::kMissingMatches:
      case WarningReason::kLookAlikes:
        return ": " + SomePairs(doubt.missing);
      case WarningReason::kImprecise:
        return ": a standard deviation of " +
               Format("%.1f", 100 * doubt.share) + " % of the scene's size";
    }
    return "";
  }

 private:
  const Scene& scene_;
};

std::string CauseOf(WarningReason reason) {
  switch (reason) {
    case WarningReason::kContradictedPoses:
      return "more of the evidence of their relative poses contradicts their "
             "places than agrees with them";
    case WarningReason::kWeakScale:
      return "only weak scale ratios join them to the others";
    case WarningReason::kContradictedRatios:
      return "the scale ratios that join them to the others disagree";
    case WarningReason::kUntoldPoses:
      return "they hang on relative poses that are hardly determined, that two "
             "motions explain alike, that may join things which only look "
             "alike, or of too few matches to tell whether they are right, "
             "which no other confirms";
    case WarningReason::kUnheld:
      return "nothing that agrees with their places holds them";
    case WarningReason::kDoubtfulNeighbors:
      return "they hang on views that are doubtful";
    case WarningReason::kLostFeatures:
      return "most of what was matched in them does not fit their places";
    case WarningReason::kMissingMatches:
      return "at their places they, or views beside them, should see what "
             "others see, and were compared with these in vain: two places may "
             "look alike";
    case WarningReason::kLookAlikes:
      return "what they or views beside them see at their places is found by "
             "others there in a part only: two places may look alike";
    case WarningReason::kImprecise:
      return "by their deviations they may be off by more than is promised of "
             "firm ones";
  }
  return "";
}

PoseWarning WarningOf(const std::vector<ViewId>& unplaced,
                      const Writer& writer) {
  const std::string cause =
      "Not placed, since no reliable relative pose and scale joins them to the "
      "others";
  return {cause + ": " + writer.Names(unplaced) + ".", unplaced, cause};
}

PoseWarning WarningOf(const ContestedLink& link, const Writer& writer) {
  return {"Doubtful: only the relative pose " + writer.Pairs({link.edge}) +
              " places " + writer.Names(link.views) +
              ", and it is contradicted by " +
              writer.Pairs(link.contradictions) + ", which have less evidence.",
          link.views,
          "Doubtful, since one relative pose alone places them, and others "
          "contradict it"};
}

PoseWarning WarningOf(const Contest& contest, const Writer& writer) {
  return {"Doubtful: " + writer.Names(contest.views) + ": only " +
              writer.Pairs(contest.links) +
              " join them to the others, and are contradicted by " +
              writer.Pairs(contest.contradictions) +
              ", whose evidence comes near theirs or exceeds it.",
          contest.views,
          "Doubtful, since what contradicts the links to the others has "
          "evidence near theirs, or more"};
}

PoseWarning WarningOf(const LoopClosing& loop, std::size_t num_loops,
                      const Writer& writer) {
  const std::string use = loop.left_out ? "the one of least evidence, " +
                                              writer.Pairs({*loop.left_out}) +
                                              ", was left out: "
                                        : "all are used: ";
  return {"Doubtful: a loop of " + std::to_string(loop.edges.size()) +
              " relative poses does not close by " +
              Format("%.2f", loop.closing_deg) + " degrees (" +
              Format("%.2f", loop.expected_deg) +
              " expected). Nothing tells which is wrong; " + use +
              writer.Pairs(loop.edges) + ".",
          loop.DoubtfulViews(),
          "Doubtful: relative poses whose loops do not close, and nothing "
          "tells which are wrong (" +
              std::to_string(num_loops) + ")"};
}

PoseWarning WarningOf(const ReliabilityWarning& doubt, const Writer& writer) {
  const std::string cause = CauseOf(doubt.reason);
  return {"Doubtful: " + writer.Names(doubt.views) + ": " + cause +
              writer.Details(doubt) + ".",
          doubt.views, "Doubtful, since " + cause};
}

// Of relative poses or ratios, if there are any; no views are named.
void AddCounted(const std::string& what, std::size_t count,
                const std::string& names, std::vector<PoseWarning>* warnings) {
  if (count == 0) return;
  const std::string cause = what + " (" + std::to_string(count) + ")";
  warnings->push_back(
      {cause + (names.empty() ? "" : ": " + names) + ".", {}, cause});
}

void AddInUse(const PoseSummary& summary, const Writer& writer,
              std::vector<PoseWarning>* warnings) {
  AddCounted(
      "Doubtful: scale ratios in use that chance explains as well, since "
      "nothing else places one of their views",
      summary.weak_ratios.size(), writer.Triplets(summary.weak_ratios),
      warnings);
  AddCounted("Of the " + std::to_string(summary.num_edges) +
                 " relative poses in use, those that lie on no cycle, so "
                 "that no other one can confirm them",
             summary.unchecked.size(), "", warnings);
  AddCounted(
      "Relative poses in use though their directions contradict the solved "
      "centres, since views would be lost without them",
      summary.kept_outliers.size(),
      writer.Pairs(PairsOf(summary.kept_outliers)), warnings);
}

void AddLeftOut(const PoseSummary& summary, const Writer& writer,
                std::vector<PoseWarning>* warnings) {
  AddCounted(
      "Scale ratios left out because only without them the directions of the "
      "relative poses agree",
      summary.left_out_ratios.size(), writer.Triplets(summary.left_out_ratios),
      warnings);
  std::vector<ViewPair> replaced;
  for (const ReplacedDirection& edge : summary.matches.replaced) {
    replaced.push_back(edge.views);
  }
  AddCounted(
      "Relative poses whose own matches contradict their directions and bear "
      "out others, which took their place",
      replaced.size(), writer.Pairs(replaced), warnings);
  const auto add = [&](OutlierReason reason, const std::string& why) {
    std::vector<ViewPair> pairs;
    for (const OutlierEdge& edge : summary.outlier_edges) {
      if (edge.reason == reason) pairs.push_back(edge.views);
    }
    AddCounted("Relative poses left out because " + why, pairs.size(),
               writer.Pairs(pairs), warnings);
  };
  add(OutlierReason::kRotation, "their rotations contradict the others");
  add(OutlierReason::kDirection,
      "their directions contradict the solved centres");
  add(OutlierReason::kContradicted,
      "no cycle confirms them and what contradicts them has more evidence");
  add(OutlierReason::kMatches, "their own matches contradict them");
  add(OutlierReason::kOutweighed,
      "third views bear out what contradicts them, and hardly them");
  add(OutlierReason::kLookAlike,
      "they join places that look alike: beside the matches, what both views "
      "should see is missing");
}

}  // namespace

std::vector<PoseWarning> PoseWarningsByView(const PoseSummary& summary,
                                            const Scene& scene) {
  const Writer writer(scene);
  std::vector<PoseWarning> warnings;
  if (!summary.unplaced.empty()) {
    warnings.push_back(WarningOf(summary.unplaced, writer));
  }
  for (const ContestedLink& link : summary.contested) {
    warnings.push_back(WarningOf(link, writer));
  }
  for (const Contest& contest : summary.contests) {
    warnings.push_back(WarningOf(contest, writer));
  }
  for (const LoopClosing& loop : summary.loops) {
    warnings.push_back(WarningOf(loop, summary.loops.size(), writer));
  }
  for (const ReliabilityWarning& doubt : summary.reliability_warnings) {
    warnings.push_back(WarningOf(doubt, writer));
  }
  AddInUse(summary, writer, &warnings);
  AddLeftOut(summary, writer, &warnings);
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

std::vector<std::string> PoseWarningsByCause(const PoseSummary& summary,
                                             const Scene& scene) {
  std::vector<std::string> causes;  // in the order of their first warning
  std::map<std::string, std::set<ViewId>> views;
  for (const PoseWarning& warning : PoseWarningsByView(summary, scene)) {
    const bool is_new = views.count(warning.cause) == 0;
    if (is_new) causes.push_back(warning.cause);
    views[warning.cause].insert(warning.views.begin(), warning.views.end());
  }
  const Writer writer(scene);
  std::vector<std::string> texts;
  for (const std::string& cause : causes) {
    const std::set<ViewId>& named = views.at(cause);
    texts.push_back(cause +
                    (named.empty()
                         ? ""
                         : ": " + writer.Names({named.begin(), named.end()})) +
                    ".");
  }
  return texts;
}

}  // namespace lowlap
