#include "scene/example_scenes.h"

#include <limits>
#include <string>

#include "geometry/random_geometry.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap::testing {
namespace {

Intrinsic MakeIntrinsic(CameraModel model) {
  Intrinsic intrinsic;
  intrinsic.model = model;
  intrinsic.width_px = 640;
  intrinsic.height_px = 480;
  if (model == CameraModel::kSpherical) return intrinsic;
  intrinsic.fx_px = intrinsic.fy_px = 500.0 + 1.0 / 3.0;
  intrinsic.principal_point_px = Vec2(319.5, 239.5 + 1e-13);
  for (int n = 0; n < DistortionCount(model); ++n) {
    intrinsic.distortion.push_back(0.01 / (n + 3) * (n % 2 ? -1 : 1));
  }
  return intrinsic;
}

LineLandmark MakeLine(Random& random, Track observations) {
  LineLandmark landmark;
  landmark.start = RandomVector(random);
  landmark.end = RandomVector(random);
  landmark.line = PluckerLine::FromPoints(landmark.start, landmark.end);
  landmark.observations = std::move(observations);
  return landmark;
}

}  // namespace

Scene FullScene() {
  Scene scene;
  scene.root_path = "images \"of\" a\\b\t\xC3\xA9t\xC3\xA9";
  const CameraModel models[] = {
      CameraModel::kPinhole, CameraModel::kRadialK1, CameraModel::kRadialK3,
      CameraModel::kBrownT2, CameraModel::kFisheye,  CameraModel::kSpherical};
  Random random(7);
  for (std::uint32_t n = 0; n < 7; ++n) {
    // Ids with gaps; the last view has no intrinsic and the fifth no pose.
    const ViewId id = 3 * n + 1;
    View& view = scene.views[id];
    view.local_path = n % 2 ? "sub/dir" : "";
    view.filename = "view" + std::to_string(n) + ".jpg";
    view.width_px = 640;
    view.height_px = 480;
    view.pose_id = 100 + n;
    if (n < 6) {
      view.intrinsic_id = 10 * n;
      scene.intrinsics[10 * n] = MakeIntrinsic(models[n]);
    }
    if (n == 4) continue;
    scene.poses[100 + n] = {RotationFromAngleAxis(RandomVector(random)),
                            RandomVector(random)};
  }
  scene.intrinsics[20].fy_px = 499.0;
  scene.given_intrinsics[20] = scene.intrinsics[0];
  scene.given_intrinsics[30] = scene.intrinsics[40];
  scene.poses[101].center_covariance =
      Mat3{{2, 0.1, -1.0 / 3}, {0.1, 5e-324, 0}, {-1.0 / 3, 0, 1e30}};
  scene.views[4].center_prior = CenterPrior{{0.5, 1, 2}, {1e22, -1.0 / 3, 0.1}};

  for (const ViewId id : {1u, 4u, 7u}) {
    ViewFeatures& features = scene.features[id];
    for (int n = 0; n < 6; ++n) {
      // In this order, which the files of earlier versions were written with.
      const double y = random.Uniform(0, 480);
      const double x = random.Uniform(0, 640);
      features.points_px.emplace_back(x, y);
      features.segments.push_back(
          {{random.Uniform(0, 640), 5e-324}, {-0.1, 1e300}, 1.0 / 7});
    }
  }
  for (int n = 0; n < 6; ++n) {
    scene.features[4].point_covariances.emplace_back(1.0 + n, -1.0 / 3, 1);
  }
  scene.features[4].repeated_points = {0, 3, 5};
  scene.features[4].repeated_segments = {2};
  scene.features[10];  // looked at, and nothing found

  RelativePose edge;
  edge.views = {1, 4};
  edge.rotation = RotationFromAngleAxis({0.1, -0.2, 0.3});
  edge.direction = Vec3(1, 2, 3).normalized();
  edge.point_inliers = {{0, 5}, {5, 0}, {2, 2}};
  edge.line_inliers = {{3, 4}};
  edge.log10_nfa = -123.456;
  edge.point_threshold_px = 0.75;
  edge.covariance = 1e-5 * Eigen::Matrix<double, 5, 5>::Identity();
  (*edge.covariance)(0, 3) = (*edge.covariance)(3, 0) = 1e-7 / 3;
  edge.alternatives.push_back(
      {edge.rotation.transpose(), -edge.direction, -1.0 / 3, edge.covariance});
  edge.alternatives.push_back({Mat3::Identity(), Vec3::UnitZ(), -2, {}});
  edge.weakness = PoseWeakness::kSurroundings;
  scene.relative_poses[edge.views] = edge;
  edge.views = {4, 7};
  edge.covariance.reset();
  edge.alternatives.clear();
  edge.weakness.reset();
  edge.line_inliers.clear();
  scene.relative_poses[edge.views] = edge;

  scene.unrelated_pairs = {{1, 7}, {4, 10}};

  scene.point_tracks[0] = {{1, 0}, {4, 5}};
  scene.point_tracks[4000000000u] = {{1, 2}, {4, 2}, {7, 0}};
  scene.line_tracks[2] = {{1, 3}, {4, 0}, {4, 4}};
  scene.line_tracks[3] = {{4, 1}, {7, 1}};

  ScaleRatio ratio;
  ratio.views = {7, 4, 1};
  ratio.verdict = RatioVerdict::kMeaningful;
  ratio.log_ratio = std::numeric_limits<double>::epsilon() - 1;
  ratio.log_ratio_stddev = 1e-3;
  ratio.log10_nfa = -20.5;
  ratio.second_mode = RatioMode{0.1 + 0.2, -3.5};
  ratio.kinds = {{"points", 10, 8, -12.25, 0.5, 0.7},
                 {"lines", 4, 3, -8.25, 1.5, 0.3},
                 {"coplanar", 20, 5, 0, 2, 0, 3}};
  ratio.num_rejected_negative = 3;
  ratio.coplanar_inliers = {{0, 1}, {5, 2}};
  scene.scale_ratios = {ratio};

  Landmark landmark;
  landmark.position =
      Vec3(0.1 + 0.2, -1e-7, std::numeric_limits<double>::max());
  landmark.observations = {{1, 0, {1.5, 2.25}}, {4, kInvalidId, {-3, 0.1}}};
  scene.structure[0] = landmark;
  landmark.observations = {{4, 5, {1, 2}}, {7, 1, {3, 4}}, {13, 77, {5, 6}}};
  scene.structure[9] = landmark;
  scene.line_structure[2] = MakeLine(random, scene.line_tracks[2]);
  scene.line_structure[3] = MakeLine(random, scene.line_tracks[3]);
  scene.coplanar_pairs = {{2, 3}};
  landmark.observations.clear();
  scene.control_points[5] = landmark;
  landmark.observations = {{1, 12345, {7, 8}}};
  scene.control_points[6] = landmark;
  return scene;
}

