#include <optional>
#include <string>
#include <utility>

#include "lowlap/averaging/averager_registry.h"
#include "lowlap/pipeline/translation_scale_estimator.h"
#include "python/averager.h"
#include "python/keywords.h"

namespace lowlap::python {
namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Segments = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
using Matches = Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>;

TranslationEstimate Estimate(const TranslationScaleEstimator& estimator,
                             const py::kwargs& kwargs) {
  Keywords keywords("estimate", kwargs);
  const auto call = TakeCall(&keywords);
  keywords.Finish();
  return call->Run([&] { return estimator.Estimate(call->context()); });
}

TranslationScaleEstimator MakeEstimator(const py::kwargs& kwargs) {
  Keywords keywords("TranslationScaleEstimator", kwargs);
  SolveOptions options;
  options.scale_estimator = MakeScaleEstimator(TakeScaleOptions(&keywords));
  if (const py::object strategy = keywords.Take("strategy")) {
    // One that is written in Python lives only as long as a call.
    const auto request = RequestOf(strategy);
    if (!request) {
      throw py::type_error("the strategy must be one of lowlap's, not " +
                           py::repr(strategy).cast<std::string>());
    }
    options.poses.averager =
        ValueOf(AveragerRegistry::WithBuiltIns().Make(*request));
  }
  keywords.Finish();
  return TranslationScaleEstimator(std::move(options));
}

}  // namespace

void BindHost(py::module_& module) {
  py::class_<TranslationEstimate>(module, "TranslationEstimate",
                                  "Ratios, and what they place.")
      .def_readonly("ratios", &TranslationEstimate::ratios)
      .def_readonly("poses", &TranslationEstimate::poses,
                    "Of the placed views, by id, all in one scale.")
      .def_readonly("unplaced", &TranslationEstimate::unplaced);

  using Estimator = TranslationScaleEstimator;
  py::class_<Estimator>(
      module, "TranslationScaleEstimator",
      "The translation step of a program that has a view graph in memory.\n\n"
      "Options: features, coplanar_points, criterion, nfa, threshold;\n"
      "strategy.")
      .def(py::init(&MakeEstimator))
      .def(
          "add_view",
          [](Estimator& estimator, ViewId view, const Mat3& calibration_px,
             int width_px, int height_px, const Points& points_px,
             const std::optional<Segments>& segments_px) {
            estimator.AddView(view, calibration_px, width_px, height_px,
                              points_px.transpose(),
                              segments_px
                                  ? Eigen::Matrix4Xd(segments_px->transpose())
                                  : Eigen::Matrix4Xd());
          },
          py::arg("view"), py::arg("calibration_px"), py::arg("width_px"),
          py::arg("height_px"), py::arg("points_px"),
          py::arg("segments_px") = py::none(),
          "A view without distortion: points (n, 2), segments (m, 4) as\n"
          "x1, y1, x2, y2.")
      .def(
          "add_relative_pose",
          [](Estimator& estimator, ViewId first, ViewId second,
             const Mat3& rotation, const Vec3& translation,
             const Matches& point_matches,
             const std::optional<Matches>& line_matches) {
            estimator.AddRelativePose(
                first, second, rotation, translation, point_matches.transpose(),
                line_matches ? Eigen::Matrix2Xi(line_matches->transpose())
                             : Eigen::Matrix2Xi());
          },
          py::arg("first"), py::arg("second"), py::arg("rotation"),
          py::arg("translation"), py::arg("point_matches"),
          py::arg("line_matches") = py::none(),
          "x_second = rotation x_first + length translation. Inlier matches,\n"
          "(n, 2): indices in the first and in the second view.")
      .def("set_rotation", &Estimator::SetRotation, py::arg("view"),
           py::arg("cam_from_world"),
           "A global rotation that is known; of all views, or of none.")
      .def("estimate", &Estimate,
           "Ratios and poses. Options: threads, seed, progress, log.");
}

}  // namespace lowlap::python
