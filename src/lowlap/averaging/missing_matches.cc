#include "lowlap/averaging/internal/missing_matches.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>

#include "lowlap/averaging/centers/internal/evidence.h"
#include "lowlap/averaging/centers/internal/least_cut.h"
#include "lowlap/averaging/internal/expected_overlap.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr double kMinShare = 0.4;
constexpr double kHardlyFound = 0.1;
constexpr std::size_t kMinMissing = 3;

// Of placed views; what contradicts the solution joins nothing.
EvidenceOfPairs AgreeingPoses(const Scene& scene, const PoseSummary& summary) {
  std::set<ViewPair> left_out;
  for (const auto* edges : {&summary.outlier_edges, &summary.kept_outliers}) {
    for (const OutlierEdge& edge : *edges) left_out.insert(edge.views);
  }
  EvidenceOfPairs in_use;
  for (const auto& [views, pose] : scene.relative_poses) {
    if (left_out.count(views) == 0 && scene.FindPose(views.first) != nullptr &&
        scene.FindPose(views.second) != nullptr) {
      in_use[views] = EvidenceOfNfa(pose.log10_nfa);
    }
  }
  return in_use;
}

// Pairs that should see the same things.
struct ExpectedPairs {
  std::vector<ViewPair> found, missing;
};

ExpectedPairs FindExpectedPairs(const Scene& scene,
                                const EvidenceOfPairs& in_use) {
  const OverlapPredictor predictor(scene);
  ExpectedPairs pairs;
  std::vector<double> usual;
  for (const auto& entry : in_use) {
    const ViewPair& views = entry.first;
    const auto overlap = predictor.Between(views.first, views.second);
    if (!overlap || overlap->share < kMinShare) continue;
    pairs.found.push_back(views);
    usual.push_back(overlap->found);
  }
  if (usual.empty()) return pairs;
  const auto median =
      usual.begin() + static_cast<std::ptrdiff_t>(usual.size() / 2);
  std::nth_element(usual.begin(), median, usual.end());
  for (const ViewPair& views : scene.unrelated_pairs) {
    const auto overlap = predictor.Between(views.first, views.second);
    if (!overlap || overlap->share < kMinShare) continue;
    (overlap->found < kHardlyFound * *median ? pairs.missing : pairs.found)
        .push_back(views);
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

std::vector<ReliabilityWarning> FindMissingMatches(const Scene& scene,
                                                   const PoseSummary& summary) {
  if (scene.unrelated_pairs.empty() || scene.structure.empty()) return {};
  const EvidenceOfPairs in_use = AgreeingPoses(scene, summary);
  const ExpectedPairs expected = FindExpectedPairs(scene, in_use);
  std::vector<ViewPair> pairs;
  for (const auto& entry : in_use) pairs.push_back(entry.first);
  const ViewGraph graph(std::move(pairs));
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
