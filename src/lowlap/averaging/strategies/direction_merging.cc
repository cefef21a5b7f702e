#include "lowlap/averaging/strategies/internal/direction_merging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/strategies/internal/bounded_directions.h"
#include "lowlap/averaging/strategies/internal/component_closure.h"
#include "lowlap/core/union_find.h"

namespace lowlap {
namespace {

// Ten standard deviations: a length is then good to a tenth.
constexpr double kSeparation = 10;
// A ring is closed by dense algebra.
constexpr std::size_t kMaxRing = 100;

class Merger {
 public:
  explicit Merger(const TranslationProblem& problem)
      : edges_(problem.edges),
        incident_(problem.views.size()),
        sets_(problem.edges.size()),
        is_single_(problem.edges.size(), true) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      incident_[edges_[e].first].push_back(e);
      incident_[edges_[e].second].push_back(e);
    }
  }

  std::vector<std::size_t> Run() {
    do {
      while (MergeIntersections() || MergeSharedPairs()) {
      }
    } while (MergeRings());
    return sets_.Labels();
  }

 private:
  void Merge(std::size_t a, std::size_t b) {
    if (sets_.Union(a, b)) is_single_[sets_.Find(a)] = false;
  }

  // The angle between two directions is well above their errors, either sign.
  bool AreSeparate(std::size_t a, std::size_t b) const {
    const double sine =
        edges_[a].direction_in_world.cross(edges_[b].direction_in_world).norm();
    return sine >=
           kSeparation * std::max(edges_[a].stddev_rad, edges_[b].stddev_rad);
  }

  std::vector<std::size_t> BodiesAt(std::size_t view) {
    std::vector<std::size_t> bodies;
    for (const std::size_t e : incident_[view]) bodies.push_back(sets_.Find(e));
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    return bodies;
  }

  // A view that two directions from different views of one body intersect. A
  // body of one edge makes a triangle, all of whose angles must be open.
  bool MergeIntersections() {
    bool merged = false;
    std::vector<std::vector<std::size_t>> bodies_at(incident_.size());
    for (std::size_t v = 0; v < incident_.size(); ++v) {
      bodies_at[v] = BodiesAt(v);
    }
    struct Ray {
      std::size_t body, from, edge;
    };
    for (std::size_t v = 0; v < incident_.size(); ++v) {
      std::vector<Ray> rays;
      for (const std::size_t e : incident_[v]) {
        const std::size_t from =
            edges_[e].first == v ? edges_[e].second : edges_[e].first;
        for (const std::size_t stale : bodies_at[from]) {
          const std::size_t body = sets_.Find(stale);
          if (body != sets_.Find(e)) rays.push_back({body, from, e});
        }
      }
      std::stable_sort(
          rays.begin(), rays.end(),
          [](const Ray& a, const Ray& b) { return a.body < b.body; });
      for (std::size_t begin = 0, end = 0; begin < rays.size(); begin = end) {
        while (end < rays.size() && rays[end].body == rays[begin].body) ++end;
        // Merged a moment ago: the next round sees it.
        if (sets_.Find(rays[begin].body) != rays[begin].body) continue;
        for (std::size_t n = begin + 1; n < end; ++n) {
          const Ray &a = rays[begin], &b = rays[n];
          if (a.from == b.from || !AreSeparate(a.edge, b.edge)) continue;
          if (is_single_[a.body] &&
              (!AreSeparate(a.edge, a.body) || !AreSeparate(b.edge, a.body))) {
            continue;
          }
          Merge(a.body, a.edge);
          Merge(a.body, b.edge);
          merged = true;
          break;
        }
      }
    }
    return merged;
  }

  bool MergeSharedPairs() {
    bool merged = false;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> first_view;
    for (std::size_t v = 0; v < incident_.size(); ++v) {
      const std::vector<std::size_t> bodies = BodiesAt(v);
      for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = a + 1; b < bodies.size(); ++b) {
          if (first_view.insert({{bodies[a], bodies[b]}, v}).second) continue;
          Merge(bodies[a], bodies[b]);
          merged = true;
        }
      }
    }
    return merged;
  }

  // Parts with at least two views that others share too, largest first.
  std::vector<DirectionPart> PartsInRings(
      std::vector<std::size_t>* edge_of_part) {
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      members[sets_.Find(e)].push_back(e);
    }
    std::map<std::size_t, std::set<std::size_t>> views_of;
    std::vector<int> uses(incident_.size(), 0);
    for (const auto& [body, edges] : members) {
      for (const std::size_t e : edges) {
        views_of[body].insert({edges_[e].first, edges_[e].second});
      }
      for (const std::size_t view : views_of[body]) ++uses[view];
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (auto body = views_of.begin(); body != views_of.end();) {
        const auto shared =
            std::count_if(body->second.begin(), body->second.end(),
                          [&](std::size_t view) { return uses[view] > 1; });
        if (shared >= 2) {
          ++body;
          continue;
        }
        for (const std::size_t view : body->second) --uses[view];
        body = views_of.erase(body);
        changed = true;
      }
    }
    std::vector<std::size_t> order;
    for (const auto& entry : views_of) order.push_back(entry.first);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) {
                       return views_of[a].size() > views_of[b].size();
                     });
    if (order.size() > kMaxRing) order.resize(kMaxRing);
    std::vector<DirectionPart> parts;
    for (const std::size_t body : order) {
      parts.push_back(MakePart(edges_, members[body]));
      edge_of_part->push_back(body);
    }
    return parts;
  }

  bool MergeRings() {
    std::vector<std::size_t> edge_of_part;
    std::vector<Body> bodies;
    for (const DirectionPart& part : PartsInRings(&edge_of_part)) {
      Body body;
      body.stddev_rad = 0;
      for (const DirectionEdge& edge : part.edges) {
        body.stddev_rad = std::max(body.stddev_rad, edge.stddev_rad);
      }
      body.views = part.views;
      constexpr int kShapeIterations = 50;
      const auto done =
          MinimiseBounded(part, HUGE_VAL, kShapeIterations, &body.centers);
      if (!done) return false;
      bodies.push_back(std::move(body));
    }
    // Each in turn is the frame, until something moves with one.
    for (std::size_t frame = 0; frame + 2 < bodies.size(); ++frame) {
      const std::vector<Body> rest(bodies.begin() + frame, bodies.end());
      const auto placements = CloseBodies(rest);
      bool merged = false;
      for (std::size_t b = 1; b < rest.size(); ++b) {
        if (!placements[b]) continue;
        Merge(edge_of_part[frame], edge_of_part[frame + b]);
        merged = true;
      }
      if (merged) return true;
    }
    return false;
  }

  const std::vector<DirectionEdge>& edges_;
  std::vector<std::vector<std::size_t>> incident_;
  UnionFind sets_;
  std::vector<char> is_single_;  // per root: a body of one edge, itself
};

}  // namespace

std::vector<std::size_t> LabelRigidEdges(const TranslationProblem& problem) {
  return Merger(problem).Run();
}

}  // namespace lowlap
