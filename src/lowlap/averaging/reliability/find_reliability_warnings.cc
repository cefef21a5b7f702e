#include "lowlap/averaging/reliability/internal/find_reliability_warnings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/averaging/rigidity/internal/scale_articulations.h"
#include "lowlap/core/internal/union_find.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

bool Contains(const std::vector<ViewPair>& sorted, const ViewPair& views) {
  return std::binary_search(sorted.begin(), sorted.end(), views);
}

class Warnings {
 public:
  using RatioTriplets = std::vector<ViewTriplet>;

  Warnings(const Scene& scene, const SolutionAgreement& agreement,
           const AdjustedEvidence& adjusted)
      : scene_(scene), agreement_(agreement), adjusted_(adjusted) {
    std::map<ViewTriplet, const ScaleRatio*> ratios;
    for (const ScaleRatio& ratio : scene.scale_ratios) {
      ratios.emplace(ratio.views, &ratio);
    }
    for (const ViewTriplet& views : agreement.agreeing_ratios) {
      agreeing_ratios_.push_back(*ratios.at(views));
      const auto found = adjusted.ratios.find(views);
      if (found == adjusted.ratios.end()) continue;
      Sharpen(found->second, &agreeing_ratios_.back());
    }
    for (const ViewTriplet& views : agreement.rejected_ratios) {
      rejected_ratios_.push_back(*ratios.at(views));
    }
    const auto is_known = [&](const ViewPair& views) { return IsKnown(views); };
    std::remove_copy_if(agreement.vague.begin(), agreement.vague.end(),
                        std::back_inserter(vague_), is_known);
    std::remove_copy_if(agreement.untold.begin(), agreement.untold.end(),
                        std::back_inserter(untold_), is_known);
  }

  /// The views that most evidence contradicts.
  std::vector<ReliabilityWarning> ContradictedPoses() const {
    std::map<ViewId, double> balance;
    std::map<ViewId, std::vector<ViewPair>> against;
    for (const auto& [views, pose] : scene_.relative_poses) {
      if (!IsPlaced(views.first) || !IsPlaced(views.second) ||
          Contains(agreement_.refuted, views)) {
        continue;
      }
      const bool agrees = Contains(agreement_.agreeing, views);
      for (const ViewId view : {views.first, views.second}) {
        balance[view] += (agrees ? 1 : -1) * EvidenceOfNfa(pose.log10_nfa);
        if (!agrees) against[view].push_back(views);
      }
    }
    std::vector<ReliabilityWarning> warnings;
    for (const auto& [view, value] : balance) {
      if (value >= 0) continue;
      ReliabilityWarning warning;
      warning.reason = WarningReason::kContradictedPoses;
      warning.views = {view};
      warning.against = against[view];
      warnings.push_back(std::move(warning));
    }
    return warnings;
  }

