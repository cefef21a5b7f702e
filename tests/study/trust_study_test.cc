#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/study/internal/trust/position_errors.h"
#include "lowlap/study/internal/trust/spoil.h"
#include "lowlap/study/internal/trust/study.h"
#include "lowlap/study/internal/trust/summary.h"
#include "lowlap/study/internal/trust/table.h"
#include "read_csv.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SyntheticOptions SmallRoom() {
  SyntheticOptions options;
  options.num_views = 7;
  options.pairs = "window:2";
  options.points_per_wall = 20;
  options.lines_per_wall = 20;
  options.noise_px = 0.5;
  return options;
}

// The truth in another frame and unit.
Scene Moved(const SyntheticScene& synthetic) {
  Scene scene = TrueSolution(synthetic);
  const Mat3 turn = RotationFromAngleAxis({0.3, -1, 0.5});
  for (auto& entry : scene.poses) {
    Pose& pose = entry.second;
    pose.rotation = pose.rotation * turn;
    pose.center = turn.transpose() * (0.3 * pose.center + Vec3(4, 5, 6));
  }
  return scene;
}

TEST(RobustPositionErrors, TheGaugeIsNoErrorAndFalseCamerasMoveNoOther) {
  const SyntheticScene synthetic = *Simulate(SmallRoom());
  Scene scene = Moved(synthetic);
  for (const auto& [view, error] :
       RobustPositionErrors(scene, synthetic.true_poses, 0.2).error) {
    EXPECT_LT(error, 1e-9) << view;
  }
  // Most of them, and each elsewhere.
  const std::set<ViewId> wrong = {0, 2, 3, 6};
  double away = 10;
  for (const ViewId view : wrong) {
    Pose& pose = scene.poses.at(scene.views.at(view).pose_id);
    pose.center += away * Vec3(1, away / 7, -1);
    pose.rotation = RotationFromAngleAxis({0, away, 0}) * pose.rotation;
    away *= 1.7;
  }
  const PositionErrors errors =
      RobustPositionErrors(scene, synthetic.true_poses, 0.2);
  EXPECT_GT(errors.unit, 0);
  for (const auto& [view, error] : errors.error) {
    if (wrong.count(view) > 0) {
      EXPECT_GT(error, 0.2) << view;
    } else {
      EXPECT_LT(error, 1e-9) << view;
    }
  }
}

TEST(RobustPositionErrors, HundredsOfCamerasAreAlignedByAFew) {
  GroundTruth truth;
  Scene scene;
  for (std::uint32_t view = 0; view < 400; ++view) {
    Pose& pose = truth[view];
    pose.center = {0.1 * view, std::sin(0.3 * view), std::cos(0.2 * view)};
    scene.views[view].pose_id = view;
    scene.poses[view] = pose;
    if (view % 3 == 1) scene.poses[view].center.z() += 50;
  }
  for (const auto& [view, error] :
       RobustPositionErrors(scene, truth, 0.05).error) {
    if (view.value() % 3 == 1) {
      EXPECT_GT(error, 0.05) << view;
    } else {
      EXPECT_LT(error, 1e-9) << view;
    }
  }
}

// Of cameras along a line, of which some were moved across it.
std::map<ViewId, double> ErrorsAlongALine(
    std::uint32_t num_views, const std::function<bool(std::uint32_t)>& is_moved,
    double across, double wrong) {
  GroundTruth truth;
  Scene scene;
  for (std::uint32_t view = 0; view < num_views; ++view) {
    Pose& pose = truth[view];
    pose.center = {1.0 * view, 0, 0};
    scene.views[view].pose_id = view;
    scene.poses[view] = pose;
    if (is_moved(view)) scene.poses[view].center.z() += across;
  }
  return RobustPositionErrors(scene, truth, wrong).error;
}

TEST(RobustPositionErrors, AnExactGroupWinsOverACompromise) {
  // Halfway between the groups all would be within the limit of 0.5.
  const auto is_moved = [](std::uint32_t view) { return view % 4 == 1; };
  for (const auto& [view, error] : ErrorsAlongALine(11, is_moved, 0.8, 0.05)) {
    EXPECT_NEAR(error, is_moved(view.value()) ? 0.08 : 0, 1e-9) << view;
  }
}

TEST(RobustPositionErrors, CamerasThatAreLittleOffMoveNoOther) {
  // Within the limit; halfway between the groups the sum of squares is less.
  const auto is_moved = [](std::uint32_t view) { return view < 3; };
  for (const auto& [view, error] : ErrorsAlongALine(8, is_moved, 1, 0.2)) {
    EXPECT_NEAR(error, is_moved(view.value()) ? 1.0 / 7 : 0, 1e-9) << view;
  }
}

