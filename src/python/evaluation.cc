#include <string>

#include "lowlap/evaluation/pose_errors.h"
#include "python/keywords.h"

namespace lowlap::python {
void BindEvaluation(py::module_& module) {
  py::class_<ErrorStatistics>(module, "ErrorStatistics",
                              "Of non-negative errors; all 0 for none.")
      .def_readonly("count", &ErrorStatistics::count)
      .def_readonly("mean", &ErrorStatistics::mean)
      .def_readonly("median", &ErrorStatistics::median)
      .def_readonly("max", &ErrorStatistics::max)
      .def_readonly("rmse", &ErrorStatistics::rmse)
      .def("__repr__", [](const ErrorStatistics& errors) {
        return py::str(
                   "<lowlap.ErrorStatistics: {} errors, mean {:.4g}, "
                   "median {:.4g}, max {:.4g}>")
            .format(errors.count, errors.mean, errors.median, errors.max);
      });

  py::class_<ViewPoseError>(
      module, "ViewPoseError",
      "Of a camera that is solved; position in the unit of the true ones.")
      .def_readonly("view", &ViewPoseError::view)
      .def_readonly("name", &ViewPoseError::name)
      .def_readonly("position_error", &ViewPoseError::position_error)
      .def_readonly("rotation_error_deg", &ViewPoseError::rotation_error_deg);

  py::class_<Similarity>(module, "Similarity",
                         "x_target = scale rotation x_source + translation.")
      .def_readonly("scale", &Similarity::scale)
      .def_readonly("rotation", &Similarity::rotation)
      .def_readonly("translation", &Similarity::translation);

  py::class_<PoseEvaluation>(
      module, "PoseEvaluation",
      "Poses against true ones, after a similarity alignment of the centres.\n"
      "str() gives a table.")
      .def_property_readonly(
          "scope",
          [](const PoseEvaluation& e) { return EvaluationScopeName(e.scope); },
          "nothing, rotations_only or full; `note` says why not full.")
      .def_readonly("note", &PoseEvaluation::note)
      .def_readonly("num_total", &PoseEvaluation::num_total)
      .def_readonly("num_solved", &PoseEvaluation::num_solved)
      .def_readonly("unsolved", &PoseEvaluation::unsolved)
      .def_readonly("without_truth", &PoseEvaluation::without_truth)
      .def_readonly("truth_from_solution", &PoseEvaluation::truth_from_solution)
      .def_readonly("views", &PoseEvaluation::views)
      .def_readonly("position", &PoseEvaluation::position,
                    "In the unit of the true cameras.")
      .def_readonly("rotation_deg", &PoseEvaluation::rotation_deg)
      .def("__str__", [](const PoseEvaluation& e) { return ToText(e); });

  module.def(
      "evaluate",
      [](const py::object& scene_or_path, const py::object& truth) {
        Call call(py::none(), py::none(), 0, 0);
        const auto scene = SceneOf(scene_or_path, &call);
        const auto true_poses = TruthOf(truth, *scene);
        if (!true_poses) throw py::type_error("evaluate(): truth is None");
        return EvaluatePoses(*scene, *true_poses);
      },
      py::arg("scene"), py::arg("truth"),
      "The poses of a scene against true ones: a scene, its path, a folder of\n"
      "Strecha's .camera files, or a dict of Pose by view id.");
}

}  // namespace lowlap::python
