#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/merge/merge_models.h"
#include "python/solution.h"

namespace lowlap::python {
namespace {

struct GivenModel {
  std::string name;
  std::shared_ptr<const Scene> scene;
};

// A scene or a path, or several of them.
std::vector<GivenModel> ModelsOf(const py::object& models, Call* call) {
  std::vector<GivenModel> given;
  const auto add = [&](const py::object& model) {
    given.push_back({py::isinstance<Scene>(model)
                         ? "model " + std::to_string(given.size() + 1)
                         : PathOf(model, "a model must be a Scene or a path"),
                     SceneOf(model, call)});
  };
  if (py::isinstance<Scene>(models) || py::isinstance<py::str>(models) ||
      py::hasattr(models, "__fspath__")) {
    add(models);
  } else {
    for (const py::handle model : models) {
      add(py::reinterpret_borrow<py::object>(model));
    }
  }
  return given;
}

Result<std::vector<PartialModel>> MatchModels(
    const std::vector<GivenModel>& given, const Scene& measured,
    const RunContext& context) {
  std::vector<PartialModel> models;
  for (const GivenModel& each : given) {
    LOWLAP_ASSIGN_OR_RETURN(
        auto model, MatchModel(measured, *each.scene, each.name, context));
    models.push_back(std::move(model));
  }
  return models;
}

// Of what was measured already they would say nothing.
void RefuseOptionsOfPhotographs(const py::kwargs& kwargs) {
  for (const char* name : {"intrinsics", "focal", "pairs", "matcher",
                           "two_view", "max_tilt", "refine_points", "cache"}) {
    if (kwargs.contains(name) && !kwargs[name].is_none()) {
      Raise({ErrorCode::kInvalidArgument,
             std::string(name) + " goes with photographs, not with scene",
             {},
             {}});
    }
  }
}

Solution Merge(const py::object& given, const py::kwargs& kwargs) {
  Keywords keywords("merge", kwargs);
  const auto call = TakeCall(&keywords);
  const SolveArguments arguments = TakeSolveArguments(&keywords, call.get());
  const py::object scene = keywords.Take("scene");
  const SceneInput input = TakeSceneInput(&keywords);
  if (scene) RefuseOptionsOfPhotographs(kwargs);
  Photographs photographs;
  photographs.measurement = TakeMeasurementOptions(&keywords, arguments.scale);
  photographs.folder = input.images;
  photographs.exclude = input.exclude;
  py::object intrinsics = py::none();
  keywords.Take("intrinsics", &intrinsics);
  std::optional<double> focal_px;
  keywords.Take("focal", &focal_px);
  keywords.Finish();
  if (!scene && photographs.folder.empty()) {
    Raise({ErrorCode::kInvalidArgument,
           "images (photographs) or scene (one that was measured) is missing: "
           "the models alone do not say how they lie to one another",
           {},
           {}});
  }
  CheckOutput(arguments.output);
  const RunContext& context = call->context();
  const std::vector<GivenModel> scenes = ModelsOf(given, call.get());
  StageLog stages;
  std::vector<PartialModel> models;
  const auto match = [&](const Scene& views) -> Status {
    LOWLAP_ASSIGN_OR_RETURN(models, MatchModels(scenes, views, context));
    return {};
  };
  Solution solution;
  if (scene) {
    solution = LoadToSolve(scene, input, arguments, call.get(), &stages, match);
  } else {
    photographs.intrinsics = IntrinsicsOf(intrinsics, focal_px);
    solution =
        MeasurePhotographs(photographs, arguments, call.get(), &stages, match);
  }
  RunSummary& summary = solution.summary;
  summary.command = "merge";
  const std::vector<ModelCheck> checks = call->Run([&] {
    return CheckModels(*solution.scene, models, arguments.options, context,
                       &stages);
  });
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::string& line :
         DescribeCheck(models[m], checks[m], *solution.scene)) {
      summary.notes.push_back(std::move(line));
    }
  }
  SolveInPlace(arguments, call.get(), &stages, &solution,
               [&](Scene* merged, const SolveOptions& options,
                   const RunContext& run, StageLog* log) {
                 return MergeModels(merged, models, checks, options, run, log);
               });
  return solution;
}

}  // namespace

void BindMerge(py::module_& module) {
  module.def(
      "merge", &Merge, py::arg("models"),
      "One model of partial ones, and of the views that none of them placed,\n"
      "as `lowlap merge` makes it: each is checked against what is measured,\n"
      "and cut where that contradicts it. Solution.notes say how.\n\n"
      "models: scenes or paths of any program's, matched by image name.\n"
      "What is measured, one of:\n"
      "  images: photographs, measured as by run(), with its options\n"
      "  intrinsics, focal, pairs, matcher, two_view, max_tilt, "
      "refine_points,\n"
      "  cache;\n"
      "  scene: a scene or a path, as of solve(), with matchdir, match_file,\n"
      "  images, exclude.\n"
      "Other options: exclude, and those of solve(): features,\n"
      "coplanar_points, criterion, nfa, threshold, strategy, adjust_features,\n"
      "coplanar_ties, directions, no_adjust, refine_intrinsics,\n"
      "principal_point_stddev, gt, output, threads, seed, progress, log.");
}

}  // namespace lowlap::python
