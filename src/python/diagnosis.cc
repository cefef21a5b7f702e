#include "lowlap/averaging/rigidity/internal/diagnosis.h"

#include <memory>
#include <utility>
#include <vector>

#include "lowlap/pipeline/internal/output/diagnosis_output.h"
#include "lowlap/scale/scale_ratios.h"
#include "python/keywords.h"

namespace lowlap::python {
namespace {

struct SceneDiagnosis {
  std::shared_ptr<const Scene> scene;  // with ratios
  Diagnosis diagnosis;
};

SceneDiagnosis DiagnoseScene(const py::object& scene_or_path,
                             const py::kwargs& kwargs) {
  Keywords keywords("diagnose", kwargs);
  const auto call = TakeCall(&keywords);
  const ScaleOptions scale = TakeScaleOptions(&keywords);
  DiagnosisOptions options;
  keywords.Take("min_inliers", &options.min_inliers);
  keywords.Take("max_log10_nfa", &options.max_log10_nfa);
  keywords.Take("max_stddev", &options.max_stddev);
  const SceneInput input = TakeSceneInput(&keywords);
  keywords.Finish();
  RaiseIfError(options.Validate());
  auto scene = MeasuredSceneOf(scene_or_path, input, call.get()).scene;
  if (scene->scale_ratios.empty()) {
    auto with_ratios = std::make_shared<Scene>(*scene);
    with_ratios->scale_ratios = call->Run(
        [&] { return EstimateScaleRatios(*scene, scale, call->context()); });
    scene = std::move(with_ratios);
  }
  Diagnosis diagnosis = call->Run([&] { return Diagnose(*scene, options); });
  return {std::move(scene), std::move(diagnosis)};
}

std::vector<std::vector<ViewId>> ViewsOf(
    const std::vector<RigidGroup>& groups) {
  std::vector<std::vector<ViewId>> views;
  for (const RigidGroup& group : groups) views.push_back(group.views);
  return views;
}

}  // namespace

void BindDiagnosis(py::module_& module) {
  py::class_<FloatingPart>(module, "FloatingPart",
                           "Views that share no scale with the largest group.")
      .def_readonly("views", &FloatingPart::views)
      .def_property_readonly(
          "meets_in",
          [](const FloatingPart& part) -> std::optional<ViewId> {
            if (part.meets_in == ViewId()) return std::nullopt;
            return part.meets_in;
          },
          "A camera that it shares with another group, or None.")
      .def_readonly("near_group", &FloatingPart::near_group)
      .def_readonly("near_part", &FloatingPart::near_part)
      .def_readonly("rejected_ratio", &FloatingPart::rejected_ratio,
                    "Index into Diagnosis.ratios, or None.");

  py::class_<ScaleArticulation>(
      module, "ScaleArticulation",
      "A camera whose ratios are all that joins parts of a group.")
      .def_readonly("view", &ScaleArticulation::view)
      .def_readonly("parts", &ScaleArticulation::parts)
      .def_readonly("ratios", &ScaleArticulation::ratios,
                    "Indices into Diagnosis.ratios.")
      .def_readonly("is_weak", &ScaleArticulation::is_weak);

  using Bound = SceneDiagnosis;
  py::class_<Bound>(module, "Diagnosis",
                    "What shares one scale, floats or hangs on weak ratios.\n"
                    "str() says it in plain words.")
      .def_property_readonly(
          "is_firm", [](const Bound& d) { return d.diagnosis.IsFirm(); },
          "One scale for all views, without any weak ratio.")
      .def_property_readonly(
          "groups",
          [](const Bound& d) { return ViewsOf(d.diagnosis.by_ratios.groups); },
          "Views by common scale, the largest group first.")
      .def_property_readonly(
          "groups_by_directions",
          [](const Bound& d) {
            return ViewsOf(d.diagnosis.by_directions.groups);
          },
          "The same without any ratio.")
      .def_property_readonly(
          "floating", [](const Bound& d) { return d.diagnosis.floating; })
      .def_property_readonly(
          "articulation_views",
          [](const Bound& d) { return d.diagnosis.articulation_views; })
      .def_property_readonly(
          "weak_ratios", [](const Bound& d) { return d.diagnosis.weak_ratios; },
          "Indices into `ratios`.")
      .def_property_readonly(
          "ratios", [](const Bound& d) { return d.scene->scale_ratios; })
      .def(
          "to_dict",
          [](const Bound& d) {
            return py::module_::import("json").attr("loads")(
                ToJson(d.diagnosis, *d.scene));
          },
          "What `lowlap diagnose --json` writes.")
      .def("__str__",
           [](const Bound& d) { return ToText(d.diagnosis, *d.scene); });

  module.def(
      "diagnose", &DiagnoseScene, py::arg("scene"),
      "Says before anything is solved which views share one scale and\n"
      "through what, and which float or hang on weak ratios.\n\n"
      "Options: features, coplanar_points, criterion, nfa, threshold;\n"
      "min_inliers, max_log10_nfa, max_stddev; matchdir, match_file, images,\n"
      "exclude: as of measure(); threads, seed, progress, log.");
}

}  // namespace lowlap::python
