#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/study/compare_strategies.h"
#include "python/averager.h"
#include "python/keywords.h"

namespace lowlap::python {
namespace {

struct SceneComparison {
  std::shared_ptr<const Scene> scene;
  Comparison comparison;
};

// Requests as the registry reads them; averagers are registered by their
// names.
void AddStrategies(const py::object& strategies, Call* call,
                   CompareOptions* options) {
  if (!strategies || strategies.is_none()) return;
  options->strategies.clear();
  if (py::isinstance<py::str>(strategies)) {
    options->strategies = SplitRequests(strategies.cast<std::string>());
    return;
  }
  for (const py::handle each : strategies) {
    if (const auto request = RequestOf(each)) {
      options->strategies.push_back(*request);
      continue;
    }
    AveragerRegistry::Strategy strategy;
    auto averager = AveragerOf(py::reinterpret_borrow<py::object>(each), call);
    strategy.name = averager->Name();
    strategy.description = "written in Python";
    strategy.make =
        [averager](
            const OptionValues& values) -> Result<AveragerRegistry::Averager> {
      if (values.empty()) return averager;
      return tl::unexpected<Error>(UnknownOption(values.begin()->first, {}));
    };
    options->strategies.push_back(strategy.name);
    RaiseIfError(options->registry.Register(std::move(strategy)));
  }
}

SceneComparison Compare(const py::object& scene_or_path,
                        const py::object& truth, const py::object& strategies,
                        const py::kwargs& kwargs) {
  Keywords keywords("compare", kwargs);
  const auto call = TakeCall(&keywords);
  CompareOptions options;
  options.solve = TakeComparedOptions(&keywords).options;
  keywords.Take("reference", &options.reference);
  std::filesystem::path output;
  keywords.Take("output", &output);
  const SceneInput input = TakeSceneInput(&keywords);
  keywords.Finish();
  AddStrategies(strategies, call.get(), &options);
  RaiseIfError(options.Validate());
  const auto scene = MeasuredSceneOf(scene_or_path, input, call.get()).scene;
  options.truth = TruthOf(truth, *scene);
  Comparison comparison = call->Run(
      [&] { return CompareStrategies(*scene, options, call->context()); });
  if (!output.empty()) {
    RaiseIfError(WriteComparison(comparison, *scene, output.string()));
  }
  return {scene, std::move(comparison)};
}

}  // namespace

void BindCompare(py::module_& module) {
  py::class_<Consistency>(module, "Consistency",
                          "How well a solution meets what was measured.")
      .def_readonly("direction_deg", &Consistency::direction_deg)
      .def_readonly("mean_baseline", &Consistency::mean_baseline)
      .def_readonly("abs_log_ratio", &Consistency::abs_log_ratio)
      .def_readonly("num_points", &Consistency::num_points)
      .def_readonly("reprojection_rmse_px", &Consistency::reprojection_rmse_px);

  py::class_<SolutionQuality>(module, "SolutionQuality",
                              "How good the poses of a strategy are.")
      .def_readonly("consistency", &SolutionQuality::consistency)
      .def_readonly("errors", &SolutionQuality::errors,
                    "Against the true cameras, or None.")
      .def_readonly("difference", &SolutionQuality::difference,
                    "To the reference, in mean baselines, or None.");

  py::class_<StrategyResult>(module, "StrategyResult",
                             "What a strategy made of the common input.")
      .def_readonly("strategy", &StrategyResult::strategy)
      .def_property_readonly(
          "failure",
          [](const StrategyResult& result) -> std::optional<std::string> {
            if (!result.failure) return std::nullopt;
            return result.failure->ToString();
          },
          "Why there is no solution, or None.")
      .def_readonly("limit", &StrategyResult::limit,
                    "Why cameras are missing; empty if all are placed.")
      .def_readonly("num_placed", &StrategyResult::num_placed)
      .def_readonly("num_components", &StrategyResult::num_components)
      .def_readonly("unplaced", &StrategyResult::unplaced)
      .def_readonly("before", &StrategyResult::before)
      .def_readonly("after", &StrategyResult::after,
                    "After the adjustment, or None.")
      .def_readonly("poses_before_adjustment",
                    &StrategyResult::poses_before_adjustment)
      .def_readonly("poses", &StrategyResult::poses)
      .def_readonly("costs", &StrategyResult::costs);

  using Bound = SceneComparison;
  py::class_<Bound>(module, "Comparison",
                    "All strategies on one input. str() gives a table.")
      .def_property_readonly(
          "results", [](const Bound& c) { return c.comparison.results; })
      .def_property_readonly(
          "reference", [](const Bound& c) { return c.comparison.reference; })
      .def_property_readonly(
          "num_edges", [](const Bound& c) { return c.comparison.num_edges; })
      .def_property_readonly(
          "num_ratios", [](const Bound& c) { return c.comparison.num_ratios; })
      .def("to_csv", [](const Bound& c) { return ToCsv(c.comparison); })
      .def(
          "write",
          [](const Bound& c, const std::filesystem::path& folder) {
            RaiseIfError(
                WriteComparison(c.comparison, *c.scene, folder.string()));
          },
          py::arg("folder"), "compare.csv, compare.json and plots.")
      .def("__str__", [](const Bound& c) { return ToText(c.comparison); });

  module.def(
      "compare", &Compare, py::arg("scene"), py::arg("truth") = py::none(),
      py::arg("strategies") = py::none(),
      "Every strategy on the same rotations, relative poses and ratios.\n\n"
      "truth: as `gt` of solve(). strategies: a text as that of `lowlap\n"
      "compare --strategies`, or a list of texts and TranslationAverager;\n"
      "None: all of lowlap's. Options: reference, output; features,\n"
      "coplanar_points, criterion, nfa, threshold; adjust_features,\n"
      "coplanar_ties, directions, no_adjust, principal_point_stddev;\n"
      "matchdir, match_file, images, exclude: as of measure();\n"
      "threads, seed, progress, log.");
}

}  // namespace lowlap::python