  /// The views that hang on what is weak, untold or contradicted.
  /// `evidence` becomes what the firm ones stand on.
  std::vector<ReliabilityWarning> DoubtfulPlaces(FirmEvidence* evidence) const {
    std::vector<ReliabilityWarning> warnings;
    RatioTriplets strong, all;
    for (const ScaleRatio& ratio : agreeing_ratios_) {
      all.push_back(ratio.views);
      if (!IsWeak(ratio)) strong.push_back(ratio.views);
    }
    ReliabilityWarning untold;
    untold.reason = WarningReason::kUntoldPoses;
    untold.untold = Unconfirmed(strong);
    const ViewGraph told = Graph(untold.untold);
    *evidence = {told.pairs(), strong};
    const RigidityReport groups = Analyze(told, strong);
    if (groups.groups.empty()) {
      untold.views = agreement_.placed;
      if (!untold.untold.empty()) warnings.push_back(std::move(untold));
      return warnings;
    }
    // Two views hold each other whatever is wrong: of more, no third bears them
    // out.
    if (agreement_.placed.size() == 2 && scene_.views.size() > 2) {
      warnings.push_back(Unheld({}));
      warnings.back().views = agreement_.placed;
      return warnings;
    }
    const RigidGroup& firm = groups.groups.front();
    std::vector<ViewId> held;
    // By what sets fewer things aside, one after the other.
    const auto warn = [&](const std::vector<ViewId>& wider,
                          ReliabilityWarning warning) {
      // Two views hold each other whatever is wrong.
      if (wider.size() <= 2 && agreement_.placed.size() > 2) return;
      std::set_difference(wider.begin(), wider.end(), held.begin(), held.end(),
                          std::back_inserter(warning.views));
      held = wider;
      KeepThoseOf(warning.views, &warning.untold);
      if (!warning.views.empty()) warnings.push_back(std::move(warning));
    };
    if (firm.views.size() > 2) held = firm.views;
    if (firm.views.size() < agreement_.placed.size()) {
      const RigidityReport by_strong = Analyze(Graph({}), strong);
      ReliabilityWarning weak;
      warn(GroupOf(firm.edges.front(), by_strong), std::move(untold));
      weak.reason = WarningReason::kWeakScale;
      weak.ratios = WeakRatios(by_strong);
      warn(GroupOf(firm.edges.front(), Analyze(Graph({}), all)),
           std::move(weak));
      warn(agreement_.placed, Unheld(held));
      // The last warning says what joins the parts, which share a view. Fewer
      // than three views are named already.
      if (firm.views.size() > 2 &&
          2 * firm.views.size() <= agreement_.placed.size() + 1) {
        AddViews(firm.views, &warnings.back());
      }
    }
    const auto diagnosis = DiagnoseScales(Graph({}), agreeing_ratios_);
    if (!diagnosis) return warnings;
    for (const ScaleArticulation& articulation :
         diagnosis->articulation_views) {
      ReliabilityWarning warning = ContradictedArticulation(articulation);
      if (!warning.ratios.empty()) warnings.push_back(std::move(warning));
    }
    return warnings;
  }

 private:
  bool IsPlaced(ViewId view) const {
    return std::binary_search(agreement_.placed.begin(),
                              agreement_.placed.end(), view);
  }

  // A direction, by the structure, and not by chance. Copies of a pattern have
  // a structure of their own.
  bool IsKnown(const ViewPair& views) const {
    if (scene_.relative_poses.at(views).weakness == PoseWeakness::kRepeats) {
      return false;
    }
    const auto stddev = adjusted_.direction_stddevs_rad.find(views);
    if (stddev == adjusted_.direction_stddevs_rad.end() ||
        stddev->second > DiagnosisOptions().max_stddev) {
      return false;
    }
    const auto evidence = adjusted_.evidence_of_pairs.find(views);
    return evidence != adjusted_.evidence_of_pairs.end() &&
           evidence->second <= DiagnosisOptions().max_log10_nfa &&
           !IsContradicted(views.first) && !IsContradicted(views.second);
  }

  bool IsContradicted(ViewId view) const {
    return adjusted_.contradicted.count(view) > 0;
  }

  // Unless the structure knows the ratio itself.
  bool IsWeak(const ScaleRatio& ratio) const {
    if (!lowlap::IsWeak(ratio, {})) return false;
    const auto adjusted = adjusted_.ratios.find(ratio.views);
    return adjusted == adjusted_.ratios.end() ||
           adjusted->second.log_ratio_stddev > DiagnosisOptions().max_stddev ||
           IsContradicted(ratio.views.first) ||
           IsContradicted(ratio.views.middle) ||
           IsContradicted(ratio.views.last) ||
           !(IsSeen(ratio) || IsMeasuredAgain(adjusted->second, ratio.views));
  }

  // In three views, beyond chance.
  bool IsSeen(const ScaleRatio& ratio) const {
    const auto evidence = adjusted_.evidence_of_triplets.find(ratio.views);
    return ratio.HasMajority() &&
           evidence != adjusted_.evidence_of_triplets.end() &&
           evidence->second <= DiagnosisOptions().max_log10_nfa;
  }

