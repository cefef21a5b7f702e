#include "lowlap/averaging/reliability/internal/solution_agreement.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/internal/problem_errors.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/averaging/strategies/internal/component_closure.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Half the way to another motion is as far as an undecided one may be off.
bool IsVague(const RelativePose& pose) {
  return std::max({RotationStddev(pose), DirectionStddev(pose),
                   0.5 * MotionSpread(pose)}) > DiagnosisOptions().max_stddev;
}

// Holds measurements against the centres of component 0.
class Comparison {
 public:
  Comparison(const Scene& scene, const TranslationProblem& problem,
             const TranslationSolution& solution,
             const AgreementOptions& options)
      : scene_(scene),
        problem_(problem),
        solution_(solution),
        options_(options) {}

  void SplitPoses(SolutionAgreement* agreement) const {
    for (const DirectionEdge& edge : problem_.edges) {
      if (!IsPlaced(solution_, edge)) continue;
      const double error_rad = DirectionErrorRad(solution_, edge);
      const auto is_within = [&](double least_false_rad) {
        return error_rad <=
               ErrorLimits{options_.reach, least_false_rad}.DirectionRad(
                   options_.direction_stddev_rad, edge.stddev_rad);
      };
      if (is_within(0)) agreement->agreeing.push_back(ViewsOf(problem_, edge));
      const bool is_held = is_within(options_.least_false_rad);
      (is_held ? agreement->held : agreement->contradicting)
          .push_back(ViewsOf(problem_, edge));
    }
    std::sort(agreement->agreeing.begin(), agreement->agreeing.end());
  }

  void FindThinTriangles(SolutionAgreement* agreement) const {
    std::map<ViewPair, const DirectionEdge*> edges;
    for (const DirectionEdge& edge : problem_.edges) {
      edges.emplace(ViewsOf(problem_, edge), &edge);
    }
    const auto outwards = [&](ViewId from, const DirectionEdge& edge) -> Vec3 {
      return problem_.views[edge.first] == from
                 ? edge.direction_in_world
                 : Vec3(-edge.direction_in_world);
    };
    for (const auto& views : FindTriangles(ViewGraph(agreement->held))) {
      int num_flat = 0, flat = 0, middle = 0, far = 0;
      double least_cosine = 1, longest = 0, shortest = kInfinity;
      double stddev_rad = 0;  // of the sides at the far view
      for (int n = 0; n < 3; ++n) {
        const ViewId at = views[n];
        const DirectionEdge& a = *edges.at(OrderedPair(at, views[(n + 1) % 3]));
        const DirectionEdge& b = *edges.at(OrderedPair(at, views[(n + 2) % 3]));
        const DirectionEdge& opposite =
            *edges.at(OrderedPair(views[(n + 1) % 3], views[(n + 2) % 3]));
        const double stddev_here_rad = std::max(a.stddev_rad, b.stddev_rad);
        const double length = BaselineOf(solution_, opposite).norm();
        longest = std::max(longest, length);
        if (length < shortest) {
          shortest = length;
          stddev_rad = stddev_here_rad;
          far = n;
        }
        const Vec3 to_a = outwards(at, a), to_b = outwards(at, b);
        if (to_a.cross(to_b).norm() < kSeparation * stddev_here_rad) {
          ++num_flat;
          flat = n;
        }
        if (to_a.dot(to_b) >= least_cosine) continue;
        least_cosine = to_a.dot(to_b);
        middle = n;
      }
      const auto triplet = [&](int n) -> ViewTriplet {
        return {views[(n + 1) % 3], views[n], views[(n + 2) % 3]};
      };
      if (num_flat > 1) {
        agreement->flat.push_back(triplet(middle));
        // Of lengths that are nearly equal, the difference is not known.
        if (shortest < kSeparation * stddev_rad * longest) {
          agreement->narrow.push_back(triplet(far));
        }
      } else if (num_flat == 1 && flat != middle) {
        agreement->narrow.push_back(triplet(flat));
      }
    }
  }

  void SplitRatios(SolutionAgreement* agreement) const {
    std::set<ViewTriplet> ratios;
    for (const ScaleRatio& ratio : scene_.scale_ratios) {
      ratios.insert(ratio.views);
    }
    const std::set<ViewPair> held(agreement->held.begin(),
                                  agreement->held.end());
    struct RatioError {
      ViewTriplet views;
      double error, stddev;
    };
    std::vector<RatioError> errors;
    std::vector<double> normalised;
    for (const RatioMeasurement& used : problem_.ratios) {
      const auto is_held = [&](std::size_t edge) {
        return held.count(ViewsOf(problem_, problem_.edges[edge])) > 0;
      };
      if (ratios.count(used.views) == 0 || !is_held(used.reference) ||
          !is_held(used.target)) {
        continue;
      }
      const double error = LogRatioError(problem_, solution_, used);
      errors.push_back({used.views, error, used.stddev});
      normalised.push_back(error / used.stddev);
    }
    const double scale =
        std::max(1.0, Median(std::move(normalised)) / kMedianOfNorm<1>);
    // As DiagnosisOptions::max_stddev: less does not make a ratio useless.
    constexpr double kTenth = 0.1;
    for (const auto& [views, error, stddev] : errors) {
      const bool agrees =
          error <= std::max(options_.reach * scale * stddev, kTenth);
      (agrees ? agreement->agreeing_ratios : agreement->rejected_ratios)
          .push_back(views);
    }
  }

 private:
  const Scene& scene_;
  const TranslationProblem& problem_;
  const TranslationSolution& solution_;
  const AgreementOptions& options_;
};

}  // namespace

SolutionAgreement FindAgreement(const Scene& scene,
                                const TranslationProblem& problem,
                                const TranslationSolution& solution,
                                const MatchVerdicts& matches,
                                const AgreementOptions& options) {
  SolutionAgreement agreement;
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution.component[n] == 0) {
      agreement.placed.push_back(problem.views[n]);
    }
  }
  std::sort(agreement.placed.begin(), agreement.placed.end());
  agreement.refuted = matches.refuted;
  std::sort(agreement.refuted.begin(), agreement.refuted.end());
  const Comparison comparison(scene, problem, solution, options);
  comparison.SplitPoses(&agreement);
  comparison.FindThinTriangles(&agreement);
  const std::set<ViewPair> untold(matches.untold.begin(), matches.untold.end());
  for (const ViewPair& views : agreement.held) {
    const RelativePose& pose = scene.relative_poses.at(views);
    if (IsVague(pose) || pose.weakness) {
      agreement.vague.push_back(views);
    } else if (untold.count(views) > 0) {
      agreement.untold.push_back(views);
    }
  }
  comparison.SplitRatios(&agreement);
  return agreement;
}

}  // namespace lowlap
