#include "lowlap/averaging/rigidity/internal/rigidity.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/averaging/rigidity/internal/rigid_parts.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

using ViewTriangle = std::array<ViewId, 3>;  // ascending

void MergeTriangles(const ViewGraph& graph,
                    const std::vector<ViewTriangle>& triangles,
                    UnionFind* groups) {
  for (const ViewTriangle& t : triangles) {
    const std::size_t closing = *graph.FindPair(t[1], t[2]);
    groups->Union(closing, *graph.FindPair(t[0], t[1]));
    groups->Union(closing, *graph.FindPair(t[0], t[2]));
  }
}

ViewTriangle Sorted(const ViewTriplet& v) {
  ViewTriangle views = {v.first, v.middle, v.last};
  std::sort(views.begin(), views.end());
  return views;
}

std::set<ViewTriangle> Sorted(const std::vector<ViewTriplet>& triplets) {
  std::set<ViewTriangle> triangles;
  for (const ViewTriplet& v : triplets) triangles.insert(Sorted(v));
  return triangles;
}

// A triangle on a line.
struct FlatTriangle {
  std::array<std::size_t, 3> edges;       // the long one last
  std::optional<std::size_t> short_edge;  // if it is narrow
};

std::vector<FlatTriangle> FlatTriangles(
    const ViewGraph& graph, const std::vector<ViewTriplet>& flat,
    const std::vector<ViewTriplet>& narrow) {
  std::map<ViewTriangle, ViewPair> short_sides;
  for (const ViewTriplet& v : narrow) {
    short_sides[Sorted(v)] = OrderedPair(v.first, v.last);
  }
  std::vector<FlatTriangle> triangles;
  for (const ViewTriplet& v : flat) {
    const auto a = graph.FindPair(v.first, v.middle);
    const auto b = graph.FindPair(v.middle, v.last);
    const auto ends = graph.FindPair(v.first, v.last);
    if (!a || !b || !ends) continue;
    triangles.push_back({{*a, *b, *ends}, std::nullopt});
    const auto found = short_sides.find(Sorted(v));
    if (found == short_sides.end()) continue;
    triangles.back().short_edge =
        graph.FindPair(found->second.first, found->second.second);
  }
  return triangles;
}

// Those that are neither flat nor narrow.
std::vector<ViewTriangle> OpenTriangles(
    const ViewGraph& graph, const std::vector<ViewTriplet>& flat,
    const std::vector<ViewTriplet>& narrow) {
  std::vector<ViewTriangle> open = FindTriangles(graph);
  std::set<ViewTriangle> thin = Sorted(flat);
  thin.merge(Sorted(narrow));
  open.erase(std::remove_if(open.begin(), open.end(),
                            [&](const ViewTriangle& views) {
                              return thin.count(views) > 0;
                            }),
             open.end());
  return open;
}

// Those whose directions, all three, say that they are narrow.
std::vector<ViewTriplet> NarrowAlone(const ViewGraph& graph,
                                     const std::vector<ViewTriplet>& flat,
                                     const std::vector<ViewTriplet>& narrow) {
  const std::set<ViewTriangle> on_lines = Sorted(flat);
  std::vector<ViewTriplet> alone;
  for (const ViewTriplet& v : narrow) {
    if (graph.FindPair(v.first, v.last) && on_lines.count(Sorted(v)) == 0) {
      alone.push_back(v);
    }
  }
  return alone;
}

void MergePaths(const ViewGraph& graph, const std::vector<ViewTriplet>& paths,
                UnionFind* sets) {
  for (const ViewTriplet& views : paths) {
    const auto reference = graph.FindPair(views.first, views.middle);
    const auto target = graph.FindPair(views.middle, views.last);
    if (reference && target) sets->Union(*reference, *target);
  }
}

// Lengths on a line add up: two that are known give the third, unless that is
// too short. Those of which no such two are known are left in `flat`.
void AddUpLengths(std::vector<FlatTriangle>* flat, UnionFind* sets) {
  for (std::size_t before = flat->size() + 1; flat->size() < before;) {
    before = flat->size();
    flat->erase(std::remove_if(
                    flat->begin(), flat->end(),
                    [&](const FlatTriangle& triangle) {
                      const auto& [a, b, c] = triangle.edges;
                      const auto give = [&](std::size_t first,
                                            std::size_t second,
                                            std::size_t third) {
                        return triangle.short_edge != third &&
                               sets->Find(first) == sets->Find(second);
                      };
                      if (!give(a, b, c) && !give(b, c, a) && !give(a, c, b)) {
                        return false;
                      }
                      sets->Union(a, b);
                      sets->Union(b, c);
                      return true;
                    }),
                flat->end());
  }
}

