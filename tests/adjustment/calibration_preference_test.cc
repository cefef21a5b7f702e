#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/calibration/calibration_score.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::IsOk;

constexpr IntrinsicId kIntrinsic = 7;

TestSceneOptions SmallScene(std::uint64_t seed) {
  TestSceneOptions options;
  options.num_views = 5;
  options.num_points = 150;
  options.num_lines = 60;
  options.noise_px = 0.5;
  options.pairs_per_triplet = 5;
  options.seed = seed;
  return options;
}

TestSceneOptions RichScene() {
  TestSceneOptions options;
  options.noise_px = 0.3;
  return options;
}

AdjustmentSummary Adjusted(Scene* scene, const AdjustmentOptions& options) {
  EXPECT_THAT(BuildStructure(scene, {}, {}), IsOk());
  const auto summary = AdjustScene(scene, options, {});
  EXPECT_THAT(summary, IsOk());
  return summary.value_or(AdjustmentSummary{});
}

// One call in a hundred may be false: more than five in a hundred scenes would
// be so once in two thousand times.
TEST(CalibrationPreferenceTest, IsSilentAboutATrueCalibration) {
  AdjustmentOptions options;
  options.estimate_uncertainty = false;
  int false_alarms = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    TestScene test = MakeTestScene(SmallScene(seed));
    const auto summary = Adjusted(&test.scene, options);
    false_alarms += summary.calibration_preferences.empty() ? 0 : 1;
    EXPECT_TRUE(DescribeCalibrationPreferences(summary).empty() ==
                summary.calibration_preferences.empty());
  }
  EXPECT_LE(false_alarms, 5);
}

struct Fault {
  std::string parts;
  void (*apply)(Intrinsic*);
  double (*value)(const Intrinsic&);
};

const Fault kFaults[] = {
    {"focal",
     [](Intrinsic* k) {
       k->fx_px *= 1.01;
       k->fy_px *= 1.01;
     },
     [](const Intrinsic& k) { return k.fx_px; }},
    {"aspect", [](Intrinsic* k) { k->fy_px *= 1.01; },
     [](const Intrinsic& k) { return k.fy_px; }},
    {"principal-point", [](Intrinsic* k) { k->principal_point_px.x() += 6; },
     [](const Intrinsic& k) { return k.principal_point_px.x(); }},
};

// Four standard deviations, and a tenth of the way for the first order.
double Tolerance(const Fault& fault, const CalibrationPreference& preference) {
  const double change = std::abs(fault.value(preference.preferred) -
                                 fault.value(preference.held));
  return 4 * change / preference.deviations + 0.1 * change;
}

TEST(CalibrationPreferenceTest, NamesThePartThatIsWrongAndByHowMuch) {
  for (const Fault& fault : kFaults) {
    SCOPED_TRACE(fault.parts);
    TestScene test = MakeTestScene(RichScene());
    const Intrinsic truth = test.scene.intrinsics.at(kIntrinsic);
    fault.apply(&test.scene.intrinsics.at(kIntrinsic));
    const Intrinsic held = test.scene.intrinsics.at(kIntrinsic);
    const auto summary = Adjusted(&test.scene, {});
    EXPECT_TRUE(test.scene.intrinsics.at(kIntrinsic) == held);
    ASSERT_EQ(summary.calibration_preferences.size(), 1u);
    const CalibrationPreference& preference =
        summary.calibration_preferences.front();
    EXPECT_THAT(preference.intrinsics, ElementsAre(kIntrinsic));
    EXPECT_THAT(DescribeParts(preference.parts), HasSubstr(fault.parts));
    EXPECT_TRUE(preference.held == held);
    EXPECT_GT(preference.deviations, 3);
    EXPECT_NEAR(fault.value(preference.preferred), fault.value(truth),
                Tolerance(fault, preference));
    EXPECT_THAT(DescribeCalibrationPreferences(summary),
                ElementsAre(HasSubstr("--refine-intrinsics " +
                                      DescribeParts(preference.parts))));
  }
}

// To first order the images may want a focal length below zero.
TEST(CalibrationPreferenceTest, WhatIsPreferredIsALens) {
  int num_preferences = 0;
  for (const double factor : {0.3, 0.5, 2.0, 4.0}) {
    TestScene test = MakeTestScene(RichScene());
    Intrinsic& held = test.scene.intrinsics.at(kIntrinsic);
    held.fx_px *= factor;
    held.fy_px *= factor;
    const auto summary = Adjusted(&test.scene, {});
    for (const auto& preference : summary.calibration_preferences) {
      ++num_preferences;
      const Intrinsic& preferred = preference.preferred;
      EXPECT_GE(preferred.fx_px, 0.499 * held.fx_px) << factor;
      EXPECT_GE(preferred.fy_px, 0.249 * held.fy_px) << factor;
      EXPECT_LE(preferred.fx_px, 2.001 * held.fx_px) << factor;
      EXPECT_LE(preferred.fy_px, 4.001 * held.fy_px) << factor;
      EXPECT_LE((preferred.principal_point_px - held.principal_point_px).norm(),
                0.36 * held.ImageDiagonal())
          << factor;
    }
  }
  EXPECT_GT(num_preferences, 0);
}

