#include <string>
#include <utility>

#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/view_graph.h"
#include "python/arrays.h"
#include "python/keywords.h"

namespace lowlap::python {
namespace {

std::vector<ScaleRatio> Scales(const py::object& scene_or_path,
                               const py::kwargs& kwargs) {
  Keywords keywords("scales", kwargs);
  const auto call = TakeCall(&keywords);
  const ScaleOptions options = TakeScaleOptions(&keywords);
  const SceneInput input = TakeSceneInput(&keywords);
  keywords.Finish();
  const auto scene = MeasuredSceneOf(scene_or_path, input, call.get()).scene;
  return call->Run(
      [&] { return EstimateScaleRatios(*scene, options, call->context()); });
}

py::object FindKind(const py::object& self, const std::string& name) {
  return py::cast(self.cast<const ScaleRatio&>().FindKind(name),
                  py::return_value_policy::reference_internal, self);
}

std::string DescribeRatio(const ScaleRatio& ratio) {
  const ViewTriplet& views = ratio.views;
  return "<lowlap.ScaleRatio: " + std::to_string(views.first.value()) + "-" +
         std::to_string(views.middle.value()) + "-" +
         std::to_string(views.last.value()) + ", " +
         RatioVerdictName(ratio.verdict) + ", log ratio " +
         std::to_string(ratio.log_ratio) + " +- " +
         std::to_string(ratio.log_ratio_stddev) + ">";
}

}  // namespace

void BindRatios(py::module_& module) {
  py::class_<KindSupport>(module, "KindSupport",
                          "What one kind of evidence says about a ratio.")
      .def_readonly("kind", &KindSupport::kind)
      .def_readonly("candidates", &KindSupport::candidates)
      .def_readonly("inliers", &KindSupport::inliers)
      .def_readonly("log10_nfa", &KindSupport::log10_nfa)
      .def_readonly("threshold_px", &KindSupport::threshold_px)
      .def_readonly("information_share", &KindSupport::information_share);

  py::class_<RatioMode>(module, "RatioMode", "Another ratio that is possible.")
      .def_readonly("log_ratio", &RatioMode::log_ratio)
      .def_readonly("log10_nfa", &RatioMode::log10_nfa);

  py::class_<ScaleRatio>(module, "ScaleRatio",
                         "log(length(middle, last) / length(first, middle)) of "
                         "two relative poses\n"
                         "that share their middle view.")
      .def_readonly("views", &ScaleRatio::views, "(first, middle, last).")
      .def_property_readonly(
          "verdict",
          [](const ScaleRatio& ratio) {
            return RatioVerdictName(ratio.verdict);
          },
          "meaningful, not_meaningful or no_candidates.")
      .def_property_readonly("is_meaningful",
                             [](const ScaleRatio& ratio) {
                               return ratio.verdict ==
                                      RatioVerdict::kMeaningful;
                             })
      .def_readonly("log_ratio", &ScaleRatio::log_ratio)
      .def_readonly("stddev", &ScaleRatio::log_ratio_stddev,
                    "Of the log ratio.")
      .def_property_readonly(
          "interval",
          [](const ScaleRatio& ratio) {
            return std::pair(ratio.IntervalLow(), ratio.IntervalHigh());
          },
          "Of the log ratio, with a probability of 95 %.")
      .def_readonly("log10_nfa", &ScaleRatio::log10_nfa)
      .def_readonly("second_mode", &ScaleRatio::second_mode)
      .def_readonly("kinds", &ScaleRatio::kinds)
      .def("find_kind", &FindKind, py::arg("kind"),
           "The support of a kind of evidence, or None.")
      .def_property_readonly("num_inliers", &ScaleRatio::NumInliers)
      .def_readonly("num_rejected_negative", &ScaleRatio::num_rejected_negative)
      .def_property_readonly(
          "coplanar_inliers",
          [](const py::object& self) {
            return IndexArray(self.cast<const ScaleRatio&>().coplanar_inliers,
                              self);
          },
          "(n, 2): segments of the middle view, of a line matched with the\n"
          "first view and of one matched with the last.")
      .def("__repr__", &DescribeRatio);

  module.def(
      "scales", &Scales, py::arg("scene"),
      "The relative scale of every two relative poses that share a view.\n\n"
      "Options: features, coplanar_points, criterion, nfa, threshold;\n"
      "matchdir, match_file, images, exclude: as of measure(); threads,\n"
      "seed, progress, log.");
  module.def(
      "triplets",
      [](const Scene& scene) { return FindTriplets(ViewGraph(scene)); },
      py::arg("scene"), "Every two relative poses that share a view.");
}

}  // namespace lowlap::python