  bool IsMeasuredAgain(const AdjustedEvidence::Ratio& adjusted,
                       const ViewTriplet& views) const {
    const auto again = adjusted_.measured_again.find(views);
    if (again == adjusted_.measured_again.end()) return false;
    // How well the adjustment knows it is asked already.
    DiagnosisOptions options;
    options.max_stddev = std::numeric_limits<double>::infinity();
    return !lowlap::IsWeak(again->second, options) &&
           std::abs(again->second.log_ratio - adjusted.log_ratio) <=
               DiagnosisOptions().max_stddev;
  }

  // Unless the adjusted centres contradict it.
  static void Sharpen(const AdjustedEvidence::Ratio& adjusted,
                      ScaleRatio* ratio) {
    constexpr double kReach = 3;
    const double error = std::abs(adjusted.log_ratio - ratio->log_ratio);
    if (error <= kReach * std::hypot(adjusted.log_ratio_stddev,
                                     ratio->log_ratio_stddev)) {
      ratio->log_ratio_stddev =
          std::min(ratio->log_ratio_stddev, adjusted.log_ratio_stddev);
    }
  }

  static void AddViews(const std::vector<ViewId>& views,
                       ReliabilityWarning* warning) {
    warning->views.insert(warning->views.end(), views.begin(), views.end());
    std::sort(warning->views.begin(), warning->views.end());
  }

  // The pairs with one of the views, which are sorted.
  static void KeepThoseOf(const std::vector<ViewId>& views,
                          std::vector<ViewPair>* pairs) {
    const auto is_elsewhere = [&](const ViewPair& pair) {
      return !std::binary_search(views.begin(), views.end(), pair.first) &&
             !std::binary_search(views.begin(), views.end(), pair.second);
    };
    pairs->erase(std::remove_if(pairs->begin(), pairs->end(), is_elsewhere),
                 pairs->end());
  }

  // What is in use and agrees, without some of it.
  ViewGraph Graph(const std::vector<ViewPair>& without) const {
    return ViewGraph(agreement_.held, agreement_.placed).WithoutPairs(without);
  }

  RigidityReport Analyze(const ViewGraph& graph,
                         const RatioTriplets& ratios) const {
    return AnalyzeRigidity(graph, ratios, agreement_.flat, agreement_.narrow);
  }

  static std::vector<ViewId> GroupOf(const ViewPair& edge,
                                     const RigidityReport& report) {
    for (const RigidGroup& group : report.groups) {
      if (std::binary_search(group.edges.begin(), group.edges.end(), edge)) {
        return group.views;
      }
    }
    return {};
  }

  static bool HoldsBoth(const RigidityReport& report, const ViewPair& pair) {
    const auto holds_both = [&](const RigidGroup& group) {
      const std::vector<ViewId>& views = group.views;
      return std::binary_search(views.begin(), views.end(), pair.first) &&
             std::binary_search(views.begin(), views.end(), pair.second);
    };
    return std::any_of(report.groups.begin(), report.groups.end(), holds_both);
  }

  // The vague and untold relative poses without which their views would not
  // hold each other by the strong ratios: a weak ratio rests on the poses that
  // it would confirm. Untold poses may confirm each other, vague ones cannot.
  // What holds without any of them holds without one: most need no analysis of
  // their own.
  std::vector<ViewPair> Unconfirmed(const RatioTriplets& strong) const {
    std::vector<ViewPair> unconfirmed;
    std::vector<ViewPair> without = vague_;
    without.insert(without.end(), untold_.begin(), untold_.end());
    if (without.empty()) return unconfirmed;
    const RigidityReport told = Analyze(Graph(without), strong);
    for (const ViewPair& views : vague_) {
      if (!HoldsBoth(told, views)) unconfirmed.push_back(views);
    }
    for (const ViewPair& views : untold_) {
      if (HoldsBoth(told, views)) continue;
      without = vague_;
      without.push_back(views);
      if (!HoldsBoth(Analyze(Graph(without), strong), views)) {
        unconfirmed.push_back(views);
      }
    }
    std::sort(unconfirmed.begin(), unconfirmed.end());
    return unconfirmed;
  }