Scene RandomScene(std::uint64_t seed, std::uint32_t num_views,
                  std::uint32_t num_points, std::uint32_t num_lines) {
  Random random(seed);
  Scene scene;
  scene.root_path = "images";
  scene.intrinsics[0] = MakeIntrinsic(CameraModel::kRadialK3);
  const auto pixel = [&] {
    return Vec2{random.Uniform(0, 640), random.Uniform(0, 480)};
  };
  for (std::uint32_t id = 0; id < num_views; ++id) {
    scene.views[id] = {"", std::to_string(id) + ".jpg", 640, 480, 0, id, {}};
    scene.poses[id] = {RotationFromAngleAxis(RandomVector(random)),
                       RandomVector(random)};
    scene.features[id];
  }
  // Every point and line gets its own feature in two or three views.
  const auto new_point = [&](ViewId id) {
    scene.features[id].points_px.push_back(pixel());
    return static_cast<FeatureIndex>(scene.features[id].points_px.size() - 1);
  };
  const auto new_segment = [&](ViewId id) {
    scene.features[id].segments.push_back({pixel(), pixel(), 0.5});
    return static_cast<FeatureIndex>(scene.features[id].segments.size() - 1);
  };
  for (std::uint32_t id = 0; id + 1 < num_views; ++id) {
    RelativePose edge;
    edge.views = {id, id + 1};
    edge.rotation = RotationFromAngleAxis(RandomVector(random));
    edge.direction = RandomVector(random).normalized();
    edge.log10_nfa = -random.Uniform(10, 500);
    scene.relative_poses[edge.views] = edge;
  }
  for (std::uint32_t n = 0; n < num_points; ++n) {
    const std::uint32_t first = random.Index(num_views - 1);
    const std::uint32_t last =
        std::min(num_views - 1, first + 1 + random.Index(2));
    Track track;
    Landmark landmark;
    landmark.position = RandomVector(random);
    for (std::uint32_t id = first; id <= last; ++id) {
      track.push_back({id, new_point(id)});
      landmark.observations.push_back(
          {id, track.back().feature,
           scene.features[id].points_px[track.back().feature]});
    }
    scene.relative_poses[{first, first + 1}].point_inliers.push_back(
        {track[0].feature, track[1].feature});
    scene.point_tracks[n] = std::move(track);
    scene.structure[n] = std::move(landmark);
  }
  for (std::uint32_t n = 0; n < num_lines; ++n) {
    const std::uint32_t first = random.Index(num_views - 1);
    const Track track = {{first, new_segment(first)},
                         {first + 1, new_segment(first + 1)}};
    scene.relative_poses[{first, first + 1}].line_inliers.push_back(
        {track[0].feature, track[1].feature});
    scene.line_tracks[n] = track;
    scene.line_structure[n] = MakeLine(random, track);
    if (n > 0) scene.coplanar_pairs.push_back({n - 1, n});
  }
  for (std::uint32_t id = 0; id + 2 < num_views; ++id) {
    ScaleRatio ratio;
    ratio.views = {id, id + 1, id + 2};
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log_ratio = random.Gaussian();
    ratio.log_ratio_stddev = random.Uniform();
    ratio.log10_nfa = -random.Uniform(0, 100);
    scene.scale_ratios.push_back(ratio);
  }
  return scene;
}

}  // namespace lowlap::testing
