// From matches of pieces to landmarks: a segment that some view breaks is one
// track, one landmark, and moves the cameras no more than a whole one.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/tracks.h"
#include "lowlap/scene/validation.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;
using testing::IsOk;

// The line tracks become matches of all pairs of their views, under the true
// relative poses.
void MatchTracks(Scene* scene) {
  for (const auto& [id, track] : scene->line_tracks) {
    for (std::size_t a = 0; a < track.size(); ++a) {
      for (std::size_t b = a + 1; b < track.size(); ++b) {
        const ViewPair views{track[a].view, track[b].view};
        RelativePose& pose = scene->relative_poses[views];
        if (pose.views != views) {
          const auto cam_of = [&](ViewId view) {
            return scene->poses.at(scene->views.at(view).pose_id)
                .CamFromWorld();
          };
          const RigidTransform second_from_first =
              cam_of(views.second) * cam_of(views.first).Inverse();
          pose.views = views;
          pose.rotation = second_from_first.rotation;
          pose.direction = second_from_first.translation.normalized();
        }
        pose.line_inliers.push_back({track[a].feature, track[b].feature});
      }
    }
  }
  scene->line_tracks.clear();
}

// The support line of a piece rests on less than half of the edge's pixels, so
// it is this much less sure; noise_px is what is added to its ends.
constexpr double kPieceStddev = 1.5;

// Cuts every second segment of a view in two with a gap of a tenth, and
// matches both pieces with what the whole one was matched with.
std::size_t BreakSegments(ViewId view, Scene* scene, double noise_px = 0) {
  Random random(view.value());
  std::vector<LineSegment>& segments = scene->features.at(view).segments;
  const std::size_t count = segments.size();
  std::map<FeatureIndex, FeatureIndex> second_of;
  for (FeatureIndex n = 0; n < count; n += 2) {
    LineSegment second = segments[n];
    const Vec2 run = second.end_px - second.start_px;
    second.start_px += 0.55 * run;
    segments[n].end_px -= 0.55 * run;
    for (LineSegment* piece : {&segments[n], &second}) {
      piece->stddev_px *= kPieceStddev;
      for (Vec2* end_px : {&piece->start_px, &piece->end_px}) {
        const double u = random.Gaussian(noise_px);
        *end_px += Vec2(u, random.Gaussian(noise_px));
      }
    }
    second_of[n] = static_cast<FeatureIndex>(segments.size());
    segments.push_back(second);
  }
  for (auto& [views, pose] : scene->relative_poses) {
    const std::vector<FeatureMatch> whole = pose.line_inliers;
    for (const FeatureMatch& match : whole) {
      const auto first = second_of.find(match.first);
      const auto second = second_of.find(match.second);
      if (views.first == view && first != second_of.end()) {
        pose.line_inliers.push_back({first->second, match.second});
      }
      if (views.second == view && second != second_of.end()) {
        pose.line_inliers.push_back({match.first, second->second});
      }
    }
  }
  return second_of.size();
}

TestScene Lines(double noise_px, std::uint64_t seed = 1) {
  TestSceneOptions options;
  options.num_points = 60;
  options.num_lines = 100;
  options.noise_px = noise_px;
  options.seed = seed;
  TestScene test = MakeTestScene(options);
  test.scene.relative_poses.clear();
  test.scene.scale_ratios.clear();
  MatchTracks(&test.scene);
  return test;
}

struct Built {
  StructureSummary structure;
  AdjustmentSummary adjustment;
};

Built BuildTracksAndAdjust(Scene* scene) {
  scene->line_tracks = BuildLineTracks(*scene, {});
  const auto structure = BuildStructure(scene, {}, {});
  EXPECT_THAT(structure, IsOk());
  const auto adjustment = AdjustScene(scene, {}, {});
  EXPECT_THAT(adjustment, IsOk());
  EXPECT_THAT(ValidateScene(*scene), IsOk());
  return {structure.value_or(StructureSummary{}),
          adjustment.value_or(AdjustmentSummary{})};
}

