// The 19 photographs of castle-P19 in parts, on the measurements that come with
// the sources.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/merge/merge_models.h"
#include "merge/parts.h"
#include "support/data_folder.h"
#include "support/matchers.h"
#include "third_party_adapters/scene_formats.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class CastleMerge : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string sample = SourceFolder() + "/sfm_data/samples/castle-p19";
    measured_ = *ReadScene(sample + "/scene.lowlap");
    truth_ = *GroundTruthByName(
        measured_, *strecha::ReadGroundTruth(sample + "/gt_dense_cameras"));
    Scene solved = measured_;
    ASSERT_THAT(SolveScene(&solved, SolveOptions(), RunContext(), nullptr),
                testing::IsOk());
    solution_ = GroundTruthFromScene(solved);
    ASSERT_THAT(solution_, SizeIs(19));
  }

  static Result<SolveResult> Merge(const std::vector<PartialModel>& models,
                                   Scene* scene) {
    std::vector<ModelCheck> checks;
    for (const PartialModel& model : models) {
      auto check = CheckModel(*scene, model, SolveOptions(), RunContext());
      if (!check) return tl::unexpected<Error>(check.error());
      checks.push_back(std::move(*check));
    }
    return MergeModels(scene, models, checks, SolveOptions(), RunContext(),
                       nullptr);
  }

  static void ExpectAllWithin(const Scene& scene, double mean_m) {
    const PoseEvaluation evaluation = EvaluatePoses(scene, truth_);
    EXPECT_EQ(evaluation.num_solved, 19);
    EXPECT_LE(evaluation.position.mean, mean_m);
  }

  static Scene measured_;
  static GroundTruth truth_;
  static std::map<ViewId, Pose> solution_;
};

Scene CastleMerge::measured_;
GroundTruth CastleMerge::truth_;
std::map<ViewId, Pose> CastleMerge::solution_;

PartialModel ScaledAndTurned(PartialModel part) {
  Similarity frame;
  frame.scale = 0.37;
  frame.rotation = RotationFromAngleAxis(Vec3(0.9, -1.7, 0.2));
  frame.translation = Vec3(7, -1, 3);
  part.poses = Moved(std::move(part.poses), frame);
  return part;
}

TEST_F(CastleMerge, TwoPartsAndTwoViewsBecomeOne) {
  Scene scene = measured_;
  const auto merged = Merge({PartOf(solution_, Range(0, 8)),
                             ScaledAndTurned(PartOf(solution_, Range(10, 17)))},
                            &scene);
  ASSERT_THAT(merged, testing::IsOk());
  ExpectAllWithin(scene, 0.03);
}

// Only views that nobody placed see anything of both parts.
TEST_F(CastleMerge, SoDoPartsWithoutACommonTrack) {
  Scene scene = measured_;
  const auto in_first = [](ViewId view) { return view <= 8; };
  const auto in_second = [](ViewId view) { return view >= 10 && view <= 17; };
  for (auto pair = scene.relative_poses.begin();
       pair != scene.relative_poses.end();) {
    const bool across =
        in_first(pair->first.first) && in_second(pair->first.second);
    pair = across ? scene.relative_poses.erase(pair) : std::next(pair);
  }
  const auto cut = [&](auto* tracks) {
    for (auto entry = tracks->begin(); entry != tracks->end();) {
      Track& track = entry->second;
      if (std::any_of(track.begin(), track.end(), [&](const FeatureRef& ref) {
            return in_first(ref.view);
          })) {
        track.erase(std::remove_if(track.begin(), track.end(),
                                   [&](const FeatureRef& ref) {
                                     return in_second(ref.view);
                                   }),
                    track.end());
      }
      const bool is_track =
          !track.empty() && track.front().view != track.back().view;
      entry = is_track ? std::next(entry) : tracks->erase(entry);
    }
  };
  cut(&scene.point_tracks);
  cut(&scene.line_tracks);
  const auto merged = Merge({PartOf(solution_, Range(0, 8)),
                             ScaledAndTurned(PartOf(solution_, Range(10, 17)))},
                            &scene);
  ASSERT_THAT(merged, testing::IsOk());
  ExpectAllWithin(scene, 0.03);
}

TEST_F(CastleMerge, APartThatIsTurnedInsideIsNamed) {
  const PartialModel model =
      Glued(PartOf(solution_, Range(0, 8)), 5, 1,
            RotationFromAngleAxis(RadFromDeg(20) * Vec3::UnitY()));
  const auto check = CheckModel(measured_, model, SolveOptions(), RunContext());
  ASSERT_THAT(check, testing::IsOk());
  EXPECT_THAT(check->pieces, SizeIs(2));
  EXPECT_THAT(DescribeCheck(model, *check, measured_),
              Contains(HasSubstr("by 20.0 degrees of rotation")));
}

// Far baselines across the camera agree in direction and, to a tenth, in ratio.
TEST_F(CastleMerge, APartOfAnotherScaleStaysWhole) {
  const PartialModel model =
      Glued(PartOf(solution_, Range(0, 11)), 6, 1.5, Mat3::Identity());
  const auto check = CheckModel(measured_, model, SolveOptions(), RunContext());
  ASSERT_THAT(check, testing::IsOk());
  ASSERT_THAT(check->pieces, SizeIs(2));
  EXPECT_THAT(check->pieces[0].views, ElementsAreArray(Range(5, 11)));
  EXPECT_THAT(check->pieces[1].views, ElementsAreArray(Range(0, 5)));
}

// OpenMVG's result without three of the photographs: two parts that share one
// camera, one of them at an arbitrary scale there, and no warning.
TEST_F(CastleMerge, WhatOpenMvgGluedIsTakenApart) {
  if (DataFolder().empty()) GTEST_SKIP() << "skipped: no data";
  const auto glued = ReadScene(
      DataFolder() + "/openmvg/castle-P19_without_3_9_14/global_poses.json");
  ASSERT_THAT(glued, testing::IsOk());
  Scene scene = WithoutViews(measured_, {3, 9, 14});
  const auto model = MatchModel(scene, *glued, "OpenMVG", {});
  ASSERT_THAT(model, testing::IsOk());
  const auto check = CheckModel(scene, *model, SolveOptions(), RunContext());
  ASSERT_THAT(check, testing::IsOk());
  ASSERT_THAT(check->pieces, SizeIs(2));
  EXPECT_THAT(check->pieces[1].views, ElementsAre(10, 11, 12));
  EXPECT_THAT(DescribeCheck(*model, *check, scene),
              Contains(AllOf(HasSubstr("pieces 1 and 2, which meet in"),
                             HasSubstr("times too"))));
  const auto merged = MergeModels(&scene, {*model}, {*check}, SolveOptions(),
                                  RunContext(), nullptr);
  ASSERT_THAT(merged, testing::IsOk());
  const PoseEvaluation evaluation = EvaluatePoses(scene, truth_);
  EXPECT_EQ(evaluation.num_solved, 16);
  EXPECT_LE(evaluation.position.mean, 0.04);
}

}  // namespace
}  // namespace lowlap