  // Those between groups of the strong ones.
  std::vector<ViewTriplet> WeakRatios(const RigidityReport& strong) const {
    std::vector<ViewTriplet> weak;
    for (const ScaleRatio& ratio : agreeing_ratios_) {
      const ViewTriplet& v = ratio.views;
      if (IsWeak(ratio) && GroupOf(OrderedPair(v.first, v.middle), strong) !=
                               GroupOf(OrderedPair(v.middle, v.last), strong)) {
        weak.push_back(v);
      }
    }
    return weak;
  }

  // What contradicts, about the views that are not held.
  ReliabilityWarning Unheld(const std::vector<ViewId>& held) const {
    const auto is_held = [&](ViewId view) {
      return std::binary_search(held.begin(), held.end(), view);
    };
    ReliabilityWarning warning;
    for (const ViewPair& views : agreement_.contradicting) {
      if (!is_held(views.first) || !is_held(views.second)) {
        warning.against.push_back(views);
      }
    }
    for (const ScaleRatio& ratio : rejected_ratios_) {
      const ViewTriplet& v = ratio.views;
      if (!is_held(v.first) || !is_held(v.last)) warning.ratios.push_back(v);
    }
    warning.reason = warning.against.empty() && !warning.ratios.empty()
                         ? WarningReason::kContradictedRatios
                         : WarningReason::kUnheld;
    return warning;
  }

  // The parts that only contradicted ratios join to the largest; without ratios
  // if there are none.
  ReliabilityWarning ContradictedArticulation(
      const ScaleArticulation& articulation) const {
    std::map<ViewId, std::size_t> part;
    for (std::size_t p = 0; p < articulation.parts.size(); ++p) {
      for (const ViewId view : articulation.parts[p]) part[view] = p;
    }
    struct Balance {
      double for_it = 0, against = 0;
      std::vector<ViewTriplet> rejected;
    };
    std::map<std::pair<std::size_t, std::size_t>, Balance> balances;
    const auto balance_of = [&](const ViewTriplet& views) -> Balance* {
      if (views.middle != articulation.view) return nullptr;
      const auto first = part.find(views.first), last = part.find(views.last);
      if (first == part.end() || last == part.end() ||
          first->second == last->second) {
        return nullptr;
      }
      return &balances[std::minmax(first->second, last->second)];
    };
    for (const std::size_t r : articulation.ratios) {
      const ScaleRatio& ratio = agreeing_ratios_[r];
      if (Balance* const balance = balance_of(ratio.views)) {
        balance->for_it += EvidenceOfNfa(ratio.log10_nfa);
      }
    }
    for (const ScaleRatio& ratio : rejected_ratios_) {
      if (Balance* const balance = balance_of(ratio.views)) {
        balance->against += EvidenceOfNfa(ratio.log10_nfa);
        balance->rejected.push_back(ratio.views);
      }
    }
    UnionFind joined(articulation.parts.size());
    for (const auto& [parts, balance] : balances) {
      if (2 * balance.against <= balance.for_it) {
        joined.Union(parts.first, parts.second);
      }
    }
    ReliabilityWarning warning;
    warning.reason = WarningReason::kContradictedRatios;
    for (const auto& [parts, balance] : balances) {
      if (joined.Find(parts.first) == joined.Find(parts.second)) continue;
      warning.ratios.insert(warning.ratios.end(), balance.rejected.begin(),
                            balance.rejected.end());
    }
    for (std::size_t p = 1; p < articulation.parts.size(); ++p) {
      if (joined.Find(p) != joined.Find(0)) {
        AddViews(articulation.parts[p], &warning);
      }
    }
    return warning;
  }

  const Scene& scene_;
  const SolutionAgreement& agreement_;
  const AdjustedEvidence& adjusted_;
  std::vector<ScaleRatio> agreeing_ratios_, rejected_ratios_;
  std::vector<ViewPair> vague_, untold_;
};

}  // namespace

std::vector<ReliabilityWarning> FindReliabilityWarnings(
    const Scene& scene, const SolutionAgreement& agreement,
    const AdjustedEvidence& adjusted, FirmEvidence* firm) {
  const Warnings all(scene, agreement, adjusted);
  std::vector<ReliabilityWarning> warnings = all.ContradictedPoses();
  for (ReliabilityWarning& warning : all.DoubtfulPlaces(firm)) {
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace lowlap
