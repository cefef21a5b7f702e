#include "lowlap/matching/internal/tracks.h"

#include <gmock/gmock.h>

#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::IsError;
using ::testing::Pair;

RelativePose Points(ViewId first, ViewId second,
                    std::vector<FeatureMatch> matches, double nfa = -50) {
  RelativePose pose;
  pose.views = {first, second};
  pose.point_inliers = std::move(matches);
  pose.log10_nfa = nfa;
  return pose;
}

Scene SceneOf(const std::vector<RelativePose>& poses) {
  Scene scene;
  for (const RelativePose& pose : poses) {
    scene.relative_poses[pose.views] = pose;
  }
  return scene;
}

TEST(BuildPointTracksTest, ChainsMatchesOverViewsInOrder) {
  const auto tracks = BuildPointTracks(SceneOf(
      {Points(0, 1, {{5, 2}, {1, 9}}), Points(1, 2, {{2, 7}, {4, 4}})}));
  EXPECT_THAT(
      tracks,
      ElementsAre(Pair(0, ElementsAre(FeatureRef{0, 1}, FeatureRef{1, 9})),
                  Pair(1, ElementsAre(FeatureRef{0, 5}, FeatureRef{1, 2},
                                      FeatureRef{2, 7})),
                  Pair(2, ElementsAre(FeatureRef{1, 4}, FeatureRef{2, 4}))));
}

TEST(BuildPointTracksTest, NoPosesNoTracks) {
  EXPECT_THAT(BuildPointTracks(Scene{}), IsEmpty());
  EXPECT_THAT(BuildPointTracks(SceneOf({Points(0, 1, {})})), IsEmpty());
}

TEST(BuildPointTracksTest, AWrongMatchCostsItselfNotTheTracksItTies) {
  // Tracks A (features 1) and B (features 2) over views 0, 1, 2, confirmed by
  // triangles; 1 -> 2 in the most meaningful pair (2, 3) is wrong.
  const auto tracks = BuildPointTracks(
      SceneOf({Points(0, 1, {{1, 1}, {2, 2}}), Points(1, 2, {{1, 1}, {2, 2}}),
               Points(0, 2, {{1, 1}, {2, 2}}), Points(2, 3, {{1, 1}}, -900),
               Points(1, 3, {{2, 1}}, -10)}));
  EXPECT_THAT(
      tracks,
      ElementsAre(Pair(0, ElementsAre(FeatureRef{0, 1}, FeatureRef{1, 1},
                                      FeatureRef{2, 1}, FeatureRef{3, 1})),
                  Pair(1, ElementsAre(FeatureRef{0, 2}, FeatureRef{1, 2},
                                      FeatureRef{2, 2}))));
}

TEST(BuildPointTracksTest, TrianglesGoBeforeMeaningfulness) {
  // (0,1), (1,2), (0,2) agree on feature 0; (0,3) and (1,3) end in different
  // features of view 0 and 1 and disagree with the very meaningful (2,3).
  const auto tracks = BuildPointTracks(
      SceneOf({Points(0, 1, {{0, 0}}, -5), Points(1, 2, {{0, 0}}, -5),
               Points(0, 2, {{0, 0}}, -5), Points(0, 3, {{8, 3}}, -400),
               Points(2, 3, {{0, 3}}, -500)}));
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_THAT(tracks.at(0), ElementsAre(FeatureRef{0, 0}, FeatureRef{1, 0},
                                        FeatureRef{2, 0}, FeatureRef{3, 3}));
}

TEST(BuildPointTracksTest, NoTrackHasTwoFeaturesOfAView) {
  std::vector<RelativePose> poses;
  for (std::uint32_t a = 0; a < 5; ++a) {
    for (std::uint32_t b = a + 1; b < 5; ++b) {
      std::vector<FeatureMatch> matches;
      for (FeatureIndex i = 0; i < 40; ++i) {
        // A third of the matches is shifted: everything hangs together.
        matches.push_back({i, (i + a + b) % 3 == 0 ? (i + 1) % 40 : i});
      }
      poses.push_back(Points(a, b, matches, -static_cast<double>(a + b)));
    }
  }
  const auto tracks = BuildPointTracks(SceneOf(poses));
  EXPECT_GE(tracks.size(), 40u);
  std::size_t observations = 0;
  for (const auto& [id, track] : tracks) {
    for (std::size_t i = 1; i < track.size(); ++i) {
      EXPECT_LT(track[i - 1].view, track[i].view);
    }
    observations += track.size();
  }
  EXPECT_LE(observations, 200u);
  EXPECT_GE(observations, 180u);
}