// The edges that no other holds, of a flat triangle the long one and of a
// narrow one the short one: to generic centres they would close their
// triangles.
std::vector<bool> IdleEdges(const std::vector<FlatTriangle>& flat,
                            const std::vector<ViewTriplet>& narrow,
                            const ViewGraph& graph,
                            const std::vector<std::size_t>& labels) {
  std::vector<int> sizes(labels.size(), 0);
  for (const std::size_t label : labels) ++sizes[label];
  std::vector<bool> is_idle(labels.size(), false);
  const auto note = [&](std::size_t edge) {
    is_idle[edge] = sizes[labels[edge]] == 1;
  };
  for (const FlatTriangle& triangle : flat) note(triangle.edges[2]);
  for (const ViewTriplet& v : narrow) {
    if (const auto edge = graph.FindPair(v.first, v.last)) note(*edge);
  }
  return is_idle;
}

// The place of every view, by number: near views of a narrow triangle whose
// long edges are in proportion share one, unless their own edge is held.
std::map<ViewId, std::uint32_t> PlacesOf(const std::vector<ViewTriplet>& narrow,
                                         const ViewGraph& graph,
                                         const std::vector<std::size_t>& labels,
                                         const std::vector<bool>& is_idle) {
  std::map<ViewId, std::uint32_t> places;
  for (const ViewId view : graph.views()) {
    places.emplace(view, static_cast<std::uint32_t>(places.size()));
  }
  UnionFind joined(places.size());
  for (const ViewTriplet& v : narrow) {
    const auto short_edge = graph.FindPair(v.first, v.last);
    const auto one = graph.FindPair(v.first, v.middle);
    const auto other = graph.FindPair(v.middle, v.last);
    const bool is_held = short_edge && !is_idle[*short_edge];
    if (!is_held && one && other && labels[*one] == labels[*other]) {
      joined.Union(places.at(v.first), places.at(v.last));
    }
  }
  for (auto& [view, place] : places) {
    place = static_cast<std::uint32_t>(joined.Find(place));
  }
  return places;
}

// MergeRigidParts without idle edges. Whether it merged anything.
bool MergePartsBut(const std::vector<FlatTriangle>& flat,
                   const std::vector<ViewTriplet>& narrow,
                   const ViewGraph& graph, UnionFind* sets) {
  const std::vector<std::size_t> labels = sets->Labels();
  const std::vector<bool> is_idle = IdleEdges(flat, narrow, graph, labels);
  const auto places = PlacesOf(narrow, graph, labels, is_idle);
  std::vector<ViewPair> pairs;
  std::vector<std::size_t> edges;
  for (std::size_t e = 0; e < labels.size(); ++e) {
    const auto& [first, second] = graph.pairs()[e];
    const ViewPair pair =
        OrderedPair(ViewId(places.at(first)), ViewId(places.at(second)));
    if (is_idle[e] || pair.first == pair.second) continue;
    pairs.push_back(pair);
    edges.push_back(e);
  }
  UnionFind parts(edges.size());
  std::map<std::size_t, std::size_t> first_of_label;
  for (std::size_t n = 0; n < edges.size(); ++n) {
    parts.Union(n, first_of_label.emplace(labels[edges[n]], n).first->second);
  }
  MergeRigidParts(pairs, &parts);
  const std::vector<std::size_t> merged = parts.Labels();
  std::vector<std::size_t> first_merged;
  bool any = false;
  for (std::size_t n = 0; n < edges.size(); ++n) {
    if (merged[n] == first_merged.size()) first_merged.push_back(edges[n]);
    any |= sets->Union(edges[n], first_merged[merged[n]]);
  }
  return any;
}

