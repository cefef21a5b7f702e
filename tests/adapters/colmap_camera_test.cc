#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "third_party_adapters/colmap/internal/camera.h"

namespace lowlap::colmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Camera Make(const std::string& model, const std::vector<double>& params) {
  return {7, *ModelFromName(model), 800, 600, params};
}

// COLMAP's pixel of (u, v, 1), from its documentation of the models.
Vec2 Project(const std::string& model, const std::vector<double>& p, double u,
             double v) {
  const bool one_focal =
      model.rfind("SIMPLE", 0) == 0 || model.rfind("RADIAL", 0) == 0;
  const double fx = p[0], fy = one_focal ? p[0] : p[1];
  const std::size_t pp = one_focal ? 1 : 2;
  const std::vector<double> k(p.begin() + static_cast<long>(pp) + 2, p.end());
  const double r = std::hypot(u, v), theta = std::atan(r);
  double x = u, y = v;
  if (model.find("FISHEYE") != model.npos) {
    double factor = 1;
    for (std::size_t n = 0; n < k.size() && n < 4; ++n) {
      // Of the thin prism, 2 and 3 are tangential and 4 and 5 go on.
      const std::size_t place = model[0] == 'T' && n >= 2 ? n + 2 : n;
      factor += k[place] * std::pow(theta, 2.0 * static_cast<double>(n) + 2);
    }
    x = u * theta / r * factor;
    y = v * theta / r * factor;
  } else if (k.size() >= 4) {
    const double r2 = r * r;
    double radial = 1 + k[0] * r2 + k[1] * r2 * r2;
    if (k.size() == 8) radial += k[4] * r2 * r2 * r2;
    x = u * radial + 2 * k[2] * u * v + k[3] * (r2 + 2 * u * u);
    y = v * radial + 2 * k[3] * u * v + k[2] * (r2 + 2 * v * v);
  } else {
    double radial = 1;
    for (std::size_t n = 0; n < k.size(); ++n) {
      radial += k[n] * std::pow(r, 2.0 * static_cast<double>(n) + 2);
    }
    x = u * radial;
    y = v * radial;
  }
  return {fx * x + p[pp], fy * y + p[pp + 1]};
}

struct CameraCase {
  const char* model;
  std::vector<double> params;
};

const std::vector<CameraCase>& HeldCameras() {
  static const std::vector<CameraCase> cases = {
      {"SIMPLE_PINHOLE", {500, 400.25, 300}},
      {"PINHOLE", {500, 510, 400.25, 300}},
      {"SIMPLE_RADIAL", {500, 400, 300.5, -0.12}},
      {"RADIAL", {500, 400, 300, -0.12, 0.03}},
      {"OPENCV", {500, 510, 400, 300, -0.12, 0.03, 0.002, -0.001}},
      {"FULL_OPENCV",
       {500, 510, 400, 300, -0.12, 0.03, 0.002, -0.001, 0.01, 0, 0, 0}},
      {"SIMPLE_RADIAL_FISHEYE", {300, 400, 300, 0.05}},
      {"RADIAL_FISHEYE", {300, 400, 300, 0.05, -0.01}},
      {"OPENCV_FISHEYE", {300, 310, 400, 300, 0.05, -0.01, 0.004, -0.001}},
      {"THIN_PRISM_FISHEYE",
       {300, 310, 400, 300, 0.05, -0.01, 0, 0, 0.004, -0.001, 0, 0}},
      {"RAD_TAN_THIN_PRISM_FISHEYE",
       {300, 310, 400, 300, 0.05, -0.01, 0.004, -0.001, 0, 0, 0, 0, 0, 0, 0,
        0}},
      {"SIMPLE_FISHEYE", {300, 400, 300}},
      {"FISHEYE", {300, 310, 400, 300}},
      {"SIMPLE_DIVISION", {500, 400, 300, 0}},
  };
  return cases;
}

