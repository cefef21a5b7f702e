#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct GlobalPositioningOptions {
  /// Shorter tracks are left out. The paper's program asks for 3; with 2, pairs
  /// of views take part that share a track with no third view.
  std::size_t min_views_per_track = 3;
  /// A view must share this many points with views that are placed.
  std::size_t min_shared_points = 5;
  double huber_reach = 0.1;
  /// Rays that miss their point by more are dropped after the first solution;
  /// 180: none, and no second one.
  double max_angle_deg = 1.0;
  int max_iterations = 200;
  /// Centres to start from, one per view; empty: random ones (context.seed).
  std::vector<Vec3> start;

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("min_views_per_track", &min_views_per_track,
          "shorter tracks are left out");
    visit("min_shared_points", &min_shared_points,
          "a view must share so many points with those that are placed");
    visit("huber_reach", &huber_reach, "where Huber's loss turns");
    visit("max_angle_deg", &max_angle_deg,
          "rays that miss their point by more are dropped after the first "
          "solution; 180: none");
    visit("max_iterations", &max_iterations, "at most so many iterations");
  }
};

/// Centres and points together from the rays of tracks (Pan, Barath, Pollefeys,
/// Schönberger, "Global structure-from-motion revisited", ECCV 2024, section
/// 3.2):
///   min over C, X, s >= 0  sum rho( | ray_ik - s_ik (X_k - C_i) |^2 ),
/// rho: Huber. The residual lies in [0, 1] for the best s, hence is bounded for
/// wrong matches too, and close to linear in what is unknown, hence a random
/// start (uniform in a cube, context.seed) is good enough on well connected
/// views. Levenberg-Marquardt; s and X are eliminated from each step. Edges and
/// ratios are not used.
///
/// Huber's loss turns at 0.1, 6 degrees: a few percent of wrong rays then still
/// move the optimum by as much as the tracks' flat directions allow, metres in
/// a courtyard. As published, rays that miss their point by more than a degree
/// are therefore dropped. The published program goes on to rounds of bundle
/// adjustment with tighter bounds; here the centres are solved once more from
/// the remaining rays, from where they are, since no points are handed on.
///
/// Tracks that three views do not share leave scales open, which the
/// minimisation would set at random. Views are therefore grouped before either
/// solution: two views that share `min_shared_points` start a group, a view
/// joins that sees as many points that two views of the group see. Each group
/// is a component; a view in no group is not placed.
class GlobalPositioningAverager : public TranslationAverager {
 public:
  explicit GlobalPositioningAverager(GlobalPositioningOptions options = {})
      : options_(std::move(options)) {}
  std::string Name() const override { return "global_positioning"; }
  bool NeedsTracks() const override { return true; }
  std::string Needs() const override {
    return std::to_string(options_.min_shared_points) +
           " points that two placed views see, on tracks of at least " +
           std::to_string(options_.min_views_per_track) + " views";
  }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;

 private:
  GlobalPositioningOptions options_;
};

}  // namespace lowlap
