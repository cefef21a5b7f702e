#include "lowlap/two_view/internal/pair_estimator.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>

#include "lowlap/two_view/internal/search/refine_relative_pose.h"
#include "support/matchers.h"
#include "tests/matching/pattern_view.h"
#include "tests/two_view/copied_pair.h"
#include "tests/two_view/tiled_pair.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using ::testing::HasSubstr;
using testing::IsError;
using testing::IsOk;
using testing::kFocalPx;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

Intrinsic Camera() {
  Intrinsic intrinsic;
  intrinsic.width_px = 1600;
  intrinsic.height_px = 1200;
  intrinsic.fx_px = intrinsic.fy_px = kFocalPx;
  intrinsic.principal_point_px = {799.5, 599.5};
  return intrinsic;
}

ViewFeatures InPixels(const NormalizedFeatures& normalized) {
  ViewFeatures features;
  for (const Vec3& x : normalized.points) {
    features.points_px.push_back(Camera().Project(x));
  }
  return features;
}

// With descriptors that match nothing.
DetectedFeatures Detected(const NormalizedFeatures& normalized,
                          Random* random) {
  DetectedFeatures detected;
  detected.features = InPixels(normalized);
  for (const Vec2& position_px : detected.features.points_px) {
    detected.keypoints.push_back({position_px, 2});
    detected.point_descriptors.push_back(testing::RandomDescriptor(random));
  }
  return detected;
}

/// A view of the scene in pixels.
ViewMeasurements Measure(const NormalizedFeatures& normalized,
                         const DetectedFeatures* detected = nullptr) {
  return MeasureView(InPixels(normalized), Camera(), Vec2(1600, 1200), detected,
                     {});
}

PairEstimate Estimate(const TwoViewScene& scene) {
  return EstimatePair({3, 8}, Measure(scene.features1),
                      Measure(scene.features2), {scene.matches, {}}, {}, 1);
}

TEST(EstimatePair, GivesThePoseWithItsInliers) {
  TwoViewSceneOptions options;
  options.num_wrong = 60;
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 1);
  const PairEstimate estimate = Estimate(scene);
  ASSERT_TRUE(estimate.pose) << estimate.reason;
  EXPECT_EQ(estimate.pose->views, (ViewPair{3, 8}));
  EXPECT_EQ(estimate.geometry, TwoViewGeometry::kGeneral);
  EXPECT_FALSE(estimate.no_parallax);
  EXPECT_EQ(estimate.num_point_inliers,
            static_cast<int>(estimate.pose->point_inliers.size()));
  EXPECT_EQ(estimate.log10_nfa, estimate.pose->log10_nfa);
  // The same as the estimator alone, where there is nothing to guide.
  const auto alone = EstimateRelativePose(scene.Input(), {}, 1);
  ASSERT_THAT(alone, IsOk());
  EXPECT_LT(RotationErrorDeg(estimate.pose->rotation, alone->pose.rotation),
            1e-3);
  EXPECT_LT(DirectionErrorDeg(estimate.pose->direction, alone->pose.direction),
            1e-2);
}

// Two views of a cloud, of which only a corner matches. Without what detectors
// know, the features may be those with matches only.
TEST(EstimatePair, IsWeakWhereWhatSurroundsTheMatchesDoesNotMatch) {
  TwoViewSceneOptions options;
  options.num_right = 800;
  options.noise_px = 0.3;
  TwoViewScene scene = MakeTwoViewScene(options, 5);
  Random random(6);
  const DetectedFeatures first = Detected(scene.features1, &random);
  const DetectedFeatures second = Detected(scene.features2, &random);
  const auto weakness = [&](bool is_detected) {
    const PairEstimate estimate = EstimatePair(
        {3, 8}, Measure(scene.features1, is_detected ? &first : nullptr),
        Measure(scene.features2, is_detected ? &second : nullptr),
        {scene.matches, {}}, {}, 1);
    EXPECT_TRUE(estimate.pose) << estimate.reason;
    return estimate.pose->weakness;
  };
  EXPECT_EQ(weakness(true), std::nullopt);
  const auto is_elsewhere = [&](const FeatureMatch& match) {
    const Vec3& x = scene.features1.points[match.first];
    return x.x() > -0.25 || x.y() > -0.05;
  };
  scene.matches.erase(
      std::remove_if(scene.matches.begin(), scene.matches.end(), is_elsewhere),
      scene.matches.end());
  EXPECT_EQ(weakness(true), PoseWeakness::kSurroundings);
  EXPECT_EQ(weakness(false), std::nullopt);
}

