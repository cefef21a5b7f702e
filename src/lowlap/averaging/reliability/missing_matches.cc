#include "lowlap/averaging/reliability/internal/missing_matches.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>

#include "lowlap/averaging/centers/internal/evidence.h"
#include "lowlap/averaging/centers/internal/least_cut.h"
#include "lowlap/averaging/reliability/internal/agreeing_poses.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr double kMinShare = 0.4;
constexpr double kHardlyFound = 0.1;
constexpr std::size_t kMinMissing = 3;

// Pairs that should see the same things.
struct ExpectedPairs {
  std::vector<ViewPair> found, missing;
};

ExpectedPairs FindExpectedPairs(const Scene& scene, const ViewGraph& agreeing,
                                const ExpectedOverlaps& overlaps) {
  const auto overlap_of = [&](const ViewPair& views) {
    const auto overlap = overlaps.find(views);
    return overlap == overlaps.end() || overlap->second.share < kMinShare
               ? nullptr
               : &overlap->second;
  };
  ExpectedPairs pairs;
  std::vector<double> found;
  for (const ViewPair& views : agreeing.pairs()) {
    if (const auto* overlap = overlap_of(views)) {
      pairs.found.push_back(views);
      found.push_back(overlap->found);
    }
  }
  const double usual = Median(std::move(found));
  for (const ViewPair& views : scene.unrelated_pairs) {
    if (const auto* overlap = overlap_of(views)) {
      (overlap->found < kHardlyFound * usual ? pairs.missing : pairs.found)
          .push_back(views);
    }
  }
  return pairs;
}

std::vector<ViewPair> PairsAcross(const std::vector<ViewPair>& pairs,
                                  const std::set<ViewId>& side) {
  std::vector<ViewPair> across;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(across),
               [&](const ViewPair& views) {
                 return side.count(views.first) != side.count(views.second);
               });
  return across;
}

}  // namespace

std::vector<ReliabilityWarning> FindMissingMatches(
    const Scene& scene, const PoseSummary& summary,
    const ExpectedOverlaps& overlaps) {
  if (scene.unrelated_pairs.empty()) return {};
  const ViewGraph graph = AgreeingPoses(scene, summary);
  const ExpectedPairs expected = FindExpectedPairs(scene, graph, overlaps);
  EvidenceOfPairs in_use;
  for (const ViewPair& views : graph.pairs()) {
    in_use[views] = EvidenceOfNfa(scene.relative_poses.at(views).log10_nfa);
  }
  WeakCuts cuts(graph, in_use);
  std::vector<ReliabilityWarning> warnings;
  std::set<ViewPair> named;
  for (const ViewPair& views : expected.missing) {
    if (named.count(views) > 0) continue;
    const std::set<ViewId> side = cuts.SideOf(views.first, views.second);
    if (side.empty()) continue;
    ReliabilityWarning warning;
    warning.missing = PairsAcross(expected.missing, side);
    if (warning.missing.size() < kMinMissing ||
        warning.missing.size() <= PairsAcross(expected.found, side).size()) {
      continue;
    }
    named.insert(warning.missing.begin(), warning.missing.end());
    warning.reason = WarningReason::kMissingMatches;
    warning.views = SmallerSide(graph, side);
    std::vector<ViewId> all = ComponentOf(graph, views.first);
    if (2 * warning.views.size() + 1 >= all.size()) {
      warning.views = std::move(all);
    }
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace lowlap
