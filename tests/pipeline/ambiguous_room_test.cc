// A door of a room fills two of its photographs: two motions explain them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/pipeline/solve_scene.h"
#include "support/data_folder.h"
#include "support/matchers.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

using testing::IsOk;

TEST(AmbiguousRoom, ItDoesNotMatterWhichMotionOfTheDoorComesFirst) {
  IntrinsicSource source;
  source.calibration =
      *strecha::ReadCalibrationMatrix(RoomFolder() + "/images/K.txt");
  auto scene = SceneFromImages(RoomFolder() + "/images", source, {});
  ASSERT_THAT(scene, IsOk());
  MeasurementOptions options;
  options.pairs = "cycle";
  StageLog stages;
  ASSERT_THAT(MeasureImages(&*scene, options, RunContext(), &stages), IsOk());
  RelativePose& pose = scene->relative_poses.at({1, 2});
  ASSERT_EQ(pose.alternatives.size(), 1u);

  const auto poses = strecha::ReadGroundTruth(RoomFolder());
  ASSERT_THAT(poses, IsOk());
  const auto truth = GroundTruthByName(*scene, *poses);
  ASSERT_THAT(truth, IsOk());
  for (const bool swapped : {false, true}) {
    if (swapped) {
      AlternativeMotion& other = pose.alternatives.front();
      std::swap(pose.rotation, other.rotation);
      std::swap(pose.direction, other.direction);
      std::swap(pose.log10_nfa, other.log10_nfa);
      std::swap(pose.covariance, other.covariance);
    }
    Scene solved = *scene;
    const auto result =
        SolveScene(&solved, SolveOptions(), RunContext(), &stages);
    ASSERT_THAT(result, IsOk());
    ASSERT_EQ(result->motions.size(), 1u);
    EXPECT_EQ(result->motions.front().grounds, HypothesisGrounds::kStructure);
    EXPECT_EQ(result->motions.front().replaced, swapped);
    EXPECT_EQ(result->poses.num_placed, 11);
    EXPECT_LT(EvaluatePoses(solved, *truth).position.mean, 0.008) << swapped;
  }
}

}  // namespace
}  // namespace lowlap
