#include "lowlap/averaging/centers/internal/grown_centers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "lowlap/averaging/internal/problem_errors.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxPlaces = 10;

// Where a view may be, and the evidence for it and against it.
struct Place {
  Vec3 center = Vec3::Zero();
  double evidence = 0;
  double against = 0;

  double Balance() const { return evidence - against; }
};

class Growth {
 public:
  Growth(const TranslationProblem& problem, const EvidenceOfPairs& evidence,
         const ErrorLimits& limits)
      : problem_(problem),
        limits_(limits),
        edges_of_(problem.views.size()),
        ratios_of_(problem.edges.size()),
        contradicts_(problem.edges.size(), 0),
        best_(problem.views.size()),
        is_stale_(problem.views.size(), 0) {
    now_.component.assign(problem.views.size(), -1);
    now_.center_in_world.assign(problem.views.size(), Vec3::Zero());
    for (std::size_t n = 0; n < problem.edges.size(); ++n) {
      const DirectionEdge& edge = problem.edges[n];
      edges_of_[edge.first].push_back(n);
      edges_of_[edge.second].push_back(n);
      evidence_.push_back(evidence.at(ViewsOf(problem, edge)));
    }
    for (std::size_t n = 0; n < problem.ratios.size(); ++n) {
      ratios_of_[problem.ratios[n].reference].push_back(n);
      ratios_of_[problem.ratios[n].target].push_back(n);
    }
  }

  /// Begins with `first`, and further parts with the first of `seeds` that can.
  void Run(const RatioMeasurement& first,
           const std::vector<RatioMeasurement>& seeds) {
    BeginIfNew(first);
    for (const RatioMeasurement& seed : seeds) BeginIfNew(seed);
  }

  /// Of the relative poses that agree with the centres.
  double EvidenceFor() const {
    double sum = 0;
    for (std::size_t n = 0; n < problem_.edges.size(); ++n) {
      if (IsBorneOut(n)) sum += evidence_[n];
    }
    return sum;
  }

  std::vector<ViewPair> Contradictions() const {
    std::vector<ViewPair> result;
    for (std::size_t n = 0; n < problem_.edges.size(); ++n) {
      if (contradicts_[n]) {
        result.push_back(ViewsOf(problem_, problem_.edges[n]));
      }
    }
    return result;
  }

 private:
  bool IsUsed(std::size_t view) const { return now_.component[view] >= 0; }
  // In the part that grows.
  bool IsHere(std::size_t view) const {
    return now_.component[view] == now_.num_components;
  }
  std::size_t OtherEnd(std::size_t edge, std::size_t view) const {
    return problem_.edges[edge].first == view ? problem_.edges[edge].second
                                              : problem_.edges[edge].first;
  }

  // In one part, and not contradicted there.
  bool IsBorneOut(std::size_t n) const {
    const DirectionEdge& edge = problem_.edges[n];
    return IsUsed(edge.first) && !contradicts_[n] &&
           now_.component[edge.first] == now_.component[edge.second];
  }

  void BeginIfNew(const RatioMeasurement& seed) {
    const DirectionEdge& edge1 = problem_.edges[seed.reference];
    const DirectionEdge& edge2 = problem_.edges[seed.target];
    if (IsUsed(edge1.first) || IsUsed(edge1.second) || IsUsed(edge2.first) ||
        IsUsed(edge2.second)) {
      return;
    }
    Begin(seed);
    while (PlaceNext()) continue;
    ++now_.num_components;
  }

  void Begin(const RatioMeasurement& seed) {
    best_.assign(best_.size(), std::nullopt);
    is_stale_.assign(is_stale_.size(), 0);
    const DirectionEdge& target = problem_.edges[seed.target];
    std::size_t middle = problem_.edges[seed.reference].first;
    if (middle != target.first && middle != target.second) {
      middle = problem_.edges[seed.reference].second;
    }
    const std::size_t first = OtherEnd(seed.reference, middle);
    const std::size_t last = OtherEnd(seed.target, middle);
    PutAt(middle, Vec3::Zero());
    PutAt(first, Along(seed.reference, middle, 1));
    PutAt(last, Along(seed.target, middle, std::exp(seed.log_ratio)));
  }

  // The other end of the edge, so far from `view`.
  Vec3 Along(std::size_t edge, std::size_t view, double length) const {
    const Vec3 step = length * problem_.edges[edge].direction_in_world;
    return problem_.edges[edge].first == view
               ? Vec3(now_.center_in_world[view] + step)
               : Vec3(now_.center_in_world[view] - step);
  }

  void Set(std::size_t view, const Vec3& center) {
    now_.component[view] = now_.num_components;
    now_.center_in_world[view] = center;
  }

  void PutAt(std::size_t view, const Vec3& center) {
    Set(view, center);
    for (const std::size_t edge : edges_of_[view]) {
      const std::size_t other = OtherEnd(edge, view);
      if (!IsUsed(other)) {
        is_stale_[other] = 1;
      } else if (IsHere(other)) {
        contradicts_[edge] = !Agrees(edge);
        for (const std::size_t next : edges_of_[other]) {
          is_stale_[OtherEnd(next, other)] = 1;
        }
      }
    }
  }

  bool PlaceNext() {
    std::optional<std::size_t> next;
    for (std::size_t view = 0; view < problem_.views.size(); ++view) {
      if (IsUsed(view)) continue;
      if (is_stale_[view]) {
        best_[view] = BestPlace(view);
        is_stale_[view] = 0;
      }
      if (best_[view] &&
          (!next || best_[view]->evidence > best_[*next]->evidence)) {
        next = view;
      }
    }
    if (!next) return false;
    PutAt(*next, best_[*next]->center);
    return true;
  }

