#include "lowlap/averaging/strategies/internal/direction_merging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/strategies/internal/bounded_lengths.h"
#include "lowlap/averaging/strategies/internal/component_closure.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

// A ring is closed by dense algebra.
constexpr std::size_t kMaxRing = 100;

class Merger {
 public:
  Merger(const TranslationProblem& problem, const RunContext& context)
      : edges_(problem.edges),
        context_(context),
        incident_(problem.views.size()),
        sets_(problem.edges.size()),
        is_single_(problem.edges.size(), true) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      incident_[edges_[e].first].push_back(e);
      incident_[edges_[e].second].push_back(e);
    }
  }

  Result<std::vector<std::size_t>> Run() {
    for (std::size_t round = 0;; ++round) {
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context_, round, edges_.size()));
      if (MergeIntersections() || MergeSharedPairs()) continue;
      LOWLAP_ASSIGN_OR_RETURN(const auto merged, MergeRings());
      if (!merged) return sets_.Labels();
    }
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

  std::vector<std::size_t> ComponentsAt(std::size_t view) {
    std::vector<std::size_t> components;
    for (const std::size_t e : incident_[view])
      components.push_back(sets_.Find(e));
    std::sort(components.begin(), components.end());
    components.erase(std::unique(components.begin(), components.end()),
                     components.end());
    return components;
  }

  // A view that two directions from different views of one component intersect.
  // A component of one edge makes a triangle, all of whose angles must be open.
  bool MergeIntersections() {
    bool merged = false;
    std::vector<std::vector<std::size_t>> components_at(incident_.size());
    for (std::size_t v = 0; v < incident_.size(); ++v) {
      components_at[v] = ComponentsAt(v);
    }
    struct Ray {
      std::size_t component, from, edge;
    };
    for (std::size_t v = 0; v < incident_.size(); ++v) {
      std::vector<Ray> rays;
      for (const std::size_t e : incident_[v]) {
        const std::size_t from =
            edges_[e].first == v ? edges_[e].second : edges_[e].first;
        for (const std::size_t stale : components_at[from]) {
          const std::size_t component = sets_.Find(stale);
          if (component != sets_.Find(e)) rays.push_back({component, from, e});
        }
      }
      std::stable_sort(
          rays.begin(), rays.end(),
          [](const Ray& a, const Ray& b) { return a.component < b.component; });
      for (std::size_t begin = 0, end = 0; begin < rays.size(); begin = end) {
        while (end < rays.size() &&
               rays[end].component == rays[begin].component)
          ++end;
        // Merged a moment ago: the next round sees it.
        if (sets_.Find(rays[begin].component) != rays[begin].component)
          continue;
        for (std::size_t n = begin + 1; n < end; ++n) {
          const Ray &a = rays[begin], &b = rays[n];
          if (a.from == b.from || !AreSeparate(a.edge, b.edge)) continue;
          if (is_single_[a.component] && (!AreSeparate(a.edge, a.component) ||
                                          !AreSeparate(b.edge, a.component))) {
            continue;
          }
          Merge(a.component, a.edge);
          Merge(a.component, b.edge);
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
      const std::vector<std::size_t> components = ComponentsAt(v);
      for (std::size_t a = 0; a < components.size(); ++a) {
        for (std::size_t b = a + 1; b < components.size(); ++b) {
          if (first_view.insert({{components[a], components[b]}, v}).second)
            continue;
          Merge(components[a], components[b]);
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
    for (const auto& [component, edges] : members) {
      for (const std::size_t e : edges) {
        views_of[component].insert({edges_[e].first, edges_[e].second});
      }
      for (const std::size_t view : views_of[component]) ++uses[view];
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (auto component = views_of.begin(); component != views_of.end();) {
        const auto shared =
            std::count_if(component->second.begin(), component->second.end(),
                          [&](std::size_t view) { return uses[view] > 1; });
        if (shared >= 2) {
          ++component;
          continue;
        }
        for (const std::size_t view : component->second) --uses[view];
        component = views_of.erase(component);
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
    for (const std::size_t component : order) {
      parts.push_back(MakePart(edges_, members[component]));
      edge_of_part->push_back(component);
    }
    return parts;
  }

  Result<bool> MergeRings() {
    std::vector<std::size_t> edge_of_part;
    std::vector<RigidComponent> components;
    for (const DirectionPart& part : PartsInRings(&edge_of_part)) {
      RigidComponent component;
      component.stddev_rad = 0;
      for (const DirectionEdge& edge : part.edges) {
        component.stddev_rad = std::max(component.stddev_rad, edge.stddev_rad);
      }
      component.views = part.views;
      constexpr int kShapeIterations = 50;
      int num_iterations = 0;
      auto centers = SolveBoundedLengths(part, {HUGE_VAL, kShapeIterations},
                                         context_, &num_iterations);
      if (!centers && centers.error().code == ErrorCode::kCancelled) {
        return tl::unexpected<Error>(centers.error());
      }
      if (!centers) return false;
      component.centers = std::move(*centers);
      components.push_back(std::move(component));
    }
    // Each in turn is the frame, until something moves with one.
    for (std::size_t frame = 0; frame + 2 < components.size(); ++frame) {
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context_, frame, components.size()));
      const std::vector<RigidComponent> rest(components.begin() + frame,
                                             components.end());
      const auto placements = CloseComponents(rest);
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
  const RunContext& context_;
  std::vector<std::vector<std::size_t>> incident_;
  UnionFind sets_;
  std::vector<char> is_single_;  // per root: a component of one edge, itself
};

}  // namespace

Result<std::vector<std::size_t>> LabelRigidEdges(
    const TranslationProblem& problem, const RunContext& context) {
  return Merger(problem, context).Run();
}

}  // namespace lowlap
