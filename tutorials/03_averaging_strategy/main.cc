// Tutorial 3: an averaging strategy of one's own, with an option, compared with
// the built-in ones.
//
// "walk" is as simple as a strategy can be: it walks over the ratios, the
// surest first, to find the length of every relative pose, and over the
// relative poses to lay the centres end to end. Its option says how unsure a
// ratio may be.
//
//   cmake -S tutorials/03_averaging_strategy -B build/tutorial03
//   cmake --build build/tutorial03 && build/tutorial03/averaging_strategy
#include <lowlap/averaging/averager_registry.h>
#include <lowlap/study/compare_strategies.h>
#include <lowlap/synthetic/synthetic_scene.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

struct WalkOptions {
  double max_stddev = 0.5;

  lowlap::Status Validate() const {
    if (max_stddev > 0) return {};
    return lowlap::MakeError(lowlap::ErrorCode::kInvalidArgument,
                             "walk: max_stddev must be positive");
  }
  // What the registry reads, lists and explains.
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("max_stddev", &max_stddev,
          "ratios whose logarithm is less sure are not used");
  }
};

class WalkAverager : public lowlap::TranslationAverager {
 public:
  explicit WalkAverager(const WalkOptions& options) : options_(options) {}

  std::string Name() const override { return "walk"; }
  std::string Needs() const override { return "a ratio that is sure enough"; }

  lowlap::Result<lowlap::TranslationSolution> Solve(
      const lowlap::TranslationProblem& problem,
      const lowlap::RunContext& context) const override {
    if (const auto valid = lowlap::ValidateProblem(problem); !valid) {
      return tl::unexpected<lowlap::Error>(valid.error());
    }
    std::vector<lowlap::RatioMeasurement> ratios;
    for (const auto& ratio : problem.ratios) {
      if (ratio.stddev <= options_.max_stddev) ratios.push_back(ratio);
    }
    std::stable_sort(ratios.begin(), ratios.end(),
                     [](auto& a, auto& b) { return a.stddev < b.stddev; });

    // Lengths, from that of the first relative pose.
    constexpr double kUnknown = -1;
    std::vector<double> length(problem.edges.size(), kUnknown);
    if (!ratios.empty()) length[ratios.front().reference] = 1;
    for (bool found = true; found;) {
      if (!context.Progress("walk", 0, 1)) {
        return lowlap::MakeError(lowlap::ErrorCode::kCancelled, "cancelled");
      }
      found = false;
      for (const auto& ratio : ratios) {
        double& from = length[ratio.reference];
        double& to = length[ratio.target];
        if ((from == kUnknown) == (to == kUnknown)) continue;
        if (to == kUnknown) {
          to = from * std::exp(ratio.log_ratio);
        } else {
          from = to * std::exp(-ratio.log_ratio);
        }
        found = true;
        break;
      }
    }

    // Centres, from that of the first relative pose's first view.
    lowlap::TranslationSolution solution;
    solution.component.assign(problem.views.size(), -1);
    solution.center_in_world.assign(problem.views.size(), lowlap::Vec3::Zero());
    if (ratios.empty()) return solution;
    solution.num_components = 1;
    solution.component[problem.edges[ratios.front().reference].first] = 0;
    for (bool found = true; found;) {
      found = false;
      for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        const lowlap::DirectionEdge& edge = problem.edges[e];
        const bool has_first = solution.component[edge.first] == 0;
        const bool has_second = solution.component[edge.second] == 0;
        if (length[e] == kUnknown || has_first == has_second) continue;
        const lowlap::Vec3 step = length[e] * edge.direction_in_world;
        auto& centers = solution.center_in_world;
        if (has_first) {
          centers[edge.second] = centers[edge.first] + step;
        } else {
          centers[edge.first] = centers[edge.second] - step;
        }
        solution.component[edge.first] = solution.component[edge.second] = 0;
        found = true;
      }
    }
    return solution;
  }

 private:
  WalkOptions options_;
};

int Fail(const lowlap::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main() {
  lowlap::SyntheticOptions corridor;
  corridor.kind = lowlap::SyntheticKind::kCorridor;
  corridor.num_views = 10;
  corridor.pairs = "window:2";
  corridor.noise_px = 0.5;
  const auto simulated = lowlap::Simulate(corridor);
  if (!simulated) return Fail(simulated.error());

  lowlap::CompareOptions options;
  const auto registered = options.registry.Register(
      "walk", "the surest ratios, one after the other", WalkOptions(),
      [](const WalkOptions& given) {
        return std::make_shared<WalkAverager>(given);
      });
  if (!registered) return Fail(registered.error());
  // As on the command line: a name, or a name with options.
  options.strategies = {"graph", "chain", "lud", "walk",
                        "walk:max_stddev=0.01"};
  options.truth = simulated->true_poses;
  const auto comparison = lowlap::CompareStrategies(simulated->scene, options,
                                                    lowlap::RunContext());
  if (!comparison) return Fail(comparison.error());
  std::printf("%s", lowlap::ToText(*comparison).c_str());

  // What is wrong with a request is said before anything is computed.
  options.strategies = {"walk:max_stdev=0.01"};
  const auto refused = lowlap::CompareStrategies(simulated->scene, options,
                                                 lowlap::RunContext());
  if (refused) return 1;
  std::printf("\n%s\n", refused.error().ToString().c_str());

  for (const lowlap::StrategyResult& result : comparison->results) {
    if (result.strategy == "walk" && result.num_placed != corridor.num_views) {
      return 1;
    }
  }
  return 0;
}