TEST(EstimatePair, UsesOfWhatItMatchesUnderThePoseWhatTheFiltersLeave) {
  constexpr std::size_t kPutative = 80;
  TwoViewSceneOptions options;
  options.num_right = 400;
  options.noise_px = 0.3;
  TwoViewScene scene = MakeTwoViewScene(options, 5);
  Random random(6);
  const DetectedFeatures first = Detected(scene.features1, &random);
  DetectedFeatures second = Detected(scene.features2, &random);
  for (const FeatureMatch& match : scene.matches) {
    second.point_descriptors[match.second] =
        first.point_descriptors[match.first];
  }
  scene.matches.resize(kPutative);
  const auto num_inliers = [&](const GuidedMatchFilters& filters) {
    const PairEstimate estimate = EstimatePair(
        {3, 8}, Measure(scene.features1, &first),
        Measure(scene.features2, &second), {scene.matches, {}}, {}, 1, filters);
    EXPECT_TRUE(estimate.pose) << estimate.reason;
    return estimate.pose->point_inliers.size();
  };
  EXPECT_GT(num_inliers({}), 2 * kPutative);
  GuidedMatchFilters none;
  none.points = [](const std::vector<FeatureMatch>&) {
    return std::vector<FeatureMatch>{};
  };
  EXPECT_LE(num_inliers(none), kPutative);
  EXPECT_GT(num_inliers(none), kPutative / 2);
}

std::optional<PoseWeakness> WeaknessOfPose(
    const testing::TiledPair& pair, const std::vector<FeatureMatch>& matches) {
  ViewMeasurements first, second;
  first.features = pair.view1.features;
  first.repeats = pair.repeats1;
  second.features = pair.view2.features;
  second.repeats = pair.repeats2;
  first.image_size_px = second.image_size_px = Vec2(1600, 1200);
  const PairEstimate estimate =
      EstimatePair({3, 8}, first, second, {matches, {}}, {}, 1);
  EXPECT_TRUE(estimate.pose) << estimate.reason;
  return estimate.pose->weakness;
}

// The matches, `num_wrong` of the last `num_others` with another's partner.
std::vector<FeatureMatch> WithWrong(std::vector<FeatureMatch> matches,
                                    int num_others, int num_wrong) {
  const std::size_t begin = matches.size() - num_others;
  for (int n = 0; n + 1 < num_wrong; n += 2) {
    std::swap(matches[begin + n].second, matches[begin + n + 1].second);
  }
  return matches;
}

TEST(EstimatePair, IsWeakWhereNearlyAllRepeatsUnlessMostOfTheRestAgrees) {
  constexpr int kFew = 30;
  const testing::TiledPair few(kFew), many(300);
  EXPECT_EQ(WeaknessOfPose(few, WithWrong(few.matches, kFew, kFew)),
            PoseWeakness::kRepeats);
  EXPECT_EQ(WeaknessOfPose(few, few.matches), std::nullopt);
  EXPECT_EQ(WeaknessOfPose(many, many.matches), std::nullopt);
}

// Each tile with its neighbour: their motion gives way to that of the others.
TEST(EstimatePair, IsNotWeakWhereTheOthersAgreeOnAMotionOfTheirOwn) {
  constexpr int kOthers = 50;
  const testing::TiledPair pair(kOthers);
  const std::vector<FeatureMatch> matches =
      testing::MatchesOfNeighbours(kOthers);
  EXPECT_EQ(WeaknessOfPose(pair, matches), std::nullopt);
  EXPECT_EQ(WeaknessOfPose(pair, WithWrong(matches, kOthers, kOthers / 2)),
            PoseWeakness::kRepeats);
}