// One that is hopeless does not hold the other back.
TEST(CalibrationPreferenceTest, GroupsAreShortenedOnTheirOwn) {
  CalibrationScore score;
  score.groups.resize(2);
  score.parts = {{0, &IntrinsicRefinement::focal, 0, 1},
                 {0, &IntrinsicRefinement::principal_point, 1, 2},
                 {1, &IntrinsicRefinement::focal, 3, 1},
                 {1, &IntrinsicRefinement::distortion, 4, 1}};
  score.u = Eigen::VectorXd(5);
  score.u << 10 * std::log(2.0), 0.1, 0, -0.02, 0.3;
  score.information = Eigen::MatrixXd::Identity(5, 5);
  const Eigen::VectorXd change = score.Change({0, 1, 2, 3});
  ASSERT_EQ(change.size(), 5);
  EXPECT_NEAR(change(0), -std::log(2.0), 1e-12);
  EXPECT_NEAR(change(1), -0.01, 1e-12);
  EXPECT_NEAR(change(3), 0.02, 1e-12);
  EXPECT_EQ(change(4), 0);
}

TEST(CalibrationPreferenceTest, PinholesAreTestedForADistortion) {
  TestSceneOptions options = RichScene();
  options.model = CameraModel::kRadialK1;
  options.distortion = {-0.03};
  TestScene test = MakeTestScene(options);
  Intrinsic& intrinsic = test.scene.intrinsics.at(kIntrinsic);
  intrinsic.model = CameraModel::kPinhole;
  intrinsic.distortion.clear();
  const auto summary = Adjusted(&test.scene, {});
  ASSERT_EQ(summary.calibration_preferences.size(), 1u);
  const Intrinsic& preferred =
      summary.calibration_preferences.front().preferred;
  EXPECT_TRUE(summary.calibration_preferences.front().parts.distortion);
  ASSERT_EQ(preferred.distortion.size(), 1u);
  EXPECT_LT(preferred.distortion[0], 0);
  EXPECT_EQ(intrinsic.model, CameraModel::kPinhole);
}

// What is said is what the flag that is named would do.
TEST(CalibrationPreferenceTest, AgreesWithTheFreedAdjustment) {
  const Fault& fault = kFaults[0];
  TestScene test = MakeTestScene(RichScene());
  fault.apply(&test.scene.intrinsics.at(kIntrinsic));
  Scene freed = test.scene;
  const auto summary = Adjusted(&test.scene, {});
  ASSERT_EQ(summary.calibration_preferences.size(), 1u);
  const CalibrationPreference& preference =
      summary.calibration_preferences.front();
  AdjustmentOptions options;
  RefineAllIntrinsics(preference.parts, &freed, &options);
  const auto after = Adjusted(&freed, options);
  EXPECT_NEAR(fault.value(preference.preferred),
              fault.value(freed.intrinsics.at(kIntrinsic)),
              Tolerance(fault, preference));
  for (const CalibrationPreference& left : after.calibration_preferences) {
    EXPECT_FALSE(left.parts.focal);
    EXPECT_TRUE(left.refined.focal);
  }
}

// A view with an intrinsic of its own, in which nothing is observed.
void AddEmptyView(int id, CameraModel model, Scene* scene) {
  Intrinsic intrinsic = scene->intrinsics.at(kIntrinsic);
  intrinsic.model = model;
  intrinsic.distortion.assign(DistortionCount(model), 0);
  scene->intrinsics[id] = intrinsic;
  View view = scene->views.begin()->second;
  view.filename = "empty " + std::to_string(id) + ".png";
  view.intrinsic_id = id;
  view.pose_id = id;
  scene->poses[id] = {};
  scene->views[id] = view;
  scene->features[id] = {};
}

// Seventeen are tested together. The first has more coefficients than those
// that the images say something about.
TEST(CalibrationPreferenceTest, ManyAreRepresentedByTheFirstThatIsObserved) {
  TestSceneOptions options = RichScene();
  options.model = CameraModel::kRadialK1;
  options.distortion = {-0.03};
  TestScene test = MakeTestScene(options);
  test.scene.intrinsics.at(kIntrinsic).distortion = {0};
  const Intrinsic held = test.scene.intrinsics.at(kIntrinsic);
  AddEmptyView(1, CameraModel::kBrownT2, &test.scene);
  for (int n = 0; n < 15; ++n) {
    AddEmptyView(200 + n, CameraModel::kRadialK1, &test.scene);
  }
  const auto summary = Adjusted(&test.scene, {});
  ASSERT_EQ(summary.calibration_preferences.size(), 1u);
  const CalibrationPreference& preference =
      summary.calibration_preferences.front();
  ASSERT_EQ(preference.intrinsics.size(), 17u);
  EXPECT_EQ(preference.intrinsics[0], kIntrinsic);
  EXPECT_EQ(preference.intrinsics[1], IntrinsicId(1));
  EXPECT_TRUE(preference.parts.distortion);
  EXPECT_TRUE(preference.held == held);
  ASSERT_EQ(preference.preferred.distortion.size(), 1u);
  EXPECT_LT(preference.preferred.distortion[0], 0);
  EXPECT_THAT(DescribeCalibrationPreferences(summary),
              ElementsAre(HasSubstr("intrinsic 7 and, likewise, 16 more")));
}

TEST(CalibrationPreferenceTest, IsAskedForByTheOptions) {
  TestScene test = MakeTestScene(RichScene());
  kFaults[0].apply(&test.scene.intrinsics.at(kIntrinsic));
  AdjustmentOptions options;
  options.test_calibration = false;
  EXPECT_TRUE(Adjusted(&test.scene, options).calibration_preferences.empty());
}

}  // namespace
}  // namespace lowlap