  // Nothing if no ratio says where it is.
  std::optional<Place> BestPlace(std::size_t view) {
    std::optional<Place> best;
    for (const Vec3& center : PlacesOf(view)) {
      const Place place = Weighed(view, center);
      if (!best || place.Balance() > best->Balance()) best = place;
    }
    return best;
  }

  // By the strongest ratios to what is placed.
  std::vector<Vec3> PlacesOf(std::size_t view) const {
    std::vector<std::pair<double, Vec3>> places;
    for (const std::size_t edge : edges_of_[view]) {
      const std::size_t from = OtherEnd(edge, view);
      if (!IsHere(from)) continue;
      for (const std::size_t n : ratios_of_[edge]) {
        const RatioMeasurement& ratio = problem_.ratios[n];
        const std::size_t known =
            ratio.target == edge ? ratio.reference : ratio.target;
        if (!IsBetweenPlaced(known) || contradicts_[known]) continue;
        const double log_ratio =
            ratio.target == edge ? ratio.log_ratio : -ratio.log_ratio;
        places.emplace_back(
            std::min(evidence_[edge], EvidenceOfNfa(ratio.log10_nfa)),
            Along(edge, from, LengthOf(known) * std::exp(log_ratio)));
      }
    }
    std::stable_sort(
        places.begin(), places.end(),
        [](const auto& a, const auto& b) { return a.first > b.first; });
    if (places.size() > kMaxPlaces) places.resize(kMaxPlaces);
    std::vector<Vec3> centers;
    for (const auto& [strength, center] : places) centers.push_back(center);
    return centers;
  }

  Place Weighed(std::size_t view, const Vec3& center) {
    Set(view, center);
    Place place{center, 0, 0};
    for (const std::size_t edge : edges_of_[view]) {
      if (!IsHere(OtherEnd(edge, view))) continue;
      (Agrees(edge) ? place.evidence : place.against) += evidence_[edge];
    }
    now_.component[view] = -1;
    return place;
  }

  bool IsBetweenPlaced(std::size_t edge) const {
    return IsHere(problem_.edges[edge].first) &&
           IsHere(problem_.edges[edge].second);
  }

  double LengthOf(std::size_t edge) const {
    return BaselineOf(now_, problem_.edges[edge]).norm();
  }

  bool DirectionAgrees(std::size_t edge) const {
    return DirectionErrorRad(now_, problem_.edges[edge]) <=
           limits_.DirectionRad(0, problem_.edges[edge].stddev_rad);
  }

  // Its ratios, too, to those whose directions agree. An error of a length is
  // one of a direction, along it and not across.
  bool Agrees(std::size_t edge) const {
    if (!DirectionAgrees(edge)) return false;
    double balance = 0;
    for (const std::size_t n : ratios_of_[edge]) {
      const RatioMeasurement& ratio = problem_.ratios[n];
      const std::size_t other =
          ratio.target == edge ? ratio.reference : ratio.target;
      if (!IsBetweenPlaced(other) || contradicts_[other] ||
          !DirectionAgrees(other)) {
        continue;
      }
      const double evidence = EvidenceOfNfa(ratio.log10_nfa);
      balance += RatioAgrees(ratio) ? evidence : -evidence;
    }
    return balance >= 0;
  }

  bool RatioAgrees(const RatioMeasurement& ratio) const {
    return LogRatioError(problem_, now_, ratio) <=
           limits_.DirectionRad(0, ratio.stddev);
  }

  const TranslationProblem& problem_;
  const ErrorLimits& limits_;
  std::vector<std::vector<std::size_t>> edges_of_;   // by view
  std::vector<std::vector<std::size_t>> ratios_of_;  // by edge
  std::vector<double> evidence_;                     // by edge
  std::vector<char> contradicts_;                    // by edge
  std::vector<std::optional<Place>> best_;           // by view
  std::vector<char> is_stale_;                       // by view: of best_
  // Its parts in their order; the one that grows is not counted yet.
  TranslationSolution now_;
};

std::vector<RatioMeasurement> StrongestFirst(const TranslationProblem& problem,
                                             const EvidenceOfPairs& evidence) {
  const auto evidence_of = [&](std::size_t edge) {
    return evidence.at(ViewsOf(problem, problem.edges[edge]));
  };
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t n = 0; n < problem.ratios.size(); ++n) {
    const RatioMeasurement& ratio = problem.ratios[n];
    order.emplace_back(
        -std::min({evidence_of(ratio.reference), evidence_of(ratio.target),
                   EvidenceOfNfa(ratio.log10_nfa)}),
        n);
  }
  std::sort(order.begin(), order.end());
  std::vector<RatioMeasurement> ratios;
  for (const auto& [strength, n] : order) ratios.push_back(problem.ratios[n]);
  return ratios;
}

}  // namespace

std::vector<ViewPair> ContradictionsOfGrowth(const TranslationProblem& problem,
                                             const EvidenceOfPairs& evidence,
                                             const ErrorLimits& limits,
                                             std::size_t max_starts) {
  const std::vector<RatioMeasurement> seeds = StrongestFirst(problem, evidence);
  std::vector<ViewPair> contradictions;
  double most = 0;
  for (std::size_t n = 0; n < std::min(seeds.size(), max_starts); ++n) {
    Growth growth(problem, evidence, limits);
    growth.Run(seeds[n], seeds);
    if (growth.EvidenceFor() <= most) continue;
    most = growth.EvidenceFor();
    contradictions = growth.Contradictions();
  }
  return contradictions;
}

}  // namespace lowlap
