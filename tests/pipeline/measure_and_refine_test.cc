#include "lowlap/pipeline/internal/measure/measure_and_refine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/pipeline/image_collection.h"
#include "support/data_folder.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

// Photographs of the room with a focal length that is 15 % off.
Scene RoomWithWrongFocalLength() {
  IntrinsicSource source;
  source.focal_px = 850;
  return *SceneFromImages(RoomFolder() + "/images", source, {});
}

MeasurementOptions ChainOfPhotographs() {
  MeasurementOptions options;
  options.pairs = "chain";
  options.features.tilts.max_tilt = 1;
  options.cache_folder = ::testing::TempDir() + "/measure_and_refine_cache";
  return options;
}

TEST(MeasureAndRefine, MeasuresWithTheIntrinsicsThatASolutionPrefers) {
  const Scene given = RoomWithWrongFocalLength();
  Scene refined = given;
  IntrinsicRefinement focal;
  focal.focal = true;
  ASSERT_THAT(MeasureAndRefine(&refined, ChainOfPhotographs(),
                               {SolveOptions(), focal}, {}, nullptr),
              IsOk());
  EXPECT_TRUE(refined.given_intrinsics.empty());
  EXPECT_NE(refined.intrinsics, given.intrinsics);

  Scene measured = given;
  measured.intrinsics = refined.intrinsics;
  ASSERT_THAT(MeasureImages(&measured, ChainOfPhotographs(), {}, nullptr),
              IsOk());
  EXPECT_EQ(refined.relative_poses, measured.relative_poses);
}

TEST(MeasureAndRefine, HoldsIntrinsicsThatAreNotToBeRefined) {
  const Scene given = RoomWithWrongFocalLength();
  Scene held = given, measured = given;
  const auto report =
      MeasureAndRefine(&held, ChainOfPhotographs(), {}, {}, nullptr);
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->pairs.size(), given.views.size() - 1);
  for (const PairReport& pair : report->pairs) {
    const RelativePose& pose = held.relative_poses.at(pair.views);
    EXPECT_EQ(pair.num_point_inliers,
              static_cast<int>(pose.point_inliers.size()));
    EXPECT_EQ(pair.num_line_inliers,
              static_cast<int>(pose.line_inliers.size()));
  }
  ASSERT_THAT(MeasureImages(&measured, ChainOfPhotographs(), {}, nullptr),
              IsOk());
  EXPECT_TRUE(held == measured);
}

TEST(MeasureAndRefine, SaysWhyNothingIsRelated) {
  Scene scene = RoomWithWrongFocalLength();
  MeasurementOptions options = ChainOfPhotographs();
  options.matching.match_points = options.matching.match_lines = false;
  EXPECT_THAT(MeasureAndRefine(&scene, options, {}, {}, nullptr),
              IsError(ErrorCode::kInsufficientData, "no pair of views"));
}

}  // namespace
}  // namespace lowlap
