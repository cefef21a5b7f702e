#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lowlap/report/internal/page_data.h"

namespace lowlap {
namespace {

using nlohmann::json;

// One camera at the origin that looks along z.
Scene SceneOf(const Intrinsic& intrinsic) {
  Scene scene;
  scene.intrinsics[0] = intrinsic;
  View view;
  view.filename = "0.jpg";
  view.width_px = intrinsic.width_px;
  view.height_px = intrinsic.height_px;
  view.intrinsic_id = 0;
  view.pose_id = 0;
  scene.views[0] = view;
  scene.poses[0] = Pose();
  return scene;
}

// A point, observed `off_px` from its projection.
void AddPoint(const Vec3& point, const Vec2& off_px, Scene* scene) {
  const Vec2 pixel_px = scene->intrinsics.at(0).Project(point) + off_px;
  ViewFeatures& features = scene->features[0];
  features.points_px.push_back(pixel_px);
  scene->structure[0] = {point, {{0, 0, pixel_px}}};
}

// A line, and a segment whose ends are `off_px` from the projections of its.
void AddLine(const Vec3& start, const Vec3& end, const Vec2& off_px,
             Scene* scene) {
  const Intrinsic& intrinsic = scene->intrinsics.at(0);
  LineSegment segment;
  segment.start_px = intrinsic.Project(start) + off_px;
  segment.end_px = intrinsic.Project(end) + off_px;
  scene->features[0].segments.push_back(segment);
  LineLandmark line;
  line.line = PluckerLine::FromPoints(start, end);
  line.start = start;
  line.end = end;
  line.observations = {{0, 0}};
  scene->line_structure[0] = line;
}

double RmsePx(const Scene& scene, const char* kind) {
  const json page = json::parse(PageData(scene, ReportContent()));
  const json& after = page["residuals"][kind]["after"];
  EXPECT_EQ(after["total"], 1);
  return after["rmse_px"];
}

Intrinsic Panorama() {
  Intrinsic intrinsic;
  intrinsic.model = CameraModel::kSpherical;
  intrinsic.width_px = 1000;
  intrinsic.height_px = 500;
  return intrinsic;
}

TEST(PageResiduals, OfAPanoramaGoTheShortWayRound) {
  // Behind the camera is the seam: 0.2 px from it, observed on its other side.
  Scene scene = SceneOf(Panorama());
  const double angle_rad = 0.2 / scene.intrinsics.at(0).MeanFocalPx();
  const Vec3 behind(std::sin(angle_rad), 0, -std::cos(angle_rad));
  ASSERT_NEAR(scene.intrinsics.at(0).Project(behind).x(), 999.8, 1e-9);
  AddPoint(behind, Vec2(0.5 - 1000, 0), &scene);
  EXPECT_NEAR(RmsePx(scene, "points"), 0.5, 1e-9);
}

TEST(PageResiduals, OfAPanoramaCountLinesBehindIt) {
  Scene scene = SceneOf(Panorama());
  // On the equator, so that the image of the line is straight.
  AddLine({3, 0, -1}, {1, 0, -3}, {0, 0.5}, &scene);
  EXPECT_NEAR(RmsePx(scene, "lines"), 0.5, 1e-3);
}

TEST(PageResiduals, OfADistortedCameraAreInItsOwnPixels) {
  Intrinsic intrinsic;
  intrinsic.model = CameraModel::kRadialK1;
  intrinsic.width_px = 1600;
  intrinsic.height_px = 1200;
  intrinsic.fx_px = intrinsic.fy_px = 1000;
  intrinsic.principal_point_px = {800, 600};
  intrinsic.distortion = {-0.25};
  Scene scene = SceneOf(intrinsic);
  AddPoint({0.7, 0, 1}, {0.5, 0}, &scene);
  EXPECT_NEAR(RmsePx(scene, "points"), 0.5, 1e-9);
  // Upright near the right border, where a pixel is 1.6 undistorted ones.
  AddLine({0.7, -0.01, 1}, {0.7, 0.01, 1}, {0.5, 0}, &scene);
  EXPECT_NEAR(RmsePx(scene, "lines"), 0.5, 0.01);
}

TEST(PageResiduals, WithoutObservationsThereIsNoRmse) {
  const json page = json::parse(PageData(SceneOf(Panorama()), ReportContent()));
  const json& after = page["residuals"]["lines"]["after"];
  EXPECT_EQ(after["total"], 0);
  EXPECT_TRUE(after["rmse_px"].is_null());
  EXPECT_TRUE(after["median_px"].is_null());
}

}  // namespace
}  // namespace lowlap