// The triangles whose three views share `least` point tracks or more; once one
// does, no further track is asked. Time: a step for every two views of a track,
// and for every triangle that still lacks tracks at the two.
std::vector<ViewTriangle> TrianglesOnTracks(const Scene& scene,
                                            const ViewGraph& graph, int least) {
  const std::vector<ViewTriangle> triangles = FindTriangles(graph);
  struct Open {
    ViewId last;
    int missing;  // tracks
    std::size_t triangle;
  };
  std::map<ViewPair, std::vector<Open>> open;  // by the first two views
  std::vector<bool> is_held(triangles.size(), least <= 0);
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    const auto& [first, second, last] = triangles[n];
    if (!is_held[n]) open[{first, second}].push_back({last, least, n});
  }
  const auto count = [&](Track::const_iterator from, Track::const_iterator end,
                         std::vector<Open>* of_pair) {
    bool any_held = false;
    auto next = of_pair->begin();
    while (from != end && next != of_pair->end()) {
      if (from->view < next->last) {
        from = std::lower_bound(
            from, end, next->last,
            [](const FeatureRef& f, ViewId view) { return f.view < view; });
      } else if (next->last < from->view) {
        next = std::lower_bound(
            next, of_pair->end(), from->view,
            [](const Open& o, ViewId view) { return o.last < view; });
      } else {
        if (--next->missing == 0) any_held = is_held[next->triangle] = true;
        ++next;
        ++from;
      }
    }
    return any_held;
  };
  for (const auto& [id, track] : scene.point_tracks) {
    for (auto a = track.begin(); a != track.end(); ++a) {
      for (auto b = std::next(a); b != track.end(); ++b) {
        const auto found = open.find({a->view, b->view});
        if (found == open.end()) continue;
        std::vector<Open>& of_pair = found->second;
        if (!count(std::next(b), track.end(), &of_pair)) continue;
        of_pair.erase(
            std::remove_if(of_pair.begin(), of_pair.end(),
                           [](const Open& o) { return o.missing == 0; }),
            of_pair.end());
        if (of_pair.empty()) open.erase(found);
      }
    }
  }
  std::vector<ViewTriangle> held;
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    if (is_held[n]) held.push_back(triangles[n]);
  }
  return held;
}

// The report on edges in the sets of `sets`.
RigidityReport Report(const ViewGraph& graph, UnionFind* sets) {
  RigidityReport report;
  for (std::vector<ViewId>& views : ConnectedComponents(graph)) {
    if (views.size() > 1) {
      report.connected_components.push_back(std::move(views));
    } else {
      report.isolated_views.push_back(views.front());
    }
  }
  const std::vector<std::size_t> labels = sets->Labels();
  for (std::size_t e = 0; e < graph.pairs().size(); ++e) {
    if (labels[e] >= report.groups.size()) {
      report.groups.resize(labels[e] + 1);
    }
    report.groups[labels[e]].edges.push_back(graph.pairs()[e]);
  }
  for (RigidGroup& group : report.groups) {
    std::set<ViewId> views;
    for (const ViewPair& edge : group.edges) {
      views.insert({edge.first, edge.second});
    }
    group.views.assign(views.begin(), views.end());
  }
  std::stable_sort(report.groups.begin(), report.groups.end(),
                   [](const RigidGroup& a, const RigidGroup& b) {
                     return a.views.size() > b.views.size();
                   });
  std::map<ViewId, std::vector<std::size_t>> groups_of_view;
  for (std::size_t g = 0; g < report.groups.size(); ++g) {
    for (const ViewId view : report.groups[g].views) {
      groups_of_view[view].push_back(g);
    }
  }
  for (auto& [view, groups] : groups_of_view) {
    if (groups.size() > 1)
      report.articulation_views.push_back({view, std::move(groups)});
  }
  return report;
}

}  // namespace

RigidityReport AnalyzeRigidity(const ViewGraph& graph,
                               const std::vector<ViewTriplet>& ratios,
                               const std::vector<ViewTriplet>& flat,
                               const std::vector<ViewTriplet>& narrow) {
  UnionFind sets(graph.pairs().size());
  MergeTriangles(graph, OpenTriangles(graph, flat, narrow), &sets);
  MergePaths(graph, ratios, &sets);
  MergePaths(graph, NarrowAlone(graph, flat, narrow), &sets);
  std::vector<FlatTriangle> unknown = FlatTriangles(graph, flat, narrow);
  do {
    AddUpLengths(&unknown, &sets);
  } while (MergePartsBut(unknown, narrow, graph, &sets) &&
           !(unknown.empty() && narrow.empty()));
  return Report(graph, &sets);
}

RigidityReport AnalyzeTripletRigidity(const Scene& scene,
                                      int min_shared_tracks) {
  const ViewGraph graph(scene);
  const std::vector<ViewTriangle> counted =
      TrianglesOnTracks(scene, graph, min_shared_tracks);
  std::vector<ViewPair> held;
  for (const ViewTriangle& t : counted) {
    held.insert(held.end(), {{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}});
  }
  const ViewGraph covered(std::move(held), graph.views());
  UnionFind sets(covered.pairs().size());
  MergeTriangles(covered, counted, &sets);
  return Report(covered, &sets);
}

}  // namespace lowlap