TEST(ColmapCamera, EveryModelThatIsHeldProjectsToTheSamePixel) {
  for (const auto& [model, params] : HeldCameras()) {
    SCOPED_TRACE(model);
    const auto intrinsic = ToIntrinsic(Make(model, params));
    ASSERT_TRUE(intrinsic.has_value()) << intrinsic.error().ToString();
    for (const Vec2& point :
         {Vec2(0.3, -0.2), Vec2(-0.7, 0.5), Vec2(1e-3, 2e-3)}) {
      const Vec2 ours = intrinsic->Project({2 * point.x(), 2 * point.y(), 2});
      const Vec2 theirs = Project(model, params, point.x(), point.y());
      EXPECT_LT((ours + PixelShift(*intrinsic) - theirs).norm(), 1e-10);
    }
  }
}

// Worked by hand: (0.5, 0.25) has r^2 = 0.3125.
TEST(ColmapCamera, PixelsByHand) {
  const auto pixel = [](const char* model, const std::vector<double>& params) {
    return Vec2(ToIntrinsic(Make(model, params))->Project({0.5, 0.25, 1}) +
                Vec2(0.5, 0.5));
  };
  EXPECT_LT((pixel("PINHOLE", {100, 200, 400, 300}) - Vec2(450, 350)).norm(),
            1e-12);
  // 1 + 0.1 * 0.3125 = 1.03125.
  EXPECT_LT(
      (pixel("SIMPLE_RADIAL", {100, 400, 300, 0.1}) - Vec2(451.5625, 325.78125))
          .norm(),
      1e-12);
  // x = 0.5 + 2 * 0.01 * 0.125 + 0.02 * (0.3125 + 0.5) = 0.51875,
  // y = 0.25 + 2 * 0.02 * 0.125 + 0.01 * (0.3125 + 0.125) = 0.259375.
  EXPECT_LT((pixel("OPENCV", {100, 200, 400, 300, 0, 0, 0.01, 0.02}) -
             Vec2(451.875, 351.875))
                .norm(),
            1e-12);
}

TEST(ColmapCamera, APanoramaHasNoShift) {
  const Camera camera = {
      7, *ModelFromName("EQUIRECTANGULAR"), 800, 400, {800, 400}};
  const auto intrinsic = ToIntrinsic(camera);
  ASSERT_TRUE(intrinsic.has_value()) << intrinsic.error().ToString();
  EXPECT_EQ(intrinsic->model, CameraModel::kSpherical);
  // Straight ahead, to the right, up: (theta / 2 pi + 1/2) w, (1/2 - phi / pi)
  // h with y down.
  EXPECT_LT((intrinsic->Project({0, 0, 1}) - Vec2(400, 200)).norm(), 1e-12);
  EXPECT_LT((intrinsic->Project({1, 0, 0}) - Vec2(600, 200)).norm(), 1e-12);
  EXPECT_LT((intrinsic->Project({0, -1, 1}) - Vec2(400, 100)).norm(), 1e-12);
  const auto back = FromIntrinsic(*intrinsic, 7);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->params, camera.params);
  Camera strip = camera;
  strip.height_px = 300;
  strip.params = {800, 300};
  EXPECT_EQ(ToIntrinsic(strip).error().code, ErrorCode::kUnsupported);
  Intrinsic ours = *intrinsic;
  ours.height_px = 300;
  EXPECT_EQ(FromIntrinsic(ours, 7).error().code, ErrorCode::kUnsupported);
}

