#include "lowlap/matching/internal/pair_retrieval.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/core/internal/union_find.h"
#include "lowlap/matching/internal/points/point_matching.h"

namespace lowlap {
namespace {

struct Votes {
  std::size_t first;  // indices of views
  std::size_t second;
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
      votes.push_back({i, j});
    }
  }
  const auto max_partners = static_cast<std::size_t>(options.max_partners);
  if (ids.size() <= max_partners + 1) return everything;

  std::vector<std::vector<PointDescriptor>> samples;
  for (const auto& [id, view] : features) {
    samples.push_back(
        LargestPoints(view, static_cast<std::size_t>(options.sample_points)));
  }
  const Status done =
      ParallelFor(context, "pairs", votes.size(), [&](std::size_t i) {
        votes[i].count =
            MatchPoints(samples[votes[i].first], samples[votes[i].second],
                        {options.max_ratio})
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
  std::vector<std::size_t> proposed(ids.size(), 0);
  UnionFind joined(ids.size());
  for (const Votes& v : votes) {
    const ViewPair pair{ids[v.first], ids[v.second]};
    for (const std::size_t view : {v.first, v.second}) {
      if (proposed[view]++ < max_partners) pairs.insert(pair);
    }
    // Kruskal: what no earlier pair joins.
    if (joined.Union(v.first, v.second)) pairs.insert(pair);
  }
  return std::vector<ViewPair>(pairs.begin(), pairs.end());
}

}  // namespace lowlap
