#include "lowlap/averaging/rigidity/internal/scale_articulations.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/rigidity/internal/rigid_parts.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

/// A meaningful ratio between two groups of by_directions ("parts").
struct CrossRatio {
  std::size_t ratio = 0;  // index into the ratios
  ViewId view = kInvalidId;
  std::size_t first_edge = 0, second_edge = 0;
  bool is_weak = false;
};

class ArticulationFinder {
 public:
  ArticulationFinder(const std::vector<ScaleRatio>& ratios,
                     const ScaleDiagnosis& diagnosis,
                     const DiagnosisOptions& options)
      : all_ratios_(ratios), num_parts_(diagnosis.by_directions.groups.size()) {
    std::map<ViewPair, std::size_t> index;
    for (std::size_t p = 0; p < num_parts_; ++p) {
      for (const ViewPair& edge : diagnosis.by_directions.groups[p].edges) {
        index[edge] = edges_.size();
        edges_.push_back(edge);
        part_.push_back(p);
      }
    }
    group_.resize(edges_.size());
    for (std::size_t g = 0; g < diagnosis.by_ratios.groups.size(); ++g) {
      for (const ViewPair& edge : diagnosis.by_ratios.groups[g].edges) {
        group_[index.at(edge)] = g;
      }
    }
    for (std::size_t r = 0; r < ratios.size(); ++r) {
      const ScaleRatio& ratio = ratios[r];
      if (ratio.verdict != RatioVerdict::kMeaningful) continue;
      const ViewTriplet& views = ratio.views;
      const std::size_t a = index.at(OrderedPair(views.first, views.middle));
      const std::size_t b = index.at(OrderedPair(views.middle, views.last));
      if (part_[a] == part_[b]) continue;
      ratios_.push_back({r, views.middle, a, b, IsWeak(ratio, options)});
    }
  }

  std::vector<ScaleArticulation> Find() const {
    std::set<ViewId> cameras;
    for (const CrossRatio& ratio : ratios_) cameras.insert(ratio.view);
    std::vector<ScaleArticulation> articulations;
    for (const ViewId camera : cameras) {
      const Labels labels =
          LabelsWithout([&](const CrossRatio& r) { return r.view == camera; });
      std::map<std::size_t, Sides> sides_of_group = SidesOfGroups(labels);
      std::map<std::size_t, Sides> without_weak;
      for (auto& [group, sides] : sides_of_group) {
        if (sides.size() < 2) continue;
        if (without_weak.empty()) {
          without_weak = SidesOfGroups(LabelsWithout([&](const CrossRatio& r) {
            return r.view == camera && r.is_weak;
          }));
        }
        ScaleArticulation articulation =
            MakeArticulation(camera, group, labels, &sides);
        articulation.is_weak = without_weak.at(group).size() > 1;
        articulations.push_back(std::move(articulation));
      }
    }
    return articulations;
  }

 private:
  using Labels = std::vector<std::size_t>;                // by edge
  using Sides = std::map<std::size_t, std::set<ViewId>>;  // views by label

  template <class Predicate>
  Labels LabelsWithout(const Predicate& is_left_out) const {
    UnionFind parts(num_parts_);
    for (const CrossRatio& ratio : ratios_) {
      if (!is_left_out(ratio)) {
        parts.Union(part_[ratio.first_edge], part_[ratio.second_edge]);
      }
    }
    const Labels label_of_part = parts.Labels();
    Labels labels(edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      labels[e] = label_of_part[part_[e]];
    }
    if (!IsAnyGroupSplit(labels)) return labels;
    // What ratios no longer join, directions may.
    UnionFind sets(edges_.size());
    std::map<std::size_t, std::size_t> first_edge;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      sets.Union(e, first_edge.emplace(labels[e], e).first->second);
    }
    MergeRigidParts(edges_, &sets);
    return sets.Labels();
  }

  bool IsAnyGroupSplit(const Labels& labels) const {
    std::map<std::size_t, std::size_t> label_of_group;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto entry = label_of_group.emplace(group_[e], labels[e]).first;
      if (entry->second != labels[e]) return true;
    }
    return false;
  }

  std::map<std::size_t, Sides> SidesOfGroups(const Labels& labels) const {
    std::map<std::size_t, Sides> sides;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      sides[group_[e]][labels[e]].insert({edges_[e].first, edges_[e].second});
    }
    return sides;
  }

  ScaleArticulation MakeArticulation(ViewId camera, std::size_t group,
                                     const Labels& labels, Sides* sides) const {
    ScaleArticulation articulation;
    articulation.view = camera;
    for (auto& entry : *sides) {
      entry.second.erase(camera);
      articulation.parts.emplace_back(entry.second.begin(), entry.second.end());
    }
    std::stable_sort(
        articulation.parts.begin(), articulation.parts.end(),
        [](const auto& a, const auto& b) { return a.size() > b.size(); });
    for (const CrossRatio& ratio : ratios_) {
      if (ratio.view == camera && group_[ratio.first_edge] == group &&
          labels[ratio.first_edge] != labels[ratio.second_edge]) {
        articulation.ratios.push_back(ratio.ratio);
      }
    }
    SortByEvidence(all_ratios_, &articulation.ratios);
    return articulation;
  }

  const std::vector<ScaleRatio>& all_ratios_;
  std::size_t num_parts_;
  std::vector<ViewPair> edges_;
  std::vector<std::size_t> part_;   // of each edge, in by_directions
  std::vector<std::size_t> group_;  // of each edge, in by_ratios
  std::vector<CrossRatio> ratios_;
};

}  // namespace

std::vector<ScaleArticulation> FindScaleArticulations(
    const std::vector<ScaleRatio>& ratios, const ScaleDiagnosis& diagnosis,
    const DiagnosisOptions& options) {
  return ArticulationFinder(ratios, diagnosis, options).Find();
}

void SortByEvidence(const std::vector<ScaleRatio>& ratios,
                    std::vector<std::size_t>* indices) {
  std::stable_sort(indices->begin(), indices->end(),
                   [&](std::size_t a, std::size_t b) {
                     return ratios[a].log10_nfa < ratios[b].log10_nfa;
                   });
}

}  // namespace lowlap
