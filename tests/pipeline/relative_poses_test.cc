#include "lowlap/pipeline/internal/measure/relative_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "matching/pattern_view.h"
#include "support/matchers.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsOk;
using ::testing::Not;

// Three views, each turned a little further, with all of the points in each.
Scene SceneOf(const std::vector<Vec3>& points,
              const std::array<Vec3, 3>& centers, double noise_px) {
  Scene scene;
  Intrinsic& intrinsic = scene.intrinsics[0];
  intrinsic.width_px = 1600;
  intrinsic.height_px = 1200;
  intrinsic.fx_px = intrinsic.fy_px = 1300;
  intrinsic.principal_point_px = {800, 600};
  Random random(1);
  for (std::uint32_t v = 0; v < 3; ++v) {
    View& view = scene.views[v];
    view.filename = std::to_string(v) + ".jpg";
    view.width_px = 1600;
    view.height_px = 1200;
    view.intrinsic_id = 0;
    view.pose_id = v;
    const Mat3 cam_from_world =
        RotationFromAngleAxis(Vec3(0.01, 0.05, -0.02) * v);
    for (const Vec3& point : points) {
      scene.features[v].points_px.push_back(
          intrinsic.Project(cam_from_world * (point - centers[v])) +
          testing::GaussianVec2(random, noise_px));
    }
  }
  return scene;
}

Vec3 Anywhere(Random* random) {
  const Vec3 bearing =
      testing::UniformVec2(*random, {-0.4, -0.3}, {0.4, 0.3}).homogeneous();
  return random->Uniform(4, 9) * bearing;
}

constexpr int kFarPoints = 30;
constexpr FeatureIndex kNear = kFarPoints;

// A far cloud, and one near point that tells more of the directions between the
// views than all the others.
class LoneMatchTest : public ::testing::Test {
 protected:
  LoneMatchTest() {
    Random random(1);
    std::vector<Vec3> points;
    for (int n = 0; n < kFarPoints; ++n) points.push_back(Anywhere(&random));
    points.push_back(0.8 * Vec3(0.35, 0, 1));
    scene_ = SceneOf(points,
                     {Vec3(0, 0, 0), Vec3(0.3, 0, 0), Vec3(0.6, 0.08, 0)}, 0.1);
  }

  void Relate(const std::vector<ViewPair>& pairs) {
    std::map<ViewPair, PairMatches> matches;
    for (const ViewPair& pair : pairs) {
      for (FeatureIndex n = 0; n <= kNear; ++n) {
        matches[pair].points.push_back({n, n});
      }
    }
    ASSERT_THAT(EstimateRelativePoses(&scene_, matches, nullptr, {}, {}),
                IsOk());
    for (const ViewPair& pair : pairs) {
      ASSERT_EQ(scene_.relative_poses.count(pair), 1u);
    }
  }

  const std::vector<FeatureMatch>& Inliers(const ViewPair& pair) {
    return scene_.relative_poses.at(pair).point_inliers;
  }

  Scene scene_;
};

TEST_F(LoneMatchTest, IsNoTrackOfTwoViews) {
  Relate({{0, 1}});
  EXPECT_THAT(Inliers({0, 1}), Not(Contains(FeatureMatch{kNear, kNear})));
  EXPECT_EQ(scene_.point_tracks.size(), Inliers({0, 1}).size());
  EXPECT_GT(scene_.point_tracks.size(), 25u);
}

TEST_F(LoneMatchTest, StaysWhereAThirdViewBearsItOut) {
  Relate({{0, 1}, {1, 2}});
  EXPECT_THAT(Inliers({0, 1}), Contains(FeatureMatch{kNear, kNear}));
  EXPECT_THAT(Inliers({1, 2}), Contains(FeatureMatch{kNear, kNear}));
}

