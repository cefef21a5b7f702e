#include "lowlap/averaging/internal/reliability_warnings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/averaging/rigidity/internal/scale_articulations.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

double Evidence(double log10_nfa) { return 1 + std::max(0.0, -log10_nfa); }

// Like a ratio that is too unsure to rely on alone (IsWeak): by its own
// covariance it would agree with anything.
bool IsVague(const RelativePose& pose) {
  return std::max(RotationStddev(pose), DirectionStddev(pose)) >
         DiagnosisOptions().max_stddev;
}

/// What of the measurements agrees with component 0 of a solution.
class Agreement {
 public:
  using RatioTriplets = std::vector<ViewTriplet>;

  Agreement(const Scene& scene, const TranslationProblem& problem,
            const TranslationSolution& solution, const MatchVerdicts& matches,
            const ReliabilityOptions& options)
      : scene_(scene),
        problem_(problem),
        solution_(solution),
        options_(options),
        refuted_(matches.refuted.begin(), matches.refuted.end()) {
    for (std::size_t n = 0; n < problem.views.size(); ++n) {
      if (solution.component[n] == 0) placed_.insert(problem.views[n]);
    }
    for (const DirectionEdge& edge : problem.edges) {
      if (!IsPlaced(edge)) continue;
      const double limit_rad =
          options.reach *
          std::max(options.direction_stddev_rad, edge.stddev_rad);
      const double error_rad = ErrorRad(edge);
      if (error_rad <= limit_rad) agreeing_.insert(ViewsOf(edge));
      const bool is_held =
          error_rad <= std::max(limit_rad, 3 * options.least_false_rad);
      (is_held ? in_use_ : contradicting_).push_back(ViewsOf(edge));
    }
    const std::set<ViewPair> untold(matches.untold.begin(),
                                    matches.untold.end());
    for (const ViewPair& views : in_use_) {
      if (IsVague(scene.relative_poses.at(views))) {
        vague_.push_back(views);
      } else if (untold.count(views) > 0) {
        untold_.push_back(views);
      }
    }
    SplitRatios();
  }

