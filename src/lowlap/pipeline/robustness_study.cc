#include "lowlap/pipeline/robustness_study.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/averaging/strategies.h"
#include "lowlap/core/median.h"
#include "lowlap/core/parallel.h"
#include "lowlap/core/random.h"
#include "lowlap/geometry/rotation.h"
#include "lowlap/scale/scale_ratios.h"

namespace lowlap {
namespace {

struct Placement {
  double scale = 1;
  Vec3 translation = Vec3::Zero();
};

Placement WeightedFit(const std::vector<Vec3>& from,
                      const std::vector<Vec3>& to,
                      const std::vector<double>& weights) {
  Vec3 from_mean = Vec3::Zero(), to_mean = Vec3::Zero();
  double total = 0;
  for (std::size_t n = 0; n < from.size(); ++n) {
    from_mean += weights[n] * from[n];
    to_mean += weights[n] * to[n];
    total += weights[n];
  }
  from_mean /= total;
  to_mean /= total;
  double dot = 0, square = 0;
  for (std::size_t n = 0; n < from.size(); ++n) {
    dot += weights[n] * (from[n] - from_mean).dot(to[n] - to_mean);
    square += weights[n] * (from[n] - from_mean).squaredNorm();
  }
  Placement fit;
  fit.scale = square > 0 ? std::max(dot / square, 0.0) : 0.0;
  fit.translation = to_mean - fit.scale * from_mean;
  return fit;
}

std::vector<double> Distances(const std::vector<Vec3>& from,
                              const std::vector<Vec3>& to,
                              const Placement& fit) {
  std::vector<double> distances;
  distances.reserve(from.size());
  for (std::size_t n = 0; n < from.size(); ++n) {
    distances.push_back((to[n] - fit.scale * from[n] - fit.translation).norm());
  }
  return distances;
}

// Of the placements that two centres fix, the one of least median distance;
// then reweighted (Geman-McClure) least squares.
Placement RobustFit(const std::vector<Vec3>& from,
                    const std::vector<Vec3>& to) {
  constexpr int kDraws = 200, kPolish = 20;
  std::vector<double> weights(from.size(), 1.0);
  Placement best = WeightedFit(from, to, weights);
  double least = Median(Distances(from, to, best));
  Random random(0);
  const auto count = static_cast<std::uint32_t>(from.size());
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::uint32_t a = random.Index(count), b = random.Index(count);
    if (a == b) continue;
    const Placement fit =
        WeightedFit({from[a], from[b]}, {to[a], to[b]}, {1.0, 1.0});
    const double median = Median(Distances(from, to, fit));
    if (median < least) {
      least = median;
      best = fit;
    }
  }
  for (int step = 0; step < kPolish; ++step) {
    const std::vector<double> distances = Distances(from, to, best);
    const double scale = 3 * Median(distances);
    if (!(scale > 0)) break;
    for (std::size_t n = 0; n < from.size(); ++n) {
      weights[n] = 1 / std::pow(1 + std::pow(distances[n] / scale, 2), 2);
    }
    best = WeightedFit(from, to, weights);
  }
  return best;
}

double Spread(const std::vector<Vec3>& centers) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& center : centers) mean += center;
  mean /= static_cast<double>(centers.size());
  double squares = 0;
  for (const Vec3& center : centers) squares += (center - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(centers.size()));
}

/// A problem with its truth.
struct SimulatedProblem {
  TranslationProblem problem;
  std::vector<Vec3> true_centers;
  Mat3 truth_from_solved = Mat3::Identity();
};

Result<SimulatedProblem> MakeProblem(const RobustnessLevel& level,
                                     std::uint64_t seed,
                                     const RunContext& context) {
  SyntheticOptions options = level.scene;
  options.seed = seed;
  auto synthetic = Simulate(options);
  if (!synthetic) return tl::unexpected<Error>(synthetic.error());
  Scene& scene = synthetic->scene;
  std::map<ViewId, Mat3> rotations;
  std::vector<ViewPair> excluded;
  if (level.has_features) {
    const auto averaged = AverageSceneRotations(scene, PoseOptions(), context);
    if (!averaged) return tl::unexpected<Error>(averaged.error());
    auto ratios = EstimateScaleRatios(scene, level.scale, context);
    if (!ratios) return tl::unexpected<Error>(ratios.error());
    scene.scale_ratios = std::move(*ratios);
    rotations = averaged->cam_from_world;
    for (const OutlierEdge& edge : averaged->outliers) {
      excluded.push_back(edge.views);
    }
  } else {
    SimulatedRatioOptions ratios = level.ratios;
    ratios.seed = seed;
    const Status drawn = SimulateRatios(ratios, &*synthetic);
    if (!drawn) return tl::unexpected<Error>(drawn.error());
    for (const auto& [view, pose] : synthetic->true_poses) {
      rotations[view] = pose.rotation;
    }
  }
  SimulatedProblem made;
  made.problem = MakeTranslationProblem(scene, rotations, excluded, {},
                                        /*with_tracks=*/level.has_features);
  Mat3 sum = Mat3::Zero();
  for (const auto& [view, rotation] : rotations) {
    sum += synthetic->true_poses.at(view).rotation.transpose() * rotation;
    made.true_centers.push_back(synthetic->true_poses.at(view).center);
  }
  made.truth_from_solved = NearestRotation(sum);
  return made;
}