// The pair as it is detected, and matched right.
std::optional<PoseWeakness> WeaknessOfPose(const testing::CopiedPair& pair,
                                           bool have_looks = true) {
  const auto measure = [&](const testing::PatternView& view,
                           DetectedFeatures* detected) {
    if (have_looks) {
      detected->keypoints = view.keypoints;
      detected->point_descriptors = view.descriptors;
    }
    ViewMeasurements measured;
    measured.features = view.features;
    measured.detected = detected;
    measured.image_size_px = Vec2(1600, 1200);
    return measured;
  };
  DetectedFeatures detected1, detected2;
  const PairEstimate estimate = EstimatePair(
      {3, 8}, measure(pair.view1, &detected1), measure(pair.view2, &detected2),
      {pair.pose.point_inliers, {}}, {}, 1);
  EXPECT_TRUE(estimate.pose) << estimate.reason;
  return estimate.pose->weakness;
}

TEST(EstimatePair, IsWeakWhereWhatLooksAlikeBearsOutAnotherMotion) {
  EXPECT_EQ(WeaknessOfPose(testing::CopiedPair(testing::Door)),
            PoseWeakness::kRepeats);
  EXPECT_EQ(WeaknessOfPose(testing::CopiedPair(testing::Anything)),
            std::nullopt);
  // Points of elsewhere, beside detected lines.
  EXPECT_EQ(WeaknessOfPose(testing::CopiedPair(testing::Door), false),
            std::nullopt);
}

TEST(EstimatePair, SaysWhyThereIsNoPose) {
  TwoViewSceneOptions few;
  few.num_right = 4;
  const PairEstimate too_few = Estimate(MakeTwoViewScene(few, 2));
  EXPECT_FALSE(too_few.pose);
  EXPECT_FALSE(too_few.no_parallax);
  EXPECT_FALSE(too_few.geometry);
  EXPECT_THAT(too_few.reason, HasSubstr("4 usable points"));

  TwoViewSceneOptions turned;
  turned.baseline = 0;
  turned.noise_px = 0.3;
  const PairEstimate rotation = Estimate(MakeTwoViewScene(turned, 3));
  EXPECT_FALSE(rotation.pose);
  EXPECT_TRUE(rotation.no_parallax);
  EXPECT_EQ(rotation.geometry, TwoViewGeometry::kRotationOnly);
  EXPECT_THAT(rotation.reason, HasSubstr("no parallax"));
  EXPECT_GT(rotation.num_point_inliers, 150);
}

TEST(RefinePair, ImprovesOnTheInliersAlone) {
  TwoViewSceneOptions options;
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 4);
  const ViewMeasurements first = Measure(scene.features1);
  const ViewMeasurements second = Measure(scene.features2);
  RelativePose rough;
  rough.views = {3, 8};
  rough.rotation = RotationFromAngleAxis(Vec3(0.002, -0.001, 0.001)) *
                   scene.cam2_from_cam1.rotation;
  rough.direction =
      (scene.cam2_from_cam1.translation + Vec3(0, 0.01, 0)).normalized();
  rough.point_inliers = scene.matches;
  rough.log10_nfa = -50;
  rough.point_threshold_px = 3;
  const RelativePose refined = RefinePair(rough, first, second, {});
  EXPECT_EQ(refined.log10_nfa, rough.log10_nfa);
  EXPECT_LT(
      RotationErrorDeg(refined.rotation, scene.cam2_from_cam1.rotation),
      0.5 * RotationErrorDeg(rough.rotation, scene.cam2_from_cam1.rotation));
  // Without matches there is nothing to go by.
  rough.point_inliers.clear();
  EXPECT_TRUE(RefinePair(rough, first, second, {}) == rough);
}