TEST(BrokenSegmentsTest, AreOneTrackAndOneLandmarkEach) {
  TestScene test = Lines(0);
  Scene whole = test.scene;
  Scene broken = test.scene;
  const ViewId view = std::next(whole.views.begin(), 2)->first;
  ASSERT_GT(BreakSegments(view, &broken), 20u);
  const Built of_whole = BuildTracksAndAdjust(&whole);
  const Built of_broken = BuildTracksAndAdjust(&broken);
  ASSERT_EQ(broken.line_tracks.size(), whole.line_tracks.size());
  EXPECT_EQ(of_broken.structure.lines.landmarks,
            of_whole.structure.lines.landmarks);
  EXPECT_EQ(of_broken.adjustment.lines.landmarks,
            of_whole.adjustment.lines.landmarks);
  EXPECT_EQ(of_broken.adjustment.lines.observations_dropped, 0u);
  std::size_t with_pieces = 0;
  std::set<FeatureRef> seen;
  for (const auto& entry : broken.line_structure) {
    const LineLandmark& line = entry.second;
    std::set<ViewId> views;
    for (const FeatureRef& ref : line.observations) {
      views.insert(ref.view);
      EXPECT_TRUE(seen.insert(ref).second) << "a segment of two landmarks";
    }
    with_pieces += views.size() < line.observations.size();
    const auto same = std::find_if(
        whole.line_structure.begin(), whole.line_structure.end(),
        [&](const auto& other) {
          return other.second.observations.front() == line.observations.front();
        });
    ASSERT_NE(same, whole.line_structure.end());
    // Which end is called the start is free.
    const LineLandmark& other = same->second;
    const bool turned =
        (line.start - other.start).norm() > (line.start - other.end).norm();
    EXPECT_LT((line.start - (turned ? other.end : other.start)).norm(), 1e-5);
    EXPECT_LT((line.end - (turned ? other.start : other.end)).norm(), 1e-5);
  }
  EXPECT_GT(with_pieces, 20u);
}

TEST(BrokenSegmentsTest, MoveTheCamerasNoMoreThanWholeOnes) {
  constexpr double kNoisePx = 0.5;
  double error_of_whole = 0, error_of_broken = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    TestScene test = Lines(kNoisePx, seed);
    test::PerturbPoses(0.01, 0.05, seed, &test.scene);
    Scene whole = test.scene;
    Scene broken = test.scene;
    for (const auto& [view, image] : test.scene.views) {
      BreakSegments(view, &broken, 1.2 * kNoisePx);
    }
    BuildTracksAndAdjust(&whole);
    const Built adjusted = BuildTracksAndAdjust(&broken);
    error_of_whole += ComparePoses(test.true_poses, whole).mean_center;
    error_of_broken += ComparePoses(test.true_poses, broken).mean_center;
    EXPECT_TRUE(adjusted.adjustment.converged);
  }
  EXPECT_LT(error_of_broken, 1.25 * error_of_whole);
}

TEST(BrokenSegmentsTest, TwoPiecesInOneViewAreNotTwoViews) {
  TestScene test = Lines(0);
  Scene scene = test.scene;
  const ViewId view = scene.views.begin()->first;
  BreakSegments(view, &scene);
  scene.line_tracks = BuildLineTracks(scene, {});
  // Of a track with pieces, the view of the pieces and one without a pose.
  const auto broken =
      std::find_if(scene.line_tracks.begin(), scene.line_tracks.end(),
                   [](const auto& entry) {
                     const Track& track = entry.second;
                     return track.size() > 2 && track[0].view == track[1].view;
                   });
  ASSERT_NE(broken, scene.line_tracks.end());
  Track track = broken->second;
  track.resize(3);
  ASSERT_NE(track[2].view, view);
  scene.line_tracks = {{0, track}};
  scene.poses.erase(scene.views.at(track[2].view).pose_id);
  const auto summary = BuildStructure(&scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->lines.too_few_views, 1u);
  EXPECT_TRUE(scene.line_structure.empty());
}

}  // namespace
}  // namespace lowlap