bool TakesAnySize(const std::string& strategy) {
  return strategy == "graph" || strategy == "chain";
}

RobustnessOutcome Try(const std::string& name, const SimulatedProblem& made,
                      const RobustnessLevel& level,
                      const RobustnessOptions& options,
                      const RunContext& context) {
  RobustnessOutcome outcome;
  const auto finish = [&](const std::string& note) {
    outcome.strategy = name;
    outcome.num_views = level.scene.num_views;
    outcome.note = note;
    return outcome;
  };
  outcome.median_error = HUGE_VAL;
  const auto averager = MakeTranslationAverager(name);
  if (!averager) return finish(averager.error().message);
  if ((*averager)->NeedsTracks() && !level.has_features) {
    return finish("not asked: it needs point tracks");
  }
  if (!TakesAnySize(name) &&
      level.scene.num_views > options.max_views_of_others) {
    return finish("not asked: too many views");
  }
  outcome.was_asked = true;
  const auto solution = (*averager)->Solve(made.problem, context);
  if (!solution) return finish(solution.error().message);
  outcome = JudgeCenters(made.true_centers, level.scene.num_views, *solution,
                         made.truth_from_solved, options.tolerance);
  outcome.was_asked = true;
  return finish(outcome.num_placed < level.scene.num_views
                    ? "a view needs " + std::string((*averager)->Needs())
                    : "");
}

}  // namespace

Status RobustnessOptions::Validate() const {
  const auto invalid = [](const std::string& message) {
    return MakeError(ErrorCode::kInvalidArgument, "robustness: " + message);
  };
  if (num_seeds < 1) return invalid("the number of seeds must be positive");
  if (!(tolerance > 0)) return invalid("the tolerance must be positive");
  for (const std::string& name : scenarios) {
    const auto made = MakeRobustnessScenarios(name, quick);
    if (!made) return tl::unexpected<Error>(made.error());
  }
  for (const std::string& name : strategies) {
    const auto made = MakeTranslationAverager(name);
    if (!made) return tl::unexpected<Error>(made.error());
  }
  return {};
}

RobustnessOutcome JudgeCenters(const std::vector<Vec3>& truth, int num_views,
                               const TranslationSolution& solution,
                               const Mat3& truth_from_solved,
                               double tolerance) {
  RobustnessOutcome outcome;
  outcome.num_views = num_views;
  outcome.median_error = HUGE_VAL;
  std::vector<Vec3> from, to;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    if (solution.component[n] != 0) continue;
    from.push_back(truth_from_solved * solution.center_in_world[n]);
    to.push_back(truth[n]);
  }
  outcome.num_placed = static_cast<int>(from.size());
  if (from.size() < 2) return outcome;
  const double spread = Spread(truth);
  const Placement fit = RobustFit(from, to);
  std::vector<double> errors = Distances(from, to, fit);
  for (double& error : errors) error /= spread;
  errors.resize(static_cast<std::size_t>(num_views), HUGE_VAL);
  outcome.num_right = static_cast<int>(
      std::count_if(errors.begin(), errors.end(),
                    [&](double error) { return error <= tolerance; }));
  outcome.median_error = Median(std::move(errors));
  return outcome;
}

Result<RobustnessStudy> StudyRobustness(const RobustnessOptions& options,
                                        const RunContext& context) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  RobustnessStudy study;
  study.options = options;
  if (options.scenarios.empty()) {
    study.options.scenarios = RobustnessScenarioNames();
  }
  if (options.strategies.empty()) {
    study.options.strategies = TranslationAveragerNames();
  }
  for (const std::string& name : study.options.scenarios) {
    auto scenarios = MakeRobustnessScenarios(name, options.quick);
    if (!scenarios) return tl::unexpected<Error>(scenarios.error());
    for (RobustnessScenario& each : *scenarios) {
      study.scenarios.push_back(std::move(each));
    }
  }
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    for (std::size_t l = 0; l < study.scenarios[s].levels.size(); ++l) {
      for (int n = 0; n < options.num_seeds; ++n) {
        RobustnessTrial trial;
        trial.scenario = s;
        trial.level = l;
        trial.seed = context.seed + static_cast<std::uint64_t>(n);
        study.trials.push_back(std::move(trial));
      }
    }
  }
  std::vector<Status> failures(study.trials.size());
  const Status done =
      ParallelFor(context, "trials", study.trials.size(), [&](std::size_t t) {
        RobustnessTrial& trial = study.trials[t];
        const RobustnessLevel& level =
            study.scenarios[trial.scenario].levels[trial.level];
        RunContext alone;
        alone.num_threads = 1;
        alone.seed = trial.seed;
        const auto made = MakeProblem(level, trial.seed, alone);
        if (!made) {
          failures[t] = tl::unexpected<Error>(made.error());
          return;
        }
        for (const std::string& name : study.options.strategies) {
          trial.outcomes.push_back(
              Try(name, *made, level, study.options, alone));
        }
      });
  if (!done) return tl::unexpected<Error>(done.error());
  for (const Status& failure : failures) {
    if (!failure) return tl::unexpected<Error>(failure.error());
  }
  return study;
}

}  // namespace lowlap
