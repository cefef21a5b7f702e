#include "lowlap/merge/internal/linked_pieces.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace lowlap {
namespace {

// A cluster of baselines, and the evidence between it and each other one.
struct Cluster {
  std::vector<std::size_t> baselines;  // of the graph
  std::map<ViewId, std::size_t> num_baselines_at;
  std::vector<std::size_t> labels;
  std::map<std::size_t, double> evidence;  // by label
};

std::map<std::size_t, Cluster> ClustersOf(
    const ViewGraph& graph, const std::vector<std::size_t>& labels,
    const std::vector<SignedLink>& links) {
  std::map<std::size_t, Cluster> clusters;
  for (std::size_t e = 0; e < labels.size(); ++e) {
    const ViewPair& views = graph.pairs()[e];
    Cluster& cluster = clusters[labels[e]];
    cluster.baselines.push_back(e);
    ++cluster.num_baselines_at[views.first];
    ++cluster.num_baselines_at[views.second];
    cluster.labels = {labels[e]};
  }
  for (const SignedLink& link : links) {
    const std::size_t a = labels[link.first], b = labels[link.second];
    if (a == b) continue;
    clusters[a].evidence[b] += link.evidence;
    clusters[b].evidence[a] += link.evidence;
  }
  return clusters;
}

std::vector<ViewId> SharedViews(const Cluster& a, const Cluster& b) {
  std::vector<ViewId> shared;
  for (const auto& entry : a.num_baselines_at) {
    if (b.num_baselines_at.count(entry.first) > 0) {
      shared.push_back(entry.first);
    }
  }
  return shared;
}

double EvidenceBetween(const Cluster& a, const Cluster& b) {
  double sum = 0;
  for (const std::size_t label : b.labels) {
    const auto found = a.evidence.find(label);
    if (found != a.evidence.end()) sum += found->second;
  }
  return sum;
}

void Absorb(const Cluster& cluster, Cluster* larger) {
  larger->baselines.insert(larger->baselines.end(), cluster.baselines.begin(),
                           cluster.baselines.end());
  for (const auto& [view, count] : cluster.num_baselines_at) {
    larger->num_baselines_at[view] += count;
  }
  larger->labels.insert(larger->labels.end(), cluster.labels.begin(),
                        cluster.labels.end());
  for (const auto& [other, value] : cluster.evidence) {
    larger->evidence[other] += value;
  }
}

// Those of three views at least, most baselines first; what shares two views is
// joined unless evidence says that it is not one.
std::vector<Cluster> JoinSharing(std::map<std::size_t, Cluster> clusters) {
  std::vector<Cluster> open;
  for (auto& entry : clusters) {
    if (entry.second.num_baselines_at.size() >= 3) {
      open.push_back(std::move(entry.second));
    }
  }
  const auto has_more = [](const Cluster& a, const Cluster& b) {
    return a.baselines.size() > b.baselines.size();
  };
  std::stable_sort(open.begin(), open.end(), has_more);
  std::vector<Cluster> joined;
  for (Cluster& cluster : open) {
    // One that has grown may share two views with others joined before.
    for (;;) {
      const auto same =
          std::find_if(joined.begin(), joined.end(), [&](const Cluster& other) {
            return SharedViews(cluster, other).size() >= 2 &&
                   EvidenceBetween(cluster, other) >= 0;
          });
      if (same == joined.end()) break;
      Absorb(*same, &cluster);
      joined.erase(same);
    }
    joined.push_back(std::move(cluster));
  }
  std::stable_sort(joined.begin(), joined.end(), has_more);
  return joined;
}

std::vector<std::size_t> BaselinesAt(const ViewGraph& graph, ViewId view,
                                     const Cluster& cluster) {
  std::vector<std::size_t> found;
  for (const std::size_t e : cluster.baselines) {
    const ViewPair& views = graph.pairs()[e];
    if (views.first == view || views.second == view) found.push_back(e);
  }
  return found;
}

// The baselines to give up so that two clusters share one view at most.
std::vector<std::size_t> Superfluous(const ViewGraph& graph,
                                     const Cluster& larger,
                                     const Cluster& smaller,
                                     const std::vector<ViewId>& shared) {
  ViewId hinge = kInvalidId;
  std::size_t most = 1;
  for (const ViewId view : shared) {
    const std::size_t fewer = std::min(larger.num_baselines_at.at(view),
                                       smaller.num_baselines_at.at(view));
    if (fewer <= most) continue;
    hinge = view;
    most = fewer;
  }
  std::vector<std::size_t> superfluous;
  for (const ViewId view : shared) {
    if (view == hinge) continue;
    const bool larger_keeps =
        larger.num_baselines_at.at(view) >= smaller.num_baselines_at.at(view);
    for (const std::size_t e :
         BaselinesAt(graph, view, larger_keeps ? smaller : larger)) {
      superfluous.push_back(e);
    }
  }
  return superfluous;
}

// Of clusters that must not share two views; each gives up baselines to one
// other at a time.
std::vector<std::size_t> AllSuperfluous(const ViewGraph& graph,
                                        const std::vector<Cluster>& clusters) {
  std::vector<std::size_t> superfluous;
  std::vector<bool> changed(clusters.size());
  for (std::size_t a = 0; a < clusters.size(); ++a) {
    for (std::size_t b = a + 1; b < clusters.size() && !changed[a]; ++b) {
      if (changed[b]) continue;
      const std::vector<ViewId> shared = SharedViews(clusters[a], clusters[b]);
      if (shared.size() < 2) continue;
      changed[a] = changed[b] = true;
      for (const std::size_t e :
           Superfluous(graph, clusters[a], clusters[b], shared)) {
        superfluous.push_back(e);
      }
    }
  }
  return superfluous;
}

}  // namespace

std::vector<RigidPiece> PiecesOfLinks(const ViewGraph& graph,
                                      std::vector<SignedLink> links) {
  std::vector<Cluster> clusters;
  for (;;) {
    clusters = JoinSharing(
        ClustersOf(graph, ClusterByLinks(graph.pairs().size(), links), links));
    const std::vector<std::size_t> superfluous =
        AllSuperfluous(graph, clusters);
    if (superfluous.empty()) break;
    // Without links a baseline is alone, which is no piece.
    std::vector<bool> given_up(graph.pairs().size());
    for (const std::size_t e : superfluous) given_up[e] = true;
    links.erase(std::remove_if(links.begin(), links.end(),
                               [&](const SignedLink& link) {
                                 return given_up[link.first] ||
                                        given_up[link.second];
                               }),
                links.end());
  }
  std::vector<RigidPiece> pieces;
  for (Cluster& cluster : clusters) {
    std::sort(cluster.baselines.begin(), cluster.baselines.end());
    RigidPiece piece;
    for (const auto& entry : cluster.num_baselines_at) {
      piece.views.push_back(entry.first);
    }
    for (const std::size_t e : cluster.baselines) {
      piece.pairs.push_back(graph.pairs()[e]);
    }
    pieces.push_back(std::move(piece));
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const RigidPiece& a, const RigidPiece& b) {
                     return a.views.size() > b.views.size();
                   });
  return pieces;
}

}  // namespace lowlap