// It has no threshold, which does not mean that its matches are exact.
TEST(RefinePair, KeepsTheInliersOfAGivenPose) {
  TwoViewSceneOptions options;
  options.noise_px = 0.5;
  const TwoViewScene scene = MakeTwoViewScene(options, 1);
  const ViewMeasurements first = Measure(scene.features1);
  const ViewMeasurements second = Measure(scene.features2);
  const PairEstimate given = TakePair(
      {3, 8}, first, second, {scene.matches, {}}, options.cam2_from_cam1, {});
  ASSERT_TRUE(given.pose) << given.reason;
  const RelativePose refined = RefinePair(*given.pose, first, second, {});
  EXPECT_GT(refined.point_inliers.size(), 195u);
}

// The share of the variance of `before` that `after` has lost in the direction
// in which it has lost most; their frames are nearly the same.
double MostLost(const Mat5& before, const Mat5& after) {
  const Mat5 half = before.llt().matrixL();
  const Mat5 inverse = half.inverse();
  const Mat5 ratio = inverse * after * inverse.transpose();
  return 1 - ratio.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
}

TEST(RefinePair, StillSaysWhatOnePlaneLeavesOpen) {
  for (int seed = 0; seed < 5; ++seed) {
    TwoViewSceneOptions options;
    options.planar = true;
    options.noise_px = 0.3;
    options.num_wrong = 40;
    const TwoViewScene scene = MakeTwoViewScene(options, 500 + seed);
    const PairEstimate estimate = Estimate(scene);
    ASSERT_TRUE(estimate.pose) << estimate.reason;
    const RelativePose refined = RefinePair(
        *estimate.pose, Measure(scene.features1), Measure(scene.features2), {});
    ASSERT_TRUE(refined.covariance);
    EXPECT_LT(MostLost(*estimate.pose->covariance, *refined.covariance), 0.02)
        << seed;
  }
}

TEST(RefinePair, StillSaysHowFarItsRivalsWere) {
  TwoViewSceneOptions options;
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 4);
  const ViewMeasurements first = Measure(scene.features1);
  const ViewMeasurements second = Measure(scene.features2);
  RelativePose pose = *Estimate(scene).pose;
  Vec5 along;
  along << 0.01, -0.02, 0.01, 0.1, 0.2;
  *pose.covariance += along * along.transpose();
  const RelativePose refined = RefinePair(pose, first, second, {});
  EXPECT_LT(MostLost(*pose.covariance, *refined.covariance), 0.02);
  // What states less than the matches gives way to them.
  pose.covariance.reset();
  const Mat5 law = *RefinePair(pose, first, second, {}).covariance;
  pose.covariance = Mat5(1e-3 * law);
  const Mat5 same = *RefinePair(pose, first, second, {}).covariance;
  EXPECT_LT((same - law).norm(), 1e-6 * law.norm());
}

TEST(RefinePair, AnAlternativeKeepsWhatItsCovarianceSaid) {
  TwoViewSceneOptions options;
  options.planar = true;
  options.noise_px = 0.3;
  options.cam2_from_cam1 = {RotationFromAngleAxis(Vec3(0.1, -0.1, 0)),
                            Vec3(0, 0.3, -1).normalized()};
  const TwoViewScene scene = MakeTwoViewScene(options, 0);
  RelativePose pose = *Estimate(scene).pose;
  ASSERT_EQ(pose.alternatives.size(), 1u);
  pose.alternatives[0].covariance = Mat5(0.01 * Mat5::Identity());
  const RelativePose refined =
      RefinePair(pose, Measure(scene.features1), Measure(scene.features2), {});
  ASSERT_EQ(refined.alternatives.size(), 1u);
  EXPECT_LT(MostLost(*pose.alternatives[0].covariance,
                     *refined.alternatives[0].covariance),
            0.01);
}

TEST(PairOptions, NeedPointsOrLines) {
  PairOptions options;
  EXPECT_THAT(options.Validate(), IsOk());
  options.use_points = options.use_lines = false;
  EXPECT_THAT(options.Validate(),
              IsError(ErrorCode::kInvalidArgument, "points or lines"));
}

}  // namespace
}  // namespace lowlap
