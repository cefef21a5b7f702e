#include "lowlap/matching/internal/pair_retrieval.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/core/internal/union_find.h"
#include "lowlap/matching/internal/points/approximate_nearest.h"
#include "lowlap/matching/internal/points/point_matching.h"

namespace lowlap {
namespace {

constexpr std::size_t kNeighbours = 32;

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

// One view against another, all pairs of them.
Status VoteByMatches(const std::vector<std::vector<PointDescriptor>>& samples,
                     const RetrievalOptions& options, const RunContext& context,
                     std::vector<Votes>* votes) {
  return ParallelFor(context, "pairs", votes->size(), [&](std::size_t i) {
    Votes& vote = (*votes)[i];
    vote.count = MatchPoints(samples[vote.first], samples[vote.second],
                             {options.max_ratio})
                     .size();
  });
}

// One view against all others at once.
Status VoteByNeighbours(
    const std::vector<std::vector<PointDescriptor>>& samples,
    const RetrievalOptions& options, const RunContext& context,
    std::vector<Votes>* votes) {
  std::vector<PointDescriptor> database;
  std::vector<std::size_t> view_of;
  for (std::size_t view = 0; view < samples.size(); ++view) {
    database.insert(database.end(), samples[view].begin(), samples[view].end());
    view_of.resize(database.size(), view);
  }
  const std::size_t count = std::min(kNeighbours, database.size());
  if (count == 0) return {};
  // Votes are many: they need not all be right.
  const ApproximateIndex index(database, {1, 128});
  // Of every view the votes for every other one.
  std::vector<std::vector<std::size_t>> cast(
      samples.size(), std::vector<std::size_t>(samples.size(), 0));
  const Status done =
      ParallelFor(context, "pairs", samples.size(), [&](std::size_t view) {
        const auto neighbours = index.Search(samples[view], count);
        std::vector<std::size_t> last(samples.size(), samples[view].size());
        for (std::size_t n = 0; n < neighbours.size(); ++n) {
          const std::size_t query = n / count;
          const double chance2 =
              neighbours[count * query + count - 1].distance2;
          const std::size_t other = view_of[neighbours[n].index];
          if (neighbours[n].distance2 >=
                  options.max_ratio * options.max_ratio * chance2 ||
              last[other] == query) {
            continue;  // one vote of a point for a view
          }
          last[other] = query;
          ++cast[view][other];
        }
      });
  for (Votes& vote : *votes) {
    vote.count = cast[vote.first][vote.second] + cast[vote.second][vote.first];
  }
  return done;
}

}  // namespace

Status RetrievalOptions::Validate() const {
  if (Status s =
          Require({{sample_points >= 2, "sample_points must be at least 2"},
                   {max_exhaustive >= 0, "max_exhaustive must not be negative"},
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
  ids.reserve(features.size());
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
  samples.reserve(features.size());
  for (const auto& [id, view] : features) {
    samples.push_back(
        LargestPoints(view, static_cast<std::size_t>(options.sample_points)));
  }
  const bool exhaustively =
      ids.size() <= static_cast<std::size_t>(options.max_exhaustive);
  LOWLAP_RETURN_IF_ERROR(
      exhaustively ? VoteByMatches(samples, options, context, &votes)
                   : VoteByNeighbours(samples, options, context, &votes));

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