TEST(RobustPositionErrors, AreInfiniteWhereNothingCanBeAligned) {
  const SyntheticScene synthetic = *Simulate(SmallRoom());
  Scene scene = TrueSolution(synthetic);
  for (auto& entry : scene.poses) entry.second.center.setZero();
  for (const auto& [view, error] :
       RobustPositionErrors(scene, synthetic.true_poses, 0.2).error) {
    EXPECT_TRUE(std::isinf(error)) << view;
  }
}

TEST(AddLookAlikes, OnePairHasMatchesThatBearOutAWrongPose) {
  SyntheticScene synthetic = *Simulate(SmallRoom());
  const Scene before = synthetic.scene;
  Random random(3);
  AddLookAlikes(40, 0.5, &random, &synthetic.scene);
  int num_changed = 0;
  for (const auto& [views, pose] : synthetic.scene.relative_poses) {
    if (pose == before.relative_poses.at(views)) continue;
    ++num_changed;
    EXPECT_EQ(pose.point_inliers.size(), 40u);
    Scene pair = synthetic.scene;
    const RelativePose expected = pose;
    ASSERT_TRUE(EstimatePosesAnew(RunContext(), &pair));
    ASSERT_EQ(pair.relative_poses.count(views), 1u);
    const RelativePose& found = pair.relative_poses.at(views);
    EXPECT_LT(RotationAngleBetween(found.rotation, expected.rotation), 0.1);
  }
  EXPECT_EQ(num_changed, 1);
}

TEST(TrustScenes, AreTheSameForASeedAndOfAllKinds) {
  std::set<std::string> labels;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const TrustScene drawn = DrawTrustScene(TrustFamily::kMixed, seed);
    EXPECT_TRUE(drawn.options.Validate());
    EXPECT_EQ(drawn.Labels(),
              DrawTrustScene(TrustFamily::kMixed, seed).Labels());
    for (const std::string& label : drawn.Labels()) labels.insert(label);
  }
  for (const char* label :
       {"world room", "world corridor", "world ring", "world planar",
        "world collinear", "world twins", "world pure_rotation", "pairs chain",
        "pairs all", "wrong directions", "wrong relative poses",
        "wrong matches", "look-alikes", "wrong focal length",
        "nothing wrong"}) {
    EXPECT_EQ(labels.count(label), 1u) << label;
  }
}

TrustStudy Completed(int num_scenes, int num_threads) {
  TrustStudy study;
  study.num_scenes = num_scenes;
  RunContext context;
  context.num_threads = num_threads;
  EXPECT_TRUE(RunTrustStudy(context, nullptr, &study));
  return study;
}

TEST(TrustStudy, TheSameForAnyNumberOfThreads) {
  const TrustStudy one = Completed(1, 1), three = Completed(1, 3);
  EXPECT_EQ(CamerasCsv(one), CamerasCsv(three));
  EXPECT_EQ(SummaryText(one), SummaryText(three));
  EXPECT_EQ(one.trials.size(), AllTrustFamilies().size());
}

TEST(TrustStudy, GoesOnFromItsRecords) {
  TrustStudy study;
  study.num_scenes = 1;
  std::vector<std::string> records;
  const auto keep = [&](const TrustKey& key, const TrustTrial& trial) {
    records.push_back(ToJsonLine(key, trial));
    return records.size() < 2 ? Status()
                              : MakeError(ErrorCode::kIo, "the disk is full");
  };
  RunContext context;
  context.num_threads = 1;
  const Status failed = RunTrustStudy(context, keep, &study);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, ErrorCode::kIo);
  ASSERT_EQ(records.size(), 2u);

  TrustStudy resumed;
  resumed.num_scenes = 1;
  for (const std::string& record : records) {
    ASSERT_TRUE(AddJsonLine(record, &resumed)) << record;
    // Nothing of it is lost.
    EXPECT_EQ(
        ToJsonLine(resumed.trials.begin()->first,
                   resumed.trials.begin()->second),
        ToJsonLine(study.trials.begin()->first, study.trials.begin()->second));
  }
  std::size_t num_new = 0;
  const auto count = [&](const TrustKey&, const TrustTrial&) {
    ++num_new;
    return Status();
  };
  ASSERT_TRUE(RunTrustStudy(context, count, &resumed));
  EXPECT_EQ(num_new + records.size(), AllTrustFamilies().size());
  EXPECT_EQ(CamerasCsv(resumed), CamerasCsv(Completed(1, 1)));
  for (const char* bad :
       {"", "{}", R"({"family": "rain"})", "[1, 2]", "{\"family\""}) {
    EXPECT_FALSE(AddJsonLine(bad, &resumed)) << bad;
  }
}