LineSegment Segment(double x0, double y0, double x1, double y1) {
  LineSegment segment;
  segment.start_px = Vec2(x0, y0);
  segment.end_px = Vec2(x1, y1);
  return segment;
}

Scene LineScene(const LineSegment& second_piece) {
  Scene scene;
  scene.features[0].segments = {Segment(0, 0, 100, 0)};
  scene.features[1].segments = {Segment(0, 10, 40, 10), second_piece};
  scene.features[2].segments = {Segment(0, 20, 100, 20)};
  const auto lines = [](ViewId a, ViewId b, std::vector<FeatureMatch> matches) {
    RelativePose pose;
    pose.views = {a, b};
    pose.line_inliers = std::move(matches);
    return pose;
  };
  scene.relative_poses[{0, 1}] = lines(0, 1, {{0, 0}});
  scene.relative_poses[{1, 2}] = lines(1, 2, {{1, 0}});
  scene.relative_poses[{0, 2}] = lines(0, 2, {{0, 0}});
  return scene;
}

TEST(BuildLineTracksTest, CollinearPiecesOfOneViewShareATrack) {
  const auto tracks = BuildLineTracks(LineScene(Segment(60, 11, 100, 9.5)), {});
  EXPECT_THAT(tracks, ElementsAre(Pair(
                          0, ElementsAre(FeatureRef{0, 0}, FeatureRef{1, 0},
                                         FeatureRef{1, 1}, FeatureRef{2, 0}))));
}

TEST(BuildLineTracksTest, PiecesOfSeveralViewsShareATrack) {
  Scene scene = LineScene(Segment(60, 10, 100, 10));
  scene.features[0].segments = {Segment(0, 0, 50, 0), Segment(55, 0, 100, 0)};
  scene.relative_poses[{0, 1}].line_inliers = {{0, 0}, {1, 1}};
  scene.relative_poses[{1, 2}].line_inliers = {{0, 0}, {1, 0}};
  scene.relative_poses.erase({0, 2});
  EXPECT_THAT(
      BuildLineTracks(scene, {}),
      ElementsAre(Pair(
          0, ElementsAre(FeatureRef{0, 0}, FeatureRef{0, 1}, FeatureRef{1, 0},
                         FeatureRef{1, 1}, FeatureRef{2, 0}))));
}

TEST(BuildLineTracksTest, OtherSegmentsOfOneViewDoNot) {
  const auto tracks = BuildLineTracks(LineScene(Segment(60, 30, 100, 30)), {});
  std::size_t in_view_1 = 0;
  for (const FeatureRef& ref : tracks.at(0)) in_view_1 += ref.view == 1;
  EXPECT_EQ(in_view_1, 1u);
}

TEST(BuildLineTracksTest, TheToleranceCounts) {
  const Scene scene = LineScene(Segment(60, 15, 100, 19));
  EXPECT_EQ(BuildLineTracks(scene, {}).at(0).size(), 3u);
  LineTrackOptions options;
  options.max_collinear_distance_px = 6;
  EXPECT_EQ(BuildLineTracks(scene, options).at(0).size(), 4u);
}

TEST(BuildLineTracksTest, PiecesOfABentEdgeShareATrackIfTheLensIsKnown) {
  Intrinsic lens;
  lens.model = CameraModel::kRadialK1;
  lens.distortion = {-0.2};
  lens.fx_px = lens.fy_px = 100;
  const auto bent = [&](double x0, double x1) {
    // Of the straight edge y = 0.6.
    return LineSegment{lens.Project({x0, 0.6, 1}), lens.Project({x1, 0.6, 1}),
                       0.5};
  };
  Scene scene = LineScene(bent(0.2, 0.9));
  scene.features.at(1).segments[0] = bent(-0.9, 0);
  EXPECT_EQ(BuildLineTracks(scene, {}).at(0).size(), 3u);
  scene.intrinsics[5] = lens;
  scene.views[1].intrinsic_id = 5;
  EXPECT_EQ(BuildLineTracks(scene, {}).at(0).size(), 4u);
}

TEST(BuildLineTracksTest, UnknownSegmentsNeverShareATrack) {
  Scene scene = LineScene(Segment(60, 10, 100, 10));
  scene.features.clear();
  for (const auto& [id, track] : BuildLineTracks(scene, {})) {
    for (std::size_t i = 1; i < track.size(); ++i) {
      EXPECT_NE(track[i - 1].view, track[i].view);
    }
  }
}

TEST(LineTrackOptionsTest, RejectsNegativeTolerance) {
  LineTrackOptions options;
  options.max_collinear_distance_px = -1;
  EXPECT_THAT(options.Validate(), IsError(ErrorCode::kInvalidArgument,
                                          "max_collinear_distance_px"));
}

}  // namespace
}  // namespace lowlap