TEST(ColmapCamera, WhatNoModelEqualsIsRefusedByName) {
  const std::vector<CameraCase> refused = {
      {"FOV", {500, 500, 400, 300, 0.9}},
      {"EUCM", {500, 500, 400, 300, 0.5, 1}},
      {"DIVISION", {500, 500, 400, 300, -0.1}},
      {"SIMPLE_DIVISION", {500, 400, 300, -0.1}},
      {"FULL_OPENCV", {500, 500, 400, 300, 0, 0, 0, 0, 0, 0, 0.1, 0}},
      {"THIN_PRISM_FISHEYE", {300, 300, 400, 300, 0, 0, 0, 0, 0, 0, 1e-9, 0}},
  };
  for (const auto& [model, params] : refused) {
    const auto intrinsic = ToIntrinsic(Make(model, params));
    ASSERT_FALSE(intrinsic.has_value()) << model;
    EXPECT_EQ(intrinsic.error().code, ErrorCode::kUnsupported);
    EXPECT_THAT(intrinsic.error().message,
                AllOf(HasSubstr("camera 7"), HasSubstr(model)));
  }
  EXPECT_THAT(ToIntrinsic({3, 99, 800, 600, {1, 2, 3}}).error().message,
              HasSubstr("camera 3 has model 99"));
  for (const Camera& broken :
       {Make("PINHOLE", {500, 500, 400}), Make("PINHOLE", {0, 500, 400, 300}),
        Make("SIMPLE_PINHOLE", {500, NAN, 300})}) {
    EXPECT_EQ(ToIntrinsic(broken).error().code, ErrorCode::kInvalidScene);
  }
}

Intrinsic Ours(CameraModel model, double fy, std::vector<double> distortion) {
  Intrinsic intrinsic;
  intrinsic.model = model;
  intrinsic.width_px = 800;
  intrinsic.height_px = 600;
  intrinsic.fx_px = 500;
  intrinsic.fy_px = fy;
  intrinsic.principal_point_px = {401.75, 298.5};
  intrinsic.distortion = std::move(distortion);
  return intrinsic;
}

TEST(ColmapCamera, EveryModelOfOursHasOneThatEqualsIt) {
  struct Export {
    Intrinsic ours;
    const char* model;
  };
  for (const auto& [ours, model] : {
           Export{Ours(CameraModel::kPinhole, 500, {}), "SIMPLE_PINHOLE"},
           {Ours(CameraModel::kPinhole, 501, {}), "PINHOLE"},
           {Ours(CameraModel::kRadialK1, 500, {0.1}), "SIMPLE_RADIAL"},
           {Ours(CameraModel::kRadialK1, 501, {0.1}), "OPENCV"},
           {Ours(CameraModel::kRadialK3, 500, {0.1, 0.02, 0}), "RADIAL"},
           {Ours(CameraModel::kRadialK3, 501, {0.1, 0.02, 0}), "OPENCV"},
           {Ours(CameraModel::kRadialK3, 500, {0.1, 0.02, 0.01}),
            "FULL_OPENCV"},
           {Ours(CameraModel::kBrownT2, 501, {0.1, 0.02, 0, 0.003, 0.004}),
            "OPENCV"},
           {Ours(CameraModel::kBrownT2, 501, {0.1, 0.02, 0.01, 0.003, 0.004}),
            "FULL_OPENCV"},
           {Ours(CameraModel::kFisheye, 501, {0.1, 0.02, 0.01, 0.003}),
            "OPENCV_FISHEYE"},
       }) {
    SCOPED_TRACE(model);
    const auto camera = FromIntrinsic(ours, 4);
    ASSERT_TRUE(camera.has_value()) << camera.error().ToString();
    EXPECT_STREQ(ModelName(camera->model), model);
    EXPECT_EQ(camera->id, 4u);
    const auto back = ToIntrinsic(*camera);
    ASSERT_TRUE(back.has_value()) << back.error().ToString();
    const Vec3 point(0.6, -0.4, 2);
    EXPECT_LT((back->Project(point) - ours.Project(point)).norm(), 1e-10);
    EXPECT_LT((Project(model, camera->params, 0.3, -0.2) - Vec2(0.5, 0.5) -
               ours.Project(point))
                  .norm(),
              1e-10);
    EXPECT_EQ(FromIntrinsic(*back, 4)->params, camera->params);
  }
}

}  // namespace
}  // namespace lowlap::colmap