JudgedView View(ViewGrade grade, double error, double deviation) {
  JudgedView judged;
  judged.graded.grade = grade;
  if (grade == ViewGrade::kDoubtful) judged.graded.reasons = {"unheld"};
  judged.error = error;
  judged.deviation = deviation;
  return judged;
}

TrustStudy Invented() {
  TrustTrial trial;
  trial.labels = {"world room", "pairs chain", "nothing wrong"};
  trial.views = {View(ViewGrade::kFirm, 0.01, 0.001),
                 View(ViewGrade::kFirm, 0.06, 0.02),
                 View(ViewGrade::kFirm, 0.06, 0.001),
                 View(ViewGrade::kFirm, 0.3, 0.001),
                 View(ViewGrade::kDoubtful, 0.3, 0),
                 View(ViewGrade::kDoubtful, 0.01, 0),
                 View(ViewGrade::kUnplaced, HUGE_VAL, 0)};
  TrustStudy study;
  study.trials[{TrustFamily::kMixed, 5}] = trial;
  trial.labels[0] = "world ring";
  study.trials[{TrustFamily::kWrongDirections, 5}] = trial;
  return study;
}

TEST(TrustSummary, CountsCamerasByGradeAndError) {
  const TrustStudy study = Invented();
  const TrustCounts counts = CountTrust(study, TrustFamily::kMixed);
  EXPECT_EQ(counts.scenes, 1);
  EXPECT_EQ(counts.cameras, 7);
  EXPECT_EQ(counts.placed, 6);
  EXPECT_EQ(counts.firm, 4);
  EXPECT_EQ(counts.firm_off, 2);
  EXPECT_EQ(counts.wrong, 2);
  EXPECT_EQ(counts.silent, 1);
  EXPECT_EQ(counts.good, 2);
  EXPECT_EQ(counts.good_doubted, 1);
  EXPECT_EQ(CountTrust(study, TrustFamily::kMixed, "world ring").scenes, 0);
  EXPECT_THAT(SummaryText(study), HasSubstr("mixed 5: cameras"));
}

TEST(TrustSummary, ThePlotSaysHowManyCamerasABarStandsFor) {
  const auto plot = DrawFirmShare(Invented());
  ASSERT_TRUE(plot);
  EXPECT_THAT(*plot, HasSubstr("0.5 to 1 % (1 of 2, 1 of 2, 0 of 0, 0 of 0)"));
  EXPECT_THAT(*plot, HasSubstr("20 to 50 % (1 of 2, 1 of 2, 0 of 0, 0 of 0)"));
  EXPECT_THAT(*plot, HasSubstr("over 100 % (0 of 0, 0 of 0, 0 of 0, 0 of 0)"));
}

// Pairs of views at one place, between which no ratio is meaningful.
TEST(TrustTrial, WhereNothingTellsAScaleNoWrongCameraIsFirm) {
  RunContext context;
  context.num_threads = 1;
  const auto trial = RunTrustTrial(TrustFamily::kMixed, 7700145, context);
  ASSERT_TRUE(trial);
  int num_wrong = 0;
  for (const JudgedView& judged : trial->views) {
    if (!judged.IsPlaced() || !(judged.error > kWrongCamera)) continue;
    ++num_wrong;
    EXPECT_TRUE(judged.IsDoubtful()) << judged.view.value();
  }
  EXPECT_GT(num_wrong, 0);
}

// Of features that have nothing to do with each other.
TEST(TrustNoise, NothingIsMeaningfulAndNoCameraIsFirm) {
  int num_triplets = 0, num_meaningful = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    RunContext context;
    context.num_threads = 1;
    const auto trial = RunTrustTrial(TrustFamily::kNoise, seed, context);
    ASSERT_TRUE(trial);
    num_triplets += trial->num_triplets;
    num_meaningful += trial->num_meaningful;
    for (const JudgedView& judged : trial->views) {
      EXPECT_FALSE(judged.IsFirm()) << "seed " << seed;
    }
  }
  EXPECT_GT(num_triplets, 0);
  EXPECT_EQ(num_meaningful, 0);
}

}  // namespace
}  // namespace lowlap