  /// The views that most evidence contradicts.
  std::vector<ReliabilityWarning> ContradictedPoses() const {
    std::map<ViewId, double> balance;
    std::map<ViewId, std::vector<ViewPair>> against;
    for (const auto& [views, pose] : scene_.relative_poses) {
      if (placed_.count(views.first) == 0 || placed_.count(views.second) == 0) {
        continue;
      }
      if (refuted_.count(views) > 0) continue;
      const bool agrees = agreeing_.count(views) > 0;
      for (const ViewId view : {views.first, views.second}) {
        balance[view] += (agrees ? 1 : -1) * Evidence(pose.log10_nfa);
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
      if (!IsWeak(ratio, {})) strong.push_back(ratio.views);
    }
    ReliabilityWarning untold;
    untold.reason = WarningReason::kUntoldPoses;
    untold.untold = Unconfirmed(strong);
    const ViewGraph told = Graph(untold.untold);
    *evidence = {told.pairs(), strong, {}};
    for (const ScaleRatio& ratio : rejected_ratios_) {
      evidence->rejected_ratios.push_back(ratio.views);
    }
    const RigidityReport groups = AnalyzeRigidity(told, strong);
    if (groups.groups.empty()) {
      untold.views.assign(placed_.begin(), placed_.end());
      if (!untold.untold.empty()) warnings.push_back(std::move(untold));
      return warnings;
    }
    // Two views hold each other whatever is wrong: of more, no third bears them
    // out.
    if (placed_.size() == 2 && scene_.views.size() > 2) {
      warnings.push_back(Unheld({}));
      warnings.back().views.assign(placed_.begin(), placed_.end());
      return warnings;
    }
    const RigidGroup& firm = groups.groups.front();
    std::vector<ViewId> held;
    // By what sets fewer things aside, one after the other.
    const auto warn = [&](const std::vector<ViewId>& wider,
                          ReliabilityWarning warning) {
      // Two views hold each other whatever is wrong.
      if (wider.size() <= 2 && placed_.size() > 2) return;
      std::set_difference(wider.begin(), wider.end(), held.begin(), held.end(),
                          std::back_inserter(warning.views));
      held = wider;
      KeepThoseOf(warning.views, &warning.untold);
      if (!warning.views.empty()) warnings.push_back(std::move(warning));
    };
    if (firm.views.size() > 2) held = firm.views;
    if (firm.views.size() < placed_.size()) {
      const RigidityReport by_strong = AnalyzeRigidity(Graph({}), strong);
      ReliabilityWarning weak;
      warn(GroupOf(firm.edges.front(), by_strong), std::move(untold));
      weak.reason = WarningReason::kWeakScale;
      weak.ratios = WeakRatios(by_strong);
      warn(GroupOf(firm.edges.front(), AnalyzeRigidity(Graph({}), all)),
           std::move(weak));
      warn({placed_.begin(), placed_.end()}, Unheld(held));
      // The last warning says what joins the parts. Fewer than three views are
      // named already.
      if (firm.views.size() > 2 && 2 * firm.views.size() <= placed_.size()) {
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
  ViewPair ViewsOf(const DirectionEdge& edge) const {
    return OrderedPair(problem_.views[edge.first], problem_.views[edge.second]);
  }

  Vec3 Baseline(const DirectionEdge& edge) const {
    return solution_.center_in_world[edge.second] -
           solution_.center_in_world[edge.first];
  }

  bool IsPlaced(const DirectionEdge& edge) const {
    return solution_.component[edge.first] == 0 &&
           solution_.component[edge.second] == 0;
  }

  double ErrorRad(const DirectionEdge& edge) const {
    const Vec3 baseline = Baseline(edge);
    return baseline.norm() > 0 ? AngleBetween(baseline, edge.direction_in_world)
                               : kPi;
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
    return ViewGraph(in_use_, {placed_.begin(), placed_.end()})
        .WithoutPairs(without);
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
    const RigidityReport told = AnalyzeRigidity(Graph(without), strong);
    for (const ViewPair& views : vague_) {
      if (!HoldsBoth(told, views)) unconfirmed.push_back(views);
    }
    for (const ViewPair& views : untold_) {
      if (HoldsBoth(told, views)) continue;
      without = vague_;
      without.push_back(views);
      if (!HoldsBoth(AnalyzeRigidity(Graph(without), strong), views)) {
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
      if (IsWeak(ratio, {}) &&
          GroupOf(OrderedPair(v.first, v.middle), strong) !=
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
    for (const ViewPair& views : contradicting_) {
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

  void SplitRatios() {
    std::map<ViewTriplet, const ScaleRatio*> ratios;
    for (const ScaleRatio& ratio : scene_.scale_ratios) {
      ratios.emplace(ratio.views, &ratio);
    }
    const std::set<ViewPair> in_use(in_use_.begin(), in_use_.end());
    std::vector<std::pair<const ScaleRatio*, double>> errors;
    std::vector<double> normalised;
    for (const RatioMeasurement& used : problem_.ratios) {
      const auto ratio = ratios.find(used.views);
      const DirectionEdge& from = problem_.edges[used.reference];
      const DirectionEdge& to = problem_.edges[used.target];
      if (ratio == ratios.end() || in_use.count(ViewsOf(from)) == 0 ||
          in_use.count(ViewsOf(to)) == 0) {
        continue;
      }
      const double error =
          std::abs(std::log(Baseline(to).norm() / Baseline(from).norm()) -
                   used.log_ratio);
      errors.emplace_back(ratio->second, error / used.stddev);
      normalised.push_back(errors.back().second);
    }
    const double scale =
        std::max(1.0, Median(std::move(normalised)) / kMedianOfNorm<1>);
    // As DiagnosisOptions::max_stddev: less does not make a ratio useless.
    constexpr double kTenth = 0.1;
    for (const auto& [ratio, error] : errors) {
      const double stddev = std::max(ratio->log_ratio_stddev, kRatioErrorFloor);
      const bool agrees =
          error <= std::max(options_.reach * scale, kTenth / stddev);
      (agrees ? agreeing_ratios_ : rejected_ratios_).push_back(*ratio);
    }
  }

  // Without ratios if those across the articulation agree well enough.
  ReliabilityWarning ContradictedArticulation(
      const ScaleArticulation& articulation) const {
    std::map<ViewId, std::size_t> part;
    for (std::size_t p = 0; p < articulation.parts.size(); ++p) {
      for (const ViewId view : articulation.parts[p]) part[view] = p;
    }
    double for_it = 0, against = 0;
    for (const std::size_t r : articulation.ratios) {
      for_it += Evidence(agreeing_ratios_[r].log10_nfa);
    }
    ReliabilityWarning warning;
    warning.reason = WarningReason::kContradictedRatios;
    for (const ScaleRatio& ratio : rejected_ratios_) {
      if (ratio.views.middle != articulation.view) continue;
      const auto first = part.find(ratio.views.first);
      const auto last = part.find(ratio.views.last);
      if (first == part.end() || last == part.end() ||
          first->second == last->second) {
        continue;
      }
      against += Evidence(ratio.log10_nfa);
      warning.ratios.push_back(ratio.views);
    }
    if (2 * against <= for_it) warning.ratios.clear();
    for (std::size_t p = 1; p < articulation.parts.size(); ++p) {
      warning.views.insert(warning.views.end(), articulation.parts[p].begin(),
                           articulation.parts[p].end());
    }
    std::sort(warning.views.begin(), warning.views.end());
    return warning;
  }

  const Scene& scene_;
  const TranslationProblem& problem_;
  const TranslationSolution& solution_;
  const ReliabilityOptions options_;
  std::set<ViewId> placed_;
  std::set<ViewPair> refuted_, agreeing_;
  std::vector<ViewPair> in_use_, contradicting_, vague_, untold_;
  std::vector<ScaleRatio> agreeing_ratios_, rejected_ratios_;
};

}  // namespace

std::vector<ReliabilityWarning> FindReliabilityWarnings(
    const Scene& scene, const TranslationProblem& problem,
    const TranslationSolution& solution, const MatchVerdicts& matches,
    const ReliabilityOptions& options, FirmEvidence* firm) {
  const Agreement agreement(scene, problem, solution, matches, options);
  std::vector<ReliabilityWarning> warnings = agreement.ContradictedPoses();
  for (ReliabilityWarning& warning : agreement.DoubtfulPlaces(firm)) {
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace lowlap
