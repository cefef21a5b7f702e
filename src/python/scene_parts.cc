#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "lowlap/scene/scene.h"
#include "python/arrays.h"

namespace lowlap::python {
namespace {

template <class Value>
py::object IdOrNone(Value id) {
  return id == Value() ? py::object(py::none()) : py::cast(id);
}

py::array PointsOf(const py::object& self) {
  const auto& points = self.cast<const ViewFeatures&>().points_px;
  return MemberArray(points, points.empty() ? nullptr : points.front().data(),
                     2, self);
}

py::array SegmentsOf(const py::object& self) {
  // The two ends of a segment are neighbours in memory.
  static_assert(offsetof(LineSegment, end_px) == 2 * sizeof(double));
  const auto& segments = self.cast<const ViewFeatures&>().segments;
  return MemberArray(
      segments, segments.empty() ? nullptr : segments.front().start_px.data(),
      4, self);
}

py::array SegmentDeviationsOf(const py::object& self) {
  const auto& segments = self.cast<const ViewFeatures&>().segments;
  return MemberArray(segments,
                     segments.empty() ? nullptr : &segments.front().stddev_px,
                     0, self);
}

// Views, features and pixels of a landmark's observations.
py::array ObservationsOf(const py::object& self) {
  static_assert(offsetof(PointObservation, feature) ==
                offsetof(PointObservation, view) + sizeof(std::uint32_t));
  const auto& all = self.cast<const Landmark&>().observations;
  return MemberArray(all, reinterpret_cast<const std::uint32_t*>(all.data()), 2,
                     self);
}

py::array PixelsOf(const py::object& self) {
  const auto& all = self.cast<const Landmark&>().observations;
  return MemberArray(all, all.empty() ? nullptr : all.front().pixel_px.data(),
                     2, self);
}

Mat3 CalibrationOf(const Intrinsic& intrinsic) {
  Mat3 matrix = Mat3::Identity();
  matrix(0, 0) = intrinsic.fx_px;
  matrix(1, 1) = intrinsic.fy_px;
  matrix.col(2).head<2>() = intrinsic.principal_point_px;
  return matrix;
}

void BindViews(py::module_& module) {
  py::class_<View>(module, "View", "One photograph.")
      .def_readonly("local_path", &View::local_path)
      .def_readonly("filename", &View::filename)
      .def_readonly("width_px", &View::width_px)
      .def_readonly("height_px", &View::height_px)
      .def_property_readonly(
          "intrinsic_id",
          [](const View& view) { return IdOrNone(view.intrinsic_id); })
      .def_property_readonly(
          "pose_id", [](const View& view) { return IdOrNone(view.pose_id); })
      .def("__repr__", [](const View& view) {
        return "<lowlap.View: " + view.filename + ">";
      });

  py::class_<Intrinsic>(
      module, "Intrinsic",
      "A camera in pixels; the centre of the top-left pixel is (0, 0).")
      .def_property_readonly("model",
                             [](const Intrinsic& intrinsic) {
                               return CameraModelName(intrinsic.model);
                             })
      .def_readonly("width_px", &Intrinsic::width_px)
      .def_readonly("height_px", &Intrinsic::height_px)
      .def_readonly("fx_px", &Intrinsic::fx_px)
      .def_readonly("fy_px", &Intrinsic::fy_px)
      .def_readonly("principal_point_px", &Intrinsic::principal_point_px)
      .def_property_readonly("distortion",
                             [](const py::object& self) {
                               const auto& all =
                                   self.cast<const Intrinsic&>().distortion;
                               return MemberArray(all, all.data(), 0, self);
                             })
      .def_property_readonly("calibration", &CalibrationOf,
                             "The 3x3 matrix, without the distortion.")
      .def("project", &Intrinsic::Project, py::arg("point_in_cam"),
           "The pixel of a point in camera coordinates.")
      .def("bearing", &Intrinsic::Bearing, py::arg("pixel_px"),
           "The unit viewing ray of a pixel, or None.");

  py::class_<Pose>(module, "Pose", "x_cam = rotation (X - center).")
      .def(py::init([](const Mat3& rotation, const Vec3& center) {
             return Pose{rotation, center};
           }),
           py::arg("rotation"), py::arg("center"))
      .def_readonly("rotation", &Pose::rotation, "Camera from world, (3, 3).")
      .def_readonly("center", &Pose::center, "In the world, (3,).")
      .def_readonly("center_covariance", &Pose::center_covariance,
                    "(3, 3), world units squared, or None: of the error that\n"
                    "a similarity to the true centres leaves.")
      .def("__repr__", [](const py::object& self) {
        return py::str("<lowlap.Pose: center {}>").format(self.attr("center"));
      });

  py::class_<ViewFeatures>(module, "ViewFeatures",
                           "What is detected in a view, in raw pixels.")
      .def_property_readonly("points_px", &PointsOf, "(n, 2).")
      .def_property_readonly("segments_px", &SegmentsOf,
                             "(m, 4): x1, y1, x2, y2.")
      .def_property_readonly("segment_stddevs_px", &SegmentDeviationsOf,
                             "(m,): of an end point across the segment.")
      .def_property_readonly(
          "repeated_points",
          [](const py::object& self) {
            return IndexArray(self.cast<const ViewFeatures&>().repeated_points,
                              self);
          },
          "Those of a pattern that repeats in the photograph, ascending.")
      .def_property_readonly(
          "repeated_segments",
          [](const py::object& self) {
            return IndexArray(
                self.cast<const ViewFeatures&>().repeated_segments, self);
          },
          "The same of segments.");
}

}  // namespace

void BindSceneParts(py::module_& module) {
  BindViews(module);

  py::class_<RelativePose>(
      module, "RelativePose",
      "x_second = rotation x_first + length direction; the length is unknown.")
      .def_readonly("views", &RelativePose::views)
      .def_readonly("rotation", &RelativePose::rotation)
      .def_readonly("direction", &RelativePose::direction,
                    "Unit vector, in the second camera.")
      .def_readonly("log10_nfa", &RelativePose::log10_nfa)
      .def_readonly("covariance", &RelativePose::covariance,
                    "(5, 5) or None: rotation error in radians, and direction\n"
                    "error in two axes across it.")
      .def_property_readonly(
          "point_inliers",
          [](const py::object& self) {
            return IndexArray(self.cast<const RelativePose&>().point_inliers,
                              self);
          },
          "(n, 2): indices of the point in the first and the second view.")
      .def_property_readonly(
          "line_inliers",
          [](const py::object& self) {
            return IndexArray(self.cast<const RelativePose&>().line_inliers,
                              self);
          },
          "(m, 2): indices of the segment, likewise.")
      .def_property_readonly(
          "weakness",
          [](const RelativePose& pose) -> std::optional<std::string> {
            if (!pose.weakness) return std::nullopt;
            return PoseWeaknessName(*pose.weakness);
          },
          "What speaks against the pose though its matches bear it out:\n"
          "\"matches_side_by_side\", \"surroundings\", \"repeats\" or None.");

  py::class_<Landmark>(module, "Landmark", "A point of the structure.")
      .def_readonly("position", &Landmark::position, "(3,).")
      .def_property_readonly("observations", &ObservationsOf,
                             "(n, 2): view, index of the point.")
      .def_property_readonly("pixels_px", &PixelsOf, "(n, 2).");

  py::class_<LineLandmark>(module, "LineLandmark", "A line of the structure.")
      .def_readonly("start", &LineLandmark::start, "(3,).")
      .def_readonly("end", &LineLandmark::end, "(3,).")
      .def_property_readonly(
          "direction",
          [](const LineLandmark& line) { return line.line.direction; })
      .def_property_readonly(
          "moment", [](const LineLandmark& line) { return line.line.moment; },
          "X x direction, for every X on the line.")
      .def_property_readonly(
          "observations",
          [](const py::object& self) {
            return IndexArray(self.cast<const LineLandmark&>().observations,
                              self);
          },
          "(n, 2): view, index of the segment.");
}

}  // namespace lowlap::python
