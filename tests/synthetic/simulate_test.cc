#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/geometry/internal/triangulation.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/validation.h"
#include "lowlap/synthetic/internal/coplanar_truth.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"
#include "synthetic/must_simulate.h"

namespace lowlap {
namespace {

using testing::IsOk;
using testing::MustSimulate;
using testing::RotationNear;
using testing::VectorNear;

double DistanceToLinePx(const Vec2& pixel, const Vec3& line) {
  return std::abs(line.dot(pixel.homogeneous())) / line.head<2>().norm();
}

class EveryKind : public ::testing::TestWithParam<SyntheticKind> {
 protected:
  SyntheticOptions Options() const {
    SyntheticOptions options;
    options.kind = GetParam();
    options.seed = 3;
    return options;
  }
};

TEST_P(EveryKind, IsAValidUnsolvedScene) {
  SyntheticOptions options = Options();
  options.noise_px = 1.0;
  options.broken_line_share = 0.3;
  options.wrong_point_share = options.wrong_line_share = 0.2;
  options.rotation_noise_deg = options.direction_noise_deg = 1.0;
  const SyntheticScene synthetic = MustSimulate(options);
  EXPECT_THAT(ValidateScene(synthetic.scene), IsOk());
  EXPECT_THAT(ValidateScene(TrueSolution(synthetic)), IsOk());
  EXPECT_TRUE(synthetic.scene.poses.empty());
  EXPECT_EQ(synthetic.scene.views.size(), 12u);
  EXPECT_EQ(synthetic.true_poses.size(), 12u);
  // The ends of a corridor or a long wall see nothing in common: no closing
  // pair.
  const bool open = GetParam() == SyntheticKind::kCorridor ||
                    GetParam() == SyntheticKind::kPlanar;
  EXPECT_EQ(synthetic.scene.relative_poses.size(), open ? 11u : 12u);
  EXPECT_EQ(synthetic.true_baselines.size(),
            synthetic.scene.relative_poses.size());
}

TEST_P(EveryKind, WithoutNoiseEverythingIsExact) {
  const SyntheticScene synthetic = MustSimulate(Options());
  const Scene& scene = synthetic.scene;
  ASSERT_EQ(synthetic.true_points.size(), scene.point_tracks.size());
  for (const auto& [id, track] : scene.point_tracks) {
    for (const FeatureRef& ref : track) {
      const Vec3 in_cam = synthetic.true_poses.at(ref.view).CamFromWorld() *
                          synthetic.true_points.at(id);
      ASSERT_GT(in_cam.z(), 0);
      ASSERT_THAT(
          scene.FindIntrinsic(ref.view)->Project(in_cam),
          VectorNear(scene.features.at(ref.view).points_px[ref.feature], 1e-9));
    }
  }
  ASSERT_EQ(synthetic.true_lines.size(), scene.line_tracks.size());
  for (const auto& [id, track] : scene.line_tracks) {
    const SyntheticLine& line = synthetic.true_lines.at(id);
    for (const FeatureRef& ref : track) {
      const RigidTransform cam =
          synthetic.true_poses.at(ref.view).CamFromWorld();
      const Vec3 normal = (cam * line.start).cross(cam * line.end);
      const Intrinsic& k = *scene.FindIntrinsic(ref.view);
      // K^-T n, for a pinhole.
      Vec3 image(normal.x() / k.fx_px, normal.y() / k.fy_px, normal.z());
      image.z() -= image.head<2>().dot(k.principal_point_px);
      const LineSegment& segment =
          scene.features.at(ref.view).segments[ref.feature];
      ASSERT_LT(DistanceToLinePx(segment.start_px, image), 1e-6);
      ASSERT_LT(DistanceToLinePx(segment.end_px, image), 1e-6);
      ASSERT_GT(segment.LengthPx(), 10);
    }
    for (const int plane : line.planes) {
      for (const Vec3& end : {line.start, line.end}) {
        ASSERT_NEAR(synthetic.planes[plane].dot(end.homogeneous()), 0, 1e-9);
      }
    }
  }
  for (const auto& [pair, edge] : scene.relative_poses) {
    const NormalizedFeatures first = NormalizeFeatures(
        scene.features.at(pair.first), *scene.FindIntrinsic(pair.first));
    const NormalizedFeatures second = NormalizeFeatures(
        scene.features.at(pair.second), *scene.FindIntrinsic(pair.second));
    const Mat3 essential = EssentialFromPose(edge.Cam2FromCam1());
    for (const FeatureMatch& match : edge.point_inliers) {
      const Vec3& x1 = first.points[match.first];
      const Vec3& x2 = second.points[match.second];
      ASSERT_LT(SampsonSquared(essential, x1, x2), 1e-20);
      if (synthetic.true_baselines.at(pair) == 0) continue;
      // The stored direction has the sign that puts the points in front.
      ASSERT_TRUE(TriangulateMidpoint(edge.Cam2FromCam1(), x1, x2));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryKind,
    ::testing::Values(SyntheticKind::kRoom, SyntheticKind::kCorridor,
                      SyntheticKind::kRing, SyntheticKind::kHouse,
                      SyntheticKind::kCloud, SyntheticKind::kPlanar,
                      SyntheticKind::kCollinear),
    [](const auto& kind) { return SyntheticKindName(kind.param); });

TEST(Simulate, BaselinesAndRatiosAreThoseOfTheCentres) {
  const SyntheticScene synthetic = MustSimulate({});
  const auto distance = [&](ViewId a, ViewId b) {
    return (synthetic.true_poses.at(a).center -
            synthetic.true_poses.at(b).center)
        .norm();
  };
  EXPECT_NEAR(*synthetic.TrueLogRatio({2, 3, 4}),
              std::log(distance(3, 4) / distance(2, 3)), 1e-12);
  EXPECT_NEAR(*synthetic.TrueLogRatio({4, 3, 2}),
              -*synthetic.TrueLogRatio({2, 3, 4}), 1e-12);
  EXPECT_NEAR(*synthetic.TrueLogRatio({1, 0, 11}),
              std::log(distance(0, 11) / distance(0, 1)), 1e-12);
  EXPECT_EQ(synthetic.TrueLogRatio({2, 3, 5}), std::nullopt);
}

TEST(Simulate, SeedDecidesEverything) {
  SyntheticOptions options;
  options.noise_px = 1;
  options.wrong_point_share = options.wrong_line_share = 0.2;
  options.wrong_candidate_share = 0.5;
  options.trifocal_point_share = options.trifocal_line_share = 0.3;
  const SyntheticScene a = MustSimulate(options);
  const SyntheticScene b = MustSimulate(options);
  EXPECT_TRUE(a.scene == b.scene);
  options.seed = 1;
  EXPECT_FALSE(a.scene == MustSimulate(options).scene);
}

TEST(Simulate, PairsAsAsked) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kRing;
  options.num_views = 6;
  const auto count = [&](const std::string& pairs) {
    options.pairs = pairs;
    return MustSimulate(options).scene.relative_poses.size();
  };
  EXPECT_EQ(count("chain"), 5u);
  EXPECT_EQ(count("cycle"), 6u);
  EXPECT_EQ(count("window:2"), 9u);
  EXPECT_EQ(count("window:99"), 15u);
  EXPECT_GE(count("all"), 5u);
  options.num_views = 2;
  EXPECT_EQ(count("cycle"), 1u);
}

TEST(Simulate, TrifocalSharesAsAsked) {
  SyntheticOptions options;
  options.seed = 5;
  const auto trifocal = [](const auto& tracks) {
    return std::count_if(tracks.begin(), tracks.end(), [](const auto& entry) {
      return entry.second.size() > 2;
    });
  };
  const SyntheticScene all = MustSimulate(options);
  const double all_points = trifocal(all.scene.point_tracks);
  const double all_lines = trifocal(all.scene.line_tracks);
  EXPECT_GT(all_points, 0.5 * all.scene.point_tracks.size());
  EXPECT_GT(all_lines, 0.5 * all.scene.line_tracks.size());

  options.trifocal_point_share = 0.4;
  options.trifocal_line_share = 0.2;
  const SyntheticScene some = MustSimulate(options);
  EXPECT_NEAR(trifocal(some.scene.point_tracks) / all_points, 0.4, 0.07);
  EXPECT_NEAR(trifocal(some.scene.line_tracks) / all_lines, 0.2, 0.05);
}

TEST(Simulate, NoTrifocalFeatureWhenNoneIsAsked) {
  for (const char* pairs : {"chain", "cycle", "window:3", "all"}) {
    SyntheticOptions options;
    options.pairs = pairs;
    options.noise_px = 1;
    options.wrong_point_share = options.wrong_line_share = 0.2;
    options.broken_line_share = 0.3;
    options.trifocal_point_share = options.trifocal_line_share = 0;
    const SyntheticScene synthetic = MustSimulate(options);
    const auto expect_pairs = [](const auto& tracks) {
      ASSERT_FALSE(tracks.empty());
      for (const auto& [id, track] : tracks) {
        std::set<ViewId> views;
        for (const FeatureRef& ref : track) views.insert(ref.view);
        ASSERT_EQ(views.size(), 2u);
      }
    };
    ASSERT_NO_FATAL_FAILURE(expect_pairs(synthetic.scene.point_tracks));
    ASSERT_NO_FATAL_FAILURE(expect_pairs(synthetic.scene.line_tracks));
    // No feature of a view is matched in two pairs.
    std::set<FeatureRef> points, segments;
    for (const auto& [pair, edge] : synthetic.scene.relative_poses) {
      std::set<FeatureRef> pair_segments;
      for (const FeatureMatch& match : edge.point_inliers) {
        ASSERT_TRUE(points.insert({pair.first, match.first}).second);
        ASSERT_TRUE(points.insert({pair.second, match.second}).second);
      }
      for (const FeatureMatch& match : edge.line_inliers) {
        pair_segments.insert({pair.first, match.first});
        pair_segments.insert({pair.second, match.second});
      }
      for (const FeatureRef& ref : pair_segments) {
        ASSERT_TRUE(segments.insert(ref).second);
      }
    }
  }
}

TEST(Simulate, NoiseAsAsked) {
  SyntheticOptions options;
  const SyntheticScene exact = MustSimulate(options);
  options.noise_px = 2.0;
  const SyntheticScene noisy = MustSimulate(options);
  double sum = 0;
  int count = 0;
  for (const auto& [view, features] : exact.scene.features) {
    const ViewFeatures& others = noisy.scene.features.at(view);
    ASSERT_EQ(features.points_px.size(), others.points_px.size());
    ASSERT_EQ(features.segments.size(), others.segments.size());
    for (std::size_t i = 0; i < features.points_px.size(); ++i) {
      sum += (features.points_px[i] - others.points_px[i]).squaredNorm();
      count += 2;
    }
    for (std::size_t i = 0; i < features.segments.size(); ++i) {
      sum += (features.segments[i].start_px - others.segments[i].start_px)
                 .squaredNorm();
      count += 2;
      EXPECT_EQ(others.segments[i].stddev_px, 2.0);
    }
  }
  EXPECT_NEAR(std::sqrt(sum / count), 2.0, 0.05);
}

TEST(Simulate, RelativePoseNoiseAsAskedAndWithItsCovariance) {
  SyntheticOptions options;
  options.num_views = 400;
  options.kind = SyntheticKind::kCorridor;
  options.points_per_wall = options.lines_per_wall = 0;
  const SyntheticScene exact = MustSimulate(options);
  options.rotation_noise_deg = 0.5;
  options.direction_noise_deg = 2.0;
  const SyntheticScene noisy = MustSimulate(options);
  double rotation = 0, direction = 0;
  for (const auto& [pair, edge] : noisy.scene.relative_poses) {
    const RelativePose& truth = exact.scene.relative_poses.at(pair);
    EXPECT_FALSE(truth.covariance);
    ASSERT_TRUE(edge.covariance);
    EXPECT_NEAR((*edge.covariance)(0, 0), std::pow(RadFromDeg(0.5), 2), 1e-12);
    EXPECT_NEAR((*edge.covariance)(4, 4), std::pow(RadFromDeg(2.0), 2), 1e-12);
    rotation +=
        std::pow(RotationAngleBetween(truth.rotation, edge.rotation), 2);
    direction += std::pow(AngleBetween(truth.direction, edge.direction), 2);
  }
  const double n = noisy.scene.relative_poses.size();
  EXPECT_NEAR(DegFromRad(std::sqrt(rotation / n / 3)), 0.5, 0.05);
  EXPECT_NEAR(DegFromRad(std::sqrt(direction / n / 2)), 2.0, 0.2);
}

TEST(Simulate, BrokenLinesAsAsked) {
  SyntheticOptions options;
  options.broken_line_share = 0.3;
  const SyntheticScene synthetic = MustSimulate(options);
  int lines = 0, broken = 0;
  for (const auto& [id, track] : synthetic.scene.line_tracks) {
    for (std::size_t i = 0; i < track.size(); ++i) {
      const bool second_piece = i > 0 && track[i].view == track[i - 1].view;
      ++(second_piece ? broken : lines);
    }
  }
  EXPECT_NEAR(static_cast<double>(broken) / lines, 0.3, 0.03);
}

TEST(Simulate, PureRotationHasTheFirstTwoCentresInOne) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kPureRotation;
  const SyntheticScene synthetic = MustSimulate(options);
  EXPECT_EQ(synthetic.true_baselines.at({0, 1}), 0.0);
  EXPECT_EQ(synthetic.TrueLogRatio({0, 1, 2}), std::nullopt);
  EXPECT_THAT(ValidateScene(synthetic.scene), IsOk());
  const RelativePose& edge = synthetic.scene.relative_poses.at({0, 1});
  EXPECT_THAT(edge.rotation,
              RotationNear(synthetic.true_poses.at(1).rotation *
                               synthetic.true_poses.at(0).rotation.transpose(),
                           1e-6));
  ASSERT_FALSE(edge.point_inliers.empty());
  const Scene& scene = synthetic.scene;
  for (const FeatureMatch& match : edge.point_inliers) {
    const Vec3 ray = *scene.FindIntrinsic(0)->Bearing(
        scene.features.at(0).points_px[match.first]);
    EXPECT_THAT(scene.FindIntrinsic(1)->Project(edge.rotation * ray),
                VectorNear(scene.features.at(1).points_px[match.second], 1e-6));
  }
}

TEST(Simulate, CollinearCentresAreOnOneLine) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kCollinear;
  const SyntheticScene synthetic = MustSimulate(options);
  const Vec3 origin = synthetic.true_poses.at(0).center;
  const Vec3 axis = (synthetic.true_poses.at(11).center - origin).normalized();
  for (const auto& [view, pose] : synthetic.true_poses) {
    EXPECT_LT(axis.cross(pose.center - origin).norm(), 1e-9);
  }
}

TEST(Simulate, PlanarIsOnePlane) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kPlanar;
  const SyntheticScene synthetic = MustSimulate(options);
  ASSERT_EQ(synthetic.planes.size(), 1u);
  for (const auto& [id, point] : synthetic.true_points) {
    EXPECT_NEAR(synthetic.planes[0].dot(point.homogeneous()), 0, 1e-9);
  }
}

}  // namespace
}  // namespace lowlap