// The first and the last view share seven places of a cloud only, each with
// several matches side by side.
TEST(WeakPose, CountsOnlyWhereNothingElseJoinsItsViews) {
  Random random(4);
  constexpr FeatureIndex kCloud = 60, kPlaces = 7, kBeside = 9;
  std::vector<Vec3> points;
  for (FeatureIndex n = 0; n < kCloud; ++n) points.push_back(Anywhere(&random));
  for (FeatureIndex place = 0; place < kPlaces; ++place) {
    const Vec3 center = Anywhere(&random);
    for (FeatureIndex n = 0; n < kBeside; ++n) {
      const Vec2 step =
          testing::UniformVec2(random, {-0.01, -0.01}, {0.01, 0.01});
      points.push_back(center + Vec3(step.x(), step.y(), 0));
    }
  }
  Scene scene = SceneOf(
      points, {Vec3(0, 0, 0), Vec3(0.5, 0.04, 0), Vec3(1, 0.16, 0)}, 0.2);
  std::map<ViewPair, PairMatches> matches;
  for (FeatureIndex n = 0; n < kCloud; ++n) {
    matches[{0, 1}].points.push_back({n, n});
    matches[{1, 2}].points.push_back({n, n});
  }
  for (FeatureIndex n = kCloud; n < points.size(); ++n) {
    matches[{0, 2}].points.push_back({n, n});
  }
  // Wrong matches, without which seven places say enough.
  for (FeatureIndex n = 0; n < 40; ++n) {
    matches[{0, 2}].points.push_back({n, (7 * n + 13) % kCloud});
  }
  auto reports = EstimateRelativePoses(&scene, matches, nullptr, {}, {});
  ASSERT_THAT(reports, IsOk());
  EXPECT_EQ(scene.relative_poses.count({0, 1}), 1u);
  EXPECT_EQ(scene.relative_poses.count({0, 2}), 0u);
  EXPECT_FALSE(reports->at(1).accepted);
  EXPECT_THAT(reports->at(1).reason, HasSubstr("side by side"));
  // Dropped, but not compared in vain.
  EXPECT_THAT(scene.unrelated_pairs, IsEmpty());

  // Much less evidence joins them otherwise.
  matches[{1, 2}].points.resize(12);
  reports = EstimateRelativePoses(&scene, matches, nullptr, {}, {});
  ASSERT_THAT(reports, IsOk());
  EXPECT_EQ(scene.relative_poses.count({1, 2}), 1u);
  EXPECT_EQ(scene.relative_poses.count({0, 2}), 1u);

  matches.erase({1, 2});
  reports = EstimateRelativePoses(&scene, matches, nullptr, {}, {});
  ASSERT_THAT(reports, IsOk());
  EXPECT_EQ(scene.relative_poses.count({0, 2}), 1u);
}

// The first and the last view share a thing only, and nothing of what both see
// around it.
TEST(WeakPose, IsThatOfAThingWithOtherSurroundings) {
  Random random(4);
  constexpr FeatureIndex kCloud = 600, kThing = 60;
  std::vector<Vec3> points;
  for (FeatureIndex n = 0; n < kCloud; ++n) points.push_back(Anywhere(&random));
  for (FeatureIndex n = 0; n < kThing; ++n) {
    points.push_back(
        testing::UniformVec3(random, {-0.6, -0.5, 4}, {0.6, 0.5, 5}));
  }
  Scene scene = SceneOf(
      points, {Vec3(0, 0, 0), Vec3(0.5, 0.04, 0), Vec3(1, 0.16, 0)}, 0.2);
  std::map<ViewId, DetectedFeatures> detected;
  for (const auto& [view, features] : scene.features) {
    DetectedFeatures& of_view = detected[view];
    of_view.features = features;
    for (const Vec2& position_px : features.points_px) {
      of_view.keypoints.push_back({position_px, 2});
      of_view.point_descriptors.push_back(testing::RandomDescriptor(&random));
    }
  }
  std::map<ViewPair, PairMatches> matches;
  for (FeatureIndex n = 0; n < kCloud; n += 2) {
    matches[{0, 1}].points.push_back({n, n});
    matches[{1, 2}].points.push_back({n, n});
  }
  for (FeatureIndex n = kCloud; n < points.size(); ++n) {
    matches[{0, 2}].points.push_back({n, n});
  }
  auto reports = EstimateRelativePoses(&scene, matches, &detected, {}, {});
  ASSERT_THAT(reports, IsOk());
  ASSERT_EQ(scene.relative_poses.count({0, 1}), 1u);
  EXPECT_EQ(scene.relative_poses.count({0, 2}), 0u);
  EXPECT_THAT(reports->at(1).reason, HasSubstr("surrounds"));

  // Nothing else joins its views.
  const std::map<ViewPair, PairMatches> all = matches;
  matches.erase({1, 2});
  reports = EstimateRelativePoses(&scene, matches, &detected, {}, {});
  ASSERT_THAT(reports, IsOk());
  EXPECT_EQ(scene.relative_poses.count({0, 2}), 1u);

  // With a part of what surrounds it, it is a pose like any other.
  matches = all;
  for (FeatureIndex n = 0; n < kCloud; n += 2) {
    matches[{0, 2}].points.push_back({n, n});
  }
  reports = EstimateRelativePoses(&scene, matches, &detected, {}, {});
  ASSERT_THAT(reports, IsOk());
  EXPECT_EQ(scene.relative_poses.count({0, 2}), 1u);
}

