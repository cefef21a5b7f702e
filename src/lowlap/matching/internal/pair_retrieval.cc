#include "lowlap/matching/internal/pair_retrieval.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/matching/internal/points/point_matching.h"

namespace lowlap {
namespace {

struct Votes {
  ViewPair pair;
  std::size_t count = 0;
};

std::vector<PointDescriptor> LargestPoints(const DetectedFeatures& view,
                                           std::size_t count) {
  std::vector<std::size_t> order(view.keypoints.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(
      order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return view.keypoints[a].scale_px > view.keypoints[b].scale_px;
      });
  order.resize(std::min(order.size(), count));
  std::vector<PointDescriptor> sample;
  sample.reserve(order.size());
  for (const std::size_t i : order) {
    sample.push_back(view.point_descriptors[i]);
  }
  return sample;
}

// The pairs of `votes`, which are sorted by falling count, that join two parts
// which no earlier pair joins (Kruskal).
void AddSpanningForest(const std::vector<Votes>& votes,
                       std::set<ViewPair>* pairs) {
  std::map<ViewId, ViewId> parent;
  const auto root = [&](ViewId id) {
    parent.emplace(id, id);
    while (parent[id] != id) id = parent[id] = parent[parent[id]];
    return id;
  };
  for (const Votes& v : votes) {
    const ViewId a = root(v.pair.first);
    const ViewId b = root(v.pair.second);
    if (a == b) continue;
    parent[b] = a;
    pairs->insert(v.pair);
  }
}

}  // namespace

Status RetrievalOptions::Validate() const {
  if (Status s =
          Require({{sample_points >= 2, "sample_points must be at least 2"},
                   {max_partners >= 1, "max_partners must be at least 1"}});
      !s) {
    return s;
  }
  return PointMatchOptions{max_ratio}.Validate();
}

Result<std::vector<ViewPair>> RetrievePairs(
    const std::map<ViewId, DetectedFeatures>& features,
    const RetrievalOptions& options, const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::vector<ViewId> ids;
  for (const auto& [id, view] : features) ids.push_back(id);
  std::vector<Votes> votes;
  std::vector<ViewPair> everything;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = i + 1; j < ids.size(); ++j) {
      everything.push_back({ids[i], ids[j]});
      votes.push_back({everything.back()});
    }
  }
  const auto max_partners = static_cast<std::size_t>(options.max_partners);
  if (ids.size() <= max_partners + 1) return everything;

  std::map<ViewId, std::vector<PointDescriptor>> samples;
  for (const auto& [id, view] : features) {
    samples[id] =
        LargestPoints(view, static_cast<std::size_t>(options.sample_points));
  }
  PointMatchOptions match;
  match.max_ratio = options.max_ratio;
  const Status done =
      ParallelFor(context, "pairs", votes.size(), [&](std::size_t i) {
        votes[i].count = MatchPoints(samples.at(votes[i].pair.first),
                                     samples.at(votes[i].pair.second), match)
                             .size();
      });
  if (!done) return tl::unexpected<Error>(done.error());

  votes.erase(std::remove_if(votes.begin(), votes.end(),
                             [](const Votes& v) { return v.count == 0; }),
              votes.end());
  std::stable_sort(
      votes.begin(), votes.end(),
      [](const Votes& a, const Votes& b) { return a.count > b.count; });
  std::set<ViewPair> pairs;
  std::map<ViewId, std::size_t> proposed;
  for (const Votes& v : votes) {
    for (const ViewId id : {v.pair.first, v.pair.second}) {
      if (proposed[id]++ < max_partners) pairs.insert(v.pair);
    }
  }
  AddSpanningForest(votes, &pairs);
  return std::vector<ViewPair>(pairs.begin(), pairs.end());
}

}  // namespace lowlap
