#include "lowlap/averaging/internal/track_rays.h"

#include <gtest/gtest.h>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

// Six views at random places, and points that all of them see.
class TrackRaysTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Random random(1);
    Intrinsic intrinsic;
    intrinsic.width_px = 1000;
    intrinsic.height_px = 800;
    intrinsic.fx_px = 900;
    intrinsic.fy_px = 905;
    intrinsic.principal_point_px = {480, 410};
    scene_.intrinsics[0] = intrinsic;
    for (ViewId id = 0; id < 6; ++id) {
      View view;
      view.intrinsic_id = 0;
      scene_.views[id] = view;
      views_.push_back(id);
      rotations_.push_back(RotationFromAngleAxis(RandomVector(&random, 0.2)));
      centers_.push_back(RandomVector(&random, 1));
    }
    for (int k = 0; k < 30; ++k) {
      points_.push_back(RandomVector(&random, 2) + Vec3(0, 0, 9));
      Track track;
      for (std::uint32_t id = 0; id < 6; ++id) {
        auto& pixels = scene_.features[id].points_px;
        track.push_back({id, static_cast<FeatureIndex>(pixels.size())});
        pixels.push_back(intrinsic.Project(rotations_[id] *
                                           (points_.back() - centers_[id])));
      }
      scene_.point_tracks[static_cast<PointTrackId>(k)] = track;
    }
  }

  Scene scene_;
  std::vector<ViewId> views_;
  std::vector<Mat3> rotations_;
  std::vector<Vec3> centers_, points_;
};

TEST(TracksOfViews, AreThoseThatEnoughViewsObserve) {
  std::vector<TrackRays> tracks(3);
  tracks[0].observations = {{2}, {0}};
  tracks[1].observations = {{0}, {2}, {3}};
  tracks[2].observations = {{3}};
  using Views = std::vector<std::vector<std::size_t>>;
  EXPECT_EQ(TracksOfViews(tracks, 4), (Views{{0, 1}, {}, {0, 1}, {1, 2}}));
  EXPECT_EQ(TracksOfViews(tracks, 4, 3), (Views{{1}, {}, {1}, {1}}));
}

TEST_F(TrackRaysTest, RaysPointFromTheCentresToThePoints) {
  const auto tracks = MakeTrackRays(scene_, views_, rotations_);
  ASSERT_EQ(tracks.size(), 30u);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    ASSERT_EQ(tracks[k].observations.size(), 6u);
    for (const RayObservation& seen : tracks[k].observations) {
      EXPECT_LT(
          (seen.ray_in_world - (points_[k] - centers_[seen.view]).normalized())
              .norm(),
          1e-9);
    }
  }
}

TEST_F(TrackRaysTest, OtherViewsAndThoseWithoutIntrinsicsAreLeftOut) {
  scene_.views[5].intrinsic_id = kInvalidId;
  const auto tracks = MakeTrackRays(
      scene_, {1, 3, 5}, {rotations_[1], rotations_[3], rotations_[5]});
  ASSERT_EQ(tracks.size(), 30u);
  for (const TrackRays& track : tracks) {
    ASSERT_EQ(track.observations.size(), 2u);
    EXPECT_EQ(track.observations[0].view, 0u);
    EXPECT_EQ(track.observations[1].view, 1u);
  }
  EXPECT_TRUE(
      MakeTrackRays(scene_, {1, 5}, {rotations_[1], rotations_[5]}).empty());
}

TEST_F(TrackRaysTest, LongTracksComeFirstUpToTheBoundPerView) {
  for (auto& [id, track] : scene_.point_tracks) {
    if (id.value() % 2 == 0) track.resize(2);  // views 0 and 1 alone
  }
  const auto tracks = MakeTrackRays(scene_, views_, rotations_, {}, 10);
  EXPECT_EQ(tracks.size(), 10u);
  for (const TrackRays& track : tracks) {
    EXPECT_EQ(track.observations.size(), 6u);
  }
}

TEST_F(TrackRaysTest, MatchesJoinTracksAndContradictoryOnesAreLeftOut) {
  for (std::uint32_t id = 0; id + 1 < 6; ++id) {
    RelativePose& pose = scene_.relative_poses[{id, id + 1}];
    for (FeatureIndex k = 0; k < 30; ++k) pose.point_inliers.push_back({k, k});
  }
  EXPECT_EQ(MakeTrackRays(scene_, views_, rotations_).size(), 30u);
  // A wrong match ties two tracks together: each view sees both points.
  scene_.relative_poses[{1, 4}].point_inliers = {{7, 8}};
  EXPECT_EQ(MakeTrackRays(scene_, views_, rotations_).size(), 28u);
  const std::vector<ViewPair> excluded = {{1, 4}};
  EXPECT_EQ(MakeTrackRays(scene_, views_, rotations_, excluded).size(), 30u);
  // Through view 2 alone.
  const auto cut = MakeTrackRays(scene_, views_, rotations_, {{1, 4}, {2, 3}});
  EXPECT_EQ(cut.size(), 60u);
  for (const TrackRays& track : cut) {
    EXPECT_EQ(track.observations.size(), 3u);
  }
  // Two points of one view that are almost one.
  auto& points_px = scene_.features[4].points_px;
  points_px.push_back(points_px[9] + Vec2(3, 0));
  scene_.relative_poses[{1, 4}].point_inliers = {{9, 30}};
  EXPECT_EQ(MakeTrackRays(scene_, views_, rotations_).size(), 30u);
}

TEST_F(TrackRaysTest, OnlyTheProblemThatAsksForTracksHasThem) {
  std::map<ViewId, Mat3> rotation_of;
  for (const ViewId view : views_) rotation_of[view] = rotations_[view.value()];
  EXPECT_TRUE(MakeTranslationProblem(scene_, rotation_of, {}).tracks.empty());
  const TranslationProblem problem =
      MakeTranslationProblem(scene_, rotation_of, {}, {}, /*with_tracks=*/true);
  EXPECT_EQ(problem.tracks.size(), 30u);
  EXPECT_TRUE(ValidateProblem(problem));
}

}  // namespace
}  // namespace lowlap