// A wall of seven times five equal tiles, and points before it.
// Of two windows alike, side by side on a wall that one walks along, the one
// lies on the epipolar lines of the other.
class EqualWindowsTest : public ::testing::Test {
 protected:
  static constexpr FeatureIndex kCloud = 60, kWindow = 40;

  EqualWindowsTest() {
    Random random(5);
    std::vector<Vec3> points;
    for (FeatureIndex n = 0; n < kCloud; ++n) {
      points.push_back(Anywhere(&random));
    }
    std::vector<Vec3> window;
    for (FeatureIndex n = 0; n < kWindow; ++n) {
      window.push_back(
          testing::UniformVec3(random, {-1.2, -0.6, 6}, {-0.6, 0.6, 6}));
    }
    for (const double shift : {0.0, 1.4}) {
      for (const Vec3& point : window) {
        points.push_back(point + Vec3(shift, 0, 0));
      }
    }
    scene_ =
        SceneOf(points, {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(1.1, 0, 0)}, 0.2);
    for (FeatureIndex n = 0; n < points.size(); ++n) {
      matches_[{0, 1}].points.push_back({n, n});
      matches_[{1, 2}].points.push_back({n, n});
      if (n < kCloud) matches_[{0, 2}].points.push_back({n, n});
    }
    for (FeatureIndex n = kCloud; n < kCloud + kWindow; ++n) {
      copies_.push_back({n + kWindow, n});
      matches_[{0, 2}].points.push_back(copies_.back());
    }
  }

  // Of the pair 0-2.
  std::size_t NumCopiesAmongInliers() {
    EXPECT_THAT(EstimateRelativePoses(&scene_, matches_, nullptr, {}, {}),
                IsOk());
    const auto& inliers = scene_.relative_poses.at({0, 2}).point_inliers;
    EXPECT_GT(inliers.size(), kCloud / 2);
    return static_cast<std::size_t>(
        std::count_if(copies_.begin(), copies_.end(), [&](const auto& match) {
          return std::find(inliers.begin(), inliers.end(), match) !=
                 inliers.end();
        }));
  }

  Scene scene_;
  std::map<ViewPair, PairMatches> matches_;
  std::vector<FeatureMatch> copies_;
};

TEST_F(EqualWindowsTest, AreToldByAThirdViewAlone) {
  EXPECT_EQ(NumCopiesAmongInliers(), 0u);
  matches_.erase({0, 1});
  EXPECT_GT(NumCopiesAmongInliers(), kWindow / 2);
}

// A pair whose pose is given is not looked at.
TEST_F(EqualWindowsTest, StayInAPoseThatIsGiven) {
  RigidTransform cam2_from_cam0;
  cam2_from_cam0.rotation = RotationFromAngleAxis(Vec3(0.02, 0.1, -0.04));
  cam2_from_cam0.translation = -(cam2_from_cam0.rotation * Vec3(1.1, 0, 0));
  ASSERT_THAT(EstimateRelativePoses(&scene_, matches_, nullptr, {}, {},
                                    {{{0, 2}, cam2_from_cam0}}),
              IsOk());
  EXPECT_EQ(scene_.relative_poses.at({0, 2}).point_inliers.size(),
            kCloud + kWindow);
}

TEST(EstimateRelativePoses, SayWhatWasComparedInVain) {
  Random random(2);
  constexpr FeatureIndex kCloud = 60;
  std::vector<Vec3> points;
  for (FeatureIndex n = 0; n < kCloud; ++n) points.push_back(Anywhere(&random));
  // The last two stand in one place, and differ by a rotation.
  Scene scene = SceneOf(
      points, {Vec3(0, 0, 0), Vec3(0.5, 0.04, 0), Vec3(0.5, 0.04, 0)}, 0.2);
  scene.unrelated_pairs = {{0, 1}};
  std::map<ViewPair, PairMatches> matches;
  for (FeatureIndex n = 0; n < kCloud; ++n) {
    matches[{0, 1}].points.push_back({n, n});
    matches[{0, 2}].points.push_back({n, (7 * n + 13) % kCloud});
    matches[{1, 2}].points.push_back({n, n});
  }
  const auto reports = EstimateRelativePoses(&scene, matches, nullptr, {}, {});
  ASSERT_THAT(reports, IsOk());
  EXPECT_TRUE(reports->at(2).no_parallax);
  EXPECT_EQ(scene.relative_poses.size(), 1u);
  EXPECT_EQ(scene.unrelated_pairs, (std::vector<ViewPair>{{0, 2}}));
  // What is not compared again was compared by others, as COLMAP.
  matches.erase({0, 2});
  ASSERT_THAT(EstimateRelativePoses(&scene, matches, nullptr, {}, {}), IsOk());
  EXPECT_EQ(scene.unrelated_pairs, (std::vector<ViewPair>{{0, 2}}));
}

TEST(EstimateRelativePoses, SayWhatRepeats) {
  constexpr int kColumns = 7, kRows = 5, kMotif = 3;
  Random random(3);
  std::vector<Vec3> points;
  std::vector<PointDescriptor> descriptors;
  std::vector<Vec3> motif;
  std::vector<PointDescriptor> of_motif;
  for (int m = 0; m < kMotif; ++m) {
    motif.push_back(testing::UniformVec3(random, {0, 0, 0}, {0.4, 0.4, 0}));
    of_motif.push_back(testing::RandomDescriptor(&random));
  }
  for (int cell = 0; cell < kColumns * kRows; ++cell) {
    const Vec3 corner(0.5 * (cell % kColumns) - 1.6,
                      0.5 * static_cast<int>(cell / kColumns) - 1.2, 5);
    for (int m = 0; m < kMotif; ++m) {
      points.push_back(corner + motif[m]);
      descriptors.push_back(testing::Resembling(of_motif[m], &random));
    }
  }
  for (int n = 0; n < 60; ++n) {
    points.push_back(Anywhere(&random));
    descriptors.push_back(testing::RandomDescriptor(&random));
  }
  Scene scene = SceneOf(
      points, {Vec3(0, 0, 0), Vec3(0.5, 0.04, 0), Vec3(1, 0.16, 0)}, 0.2);
  std::map<ViewId, DetectedFeatures> detected;
  std::map<ViewPair, PairMatches> matches;
  for (auto& [view, features] : scene.features) {
    const std::vector<Vec2>& points_px = features.points_px;
    for (std::size_t n = 0; n + kMotif < points.size(); ++n) {
      features.segments.push_back({points_px[n], points_px[n + kMotif], 0.5});
    }
    DetectedFeatures& of_view = detected[view];
    of_view.features = features;
    of_view.point_descriptors = descriptors;
    of_view.line_descriptors.resize(features.segments.size());
    for (const Vec2& position_px : points_px) {
      of_view.keypoints.push_back({position_px, 2});
    }
  }
  for (FeatureIndex n = 0; n < points.size(); ++n) {
    matches[{0, 1}].points.push_back({n, n});
  }
  ASSERT_THAT(EstimateRelativePoses(&scene, matches, &detected, {}, {}),
              IsOk());
  for (const ViewId view : {0u, 1u}) {
    const ViewFeatures& features = scene.features.at(view);
    const ViewMeasurements told =
        MeasureView(features, scene.intrinsics.at(0), Vec2(1600, 1200),
                    &detected.at(view), {});
    std::vector<FeatureIndex> repeated_points, repeated_segments;
    for (FeatureIndex n = 0; n < points.size(); ++n) {
      if (told.repeats.HasPoint(n)) repeated_points.push_back(n);
    }
    for (FeatureIndex n = 0; n < features.segments.size(); ++n) {
      if (told.repeats.HasSegment(told.features.segments[n])) {
        repeated_segments.push_back(n);
      }
    }
    EXPECT_GT(repeated_points.size(), 20u);
    EXPECT_LT(repeated_points.size(), points.size());
    EXPECT_GT(repeated_segments.size(), 5u);
    EXPECT_LT(repeated_segments.size(), features.segments.size());
    EXPECT_EQ(features.repeated_points, repeated_points);
    EXPECT_EQ(features.repeated_segments, repeated_segments);
  }
  // Without what the detectors know, what is known stays.
  Scene unknown = scene;
  unknown.features[0].repeated_points = {7};
  ASSERT_THAT(EstimateRelativePoses(&unknown, matches, nullptr, {}, {}),
              IsOk());
  EXPECT_THAT(unknown.features[0].repeated_points, ::testing::ElementsAre(7));
}

}  // namespace
}  // namespace lowlap
