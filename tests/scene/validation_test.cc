#include "lowlap/scene/validation.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::FullScene;
using testing::IsOk;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Case {
  const char* name;
  std::function<void(Scene&)> damage;
  const char* place;
  const char* message;
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

class ValidateSceneCase : public ::testing::TestWithParam<Case> {};

TEST_P(ValidateSceneCase, NamesThePlace) {
  Scene scene = FullScene();
  GetParam().damage(scene);
  const Status status = ValidateScene(scene);
  ASSERT_FALSE(status.has_value());
  EXPECT_EQ(status.error().code, ErrorCode::kInvalidScene);
  EXPECT_EQ(status.error().place, GetParam().place);
  EXPECT_THAT(status.error().message, ::testing::HasSubstr(GetParam().message));
}

RelativePose& Edge(Scene& s) { return s.relative_poses.at({1, 4}); }

#define VIEWS "$.views[key=4]"
#define EDGE "$.lowlap.relative_poses[views=1,4]"
#define RATIO "$.lowlap.scale_ratios[views=7,4,1]"
#define LINE "$.lowlap.line_structure[id=2]"

const Case kCameraCases[] = {
    {"RootPathNotUtf8", [](Scene& s) { s.root_path = "\xC0\xAF"; },
     "$.root_path", "UTF-8"},
    {"FilenameNotUtf8", [](Scene& s) { s.views[4].filename = "caf\xE9.jpg"; },
     VIEWS ".filename", "UTF-8"},
    {"LocalPathEndsInsideACharacter",
     [](Scene& s) { s.views[4].local_path = "\xE2\x82"; }, VIEWS ".local_path",
     "UTF-8"},
    {"FilenameWithSurrogate",
     [](Scene& s) { s.views[4].filename = "\xED\xA0\x80"; }, VIEWS ".filename",
     "UTF-8"},
    {"ReservedViewId", [](Scene& s) { s.views[kInvalidId] = s.views[4]; },
     "$.views[key=4294967295]", "reserved"},
    {"NegativeWidth", [](Scene& s) { s.views[4].width_px = -1; },
     VIEWS ".width", "negative"},
    {"NegativeHeight", [](Scene& s) { s.views[4].height_px = -1; },
     VIEWS ".height", "negative"},
    {"DanglingIntrinsic", [](Scene& s) { s.views[4].intrinsic_id = 99; },
     VIEWS ".id_intrinsic", "no intrinsic 99"},
    {"PriorWeightNan",
     [](Scene& s) { s.views[4].center_prior->weight.x() = kNan; },
     VIEWS ".center_weight", "finite"},
    {"PriorCenterInfinite",
     [](Scene& s) { s.views[4].center_prior->center_in_world.y() = kInf; },
     VIEWS ".center", "finite"},
    {"OrphanIntrinsic", [](Scene& s) { s.intrinsics[77] = s.intrinsics[0]; },
     "$.intrinsics[key=77]", "no view uses"},
    {"FocalNan", [](Scene& s) { s.intrinsics[0].fx_px = kNan; },
     "$.intrinsics[key=0]", "focal"},
    {"FocalZero", [](Scene& s) { s.intrinsics[0].fy_px = 0; },
     "$.intrinsics[key=0]", "focal"},
    {"PrincipalPointNan",
     [](Scene& s) { s.intrinsics[0].principal_point_px.y() = kNan; },
     "$.intrinsics[key=0]", "principal"},
    {"DistortionInfinite",
     [](Scene& s) { s.intrinsics[30].distortion[4] = kInf; },
     "$.intrinsics[key=30]", "distortion"},
    {"DistortionTooShort",
     [](Scene& s) { s.intrinsics[20].distortion.pop_back(); },
     "$.intrinsics[key=20]", "3 distortion coefficients, not 2"},
    {"IntrinsicWithoutSize", [](Scene& s) { s.intrinsics[0].width_px = 0; },
     "$.intrinsics[key=0]", "size"},
    {"GivenOfNoIntrinsic",
     [](Scene& s) { s.given_intrinsics[77] = s.intrinsics[0]; },
     "$.lowlap.given_intrinsics[id=77]", "no intrinsic 77"},
    {"GivenFocalNan", [](Scene& s) { s.given_intrinsics[20].fx_px = kNan; },
     "$.lowlap.given_intrinsics[id=20]", "focal"},
    {"SphericalWithFocal", [](Scene& s) { s.intrinsics[50].fx_px = 1; },
     "$.intrinsics[key=50]", "spherical"},
    {"OrphanPose", [](Scene& s) { s.poses[5] = s.poses[100]; },
     "$.extrinsics[key=5]", "no view uses"},
    {"PoseScaled", [](Scene& s) { s.poses[101].rotation *= 1 + 1e-5; },
     "$.extrinsics[key=101].rotation", "rotation"},
    {"PoseMirrored", [](Scene& s) { s.poses[101].rotation.row(1) *= -1; },
     "$.extrinsics[key=101].rotation", "rotation"},
    {"PoseRotationNan", [](Scene& s) { s.poses[101].rotation(2, 2) = kNan; },
     "$.extrinsics[key=101].rotation", "rotation"},
    {"PoseCenterNan", [](Scene& s) { s.poses[101].center.z() = kNan; },
     "$.extrinsics[key=101].center", "finite"},
    {"CenterCovarianceNan",
     [](Scene& s) { (*s.poses[101].center_covariance)(1, 2) = kNan; },
     "$.lowlap.center_covariances[id=101].covariance", "finite"},
    {"CenterCovarianceNotSymmetric",
     [](Scene& s) { (*s.poses[101].center_covariance)(0, 2) += 1e25; },
     "$.lowlap.center_covariances[id=101].covariance", "symmetric"},
    {"CenterVarianceNegative",
     [](Scene& s) { (*s.poses[101].center_covariance)(0, 0) = -1; },
     "$.lowlap.center_covariances[id=101].covariance", "negative variance"},
};

const Case kMeasurementCases[] = {
    {"FeaturesOfUnknownView", [](Scene& s) { s.features[99]; },
     "$.lowlap.features[view=99]", "no view 99"},
    {"PointNan", [](Scene& s) { s.features[4].points_px[2].y() = kNan; },
     "$.lowlap.features[view=4].points[4]", "point 2"},
    {"ShapeMissing",
     [](Scene& s) { s.features[4].point_covariances.pop_back(); },
     "$.lowlap.features[view=4].point_covariances", "one per point"},
    {"ShapeNotPositive",
     [](Scene& s) {
       s.features[4].point_covariances[2] = {1, 1, 1};
     },
     "$.lowlap.features[view=4].point_covariances[6]", "point 2"},
    {"ShapeNan", [](Scene& s) { s.features[4].point_covariances[1](1) = kNan; },
     "$.lowlap.features[view=4].point_covariances[3]", "point 1"},
    {"RepeatedPointUnknown",
     [](Scene& s) { s.features[4].repeated_points.push_back(6); },
     "$.lowlap.features[view=4].repeated_points[3]", "only 6 features"},
    {"RepeatedPointTwice",
     [](Scene& s) { s.features[4].repeated_points.push_back(5); },
     "$.lowlap.features[view=4].repeated_points[3]", "ascend"},
    {"RepeatedSegmentsUnordered",
     [](Scene& s) { s.features[4].repeated_segments.push_back(1); },
     "$.lowlap.features[view=4].repeated_segments[1]", "ascend"},
    {"SegmentEndInfinite",
     [](Scene& s) { s.features[4].segments[3].end_px.x() = -kInf; },
     "$.lowlap.features[view=4].segments[15]", "segment 3"},
    {"SegmentStddevNegative",
     [](Scene& s) { s.features[4].segments[3].stddev_px = -1; },
     "$.lowlap.features[view=4].segments[19]", "segment 3"},
    {"PairUnordered",
     [](Scene& s) {
       RelativePose edge = Edge(s);
       edge.views = {7, 1};
       s.relative_poses[edge.views] = edge;
     },
     "$.lowlap.relative_poses[views=7,1].views", "smaller id"},
    {"PairOfOneView",
     [](Scene& s) {
       RelativePose edge = Edge(s);
       edge.views = {4, 4};
       s.relative_poses[edge.views] = edge;
     },
     "$.lowlap.relative_poses[views=4,4].views", "smaller id"},
    {"PairOfUnknownView",
     [](Scene& s) {
       RelativePose edge = Edge(s);
       edge.views = {4, 8};
       s.relative_poses[edge.views] = edge;
     },
     "$.lowlap.relative_poses[views=4,8].views", "no view 8"},
    {"PairStoredUnderOtherViews",
     [](Scene& s) {
       Edge(s).views = {4, 7};
     },
     EDGE ".views", "other views"},
    {"RelativeRotationIsNone", [](Scene& s) { Edge(s).rotation(0, 1) += 1e-5; },
     EDGE ".rotation", "rotation"},
    {"DirectionNotUnit", [](Scene& s) { Edge(s).direction *= 1.00001; },
     EDGE ".direction", "unit"},
    {"DirectionNan", [](Scene& s) { Edge(s).direction.x() = kNan; },
     EDGE ".direction", "unit"},
    {"RelativeNfaInfinite", [](Scene& s) { Edge(s).log10_nfa = -kInf; },
     EDGE ".log10_nfa", "finite"},
    {"ThresholdNegative", [](Scene& s) { Edge(s).point_threshold_px = -0.5; },
     EDGE ".point_threshold_px", "negative"},
    {"CovarianceNan", [](Scene& s) { (*Edge(s).covariance)(4, 4) = kNan; },
     EDGE ".covariance", "finite"},
    {"CovarianceAsymmetric",
     [](Scene& s) { (*Edge(s).covariance)(0, 1) = 1e-6; }, EDGE ".covariance",
     "symmetric"},
    {"CovarianceNegativeVariance",
     [](Scene& s) { (*Edge(s).covariance)(2, 2) = -1e-9; }, EDGE ".covariance",
     "negative variance"},
    {"AlternativeIsNoRotation",
     [](Scene& s) { Edge(s).alternatives[1].rotation(0, 1) = 0.5; },
     EDGE ".alternatives[1].rotation", "rotation"},
    {"AlternativeCovarianceNan",
     [](Scene& s) { (*Edge(s).alternatives[0].covariance)(1, 1) = kNan; },
     EDGE ".alternatives[0].covariance", "finite"},
    {"PointInlierBeyondFirst",
     [](Scene& s) { Edge(s).point_inliers[1].first = 6; },
     EDGE ".point_inliers[2]", "first view has only 6"},
    {"PointInlierBeyondSecond",
     [](Scene& s) { Edge(s).point_inliers[1].second = kInvalidId; },
     EDGE ".point_inliers[3]", "second view has only 6"},
    {"LineInlierBeyondSecond",
     [](Scene& s) { Edge(s).line_inliers[0].second = 6; },
     EDGE ".line_inliers[1]", "second view has only 6"},
    {"TrackOfUnknownView", [](Scene& s) { s.point_tracks[0][1].view = 5; },
     "$.lowlap.point_tracks[id=0].observations[2]", "no view 5"},
    {"TrackOfUnknownPoint", [](Scene& s) { s.point_tracks[0][1].feature = 6; },
     "$.lowlap.point_tracks[id=0].observations[3]", "has only 6"},
    {"TrackOfViewWithoutFeatures",
     [](Scene& s) {
       s.point_tracks[0][1] = {10, 0};
     },
     "$.lowlap.point_tracks[id=0].observations[3]", "has only 0"},
    {"TrackTooShort", [](Scene& s) { s.point_tracks[0].pop_back(); },
     "$.lowlap.point_tracks[id=0].observations", "two observations"},
    {"TrackEmpty", [](Scene& s) { s.line_tracks[2].clear(); },
     "$.lowlap.line_tracks[id=2].observations", "two observations"},
    {"TrackUnsorted",
     [](Scene& s) { std::swap(s.point_tracks[0][0], s.point_tracks[0][1]); },
     "$.lowlap.point_tracks[id=0].observations[2]", "sorted"},
    {"PointTrackTwiceInAView",
     [](Scene& s) {
       s.point_tracks[0].push_back({4, 1});
     },
     "$.lowlap.point_tracks[id=0].observations[4]", "twice"},
    {"LineTrackRepeatsASegment",
     [](Scene& s) {
       s.line_tracks[2].push_back({4, 0});
     },
     "$.lowlap.line_tracks[id=2].observations", "segment 0 of view 4"},
    {"LineTrackOfUnknownSegment",
     [](Scene& s) { s.line_tracks[2][2].feature = 6; },
     "$.lowlap.line_tracks[id=2].observations[5]", "has only 6"},
};

const Case kSolutionCases[] = {
    {"LandmarkNan", [](Scene& s) { s.structure[9].position.x() = kNan; },
     "$.structure[key=9].X", "finite"},
    {"LandmarkObservationOfUnknownView",
     [](Scene& s) { s.structure[9].observations[1].view = 8; },
     "$.structure[key=9].observations[key=8]", "no view 8"},
    {"LandmarkObservationNan",
     [](Scene& s) { s.structure[9].observations[1].pixel_px.x() = kNan; },
     "$.structure[key=9].observations[key=7].x", "finite"},
    {"LandmarkObservationBeyondPoints",
     [](Scene& s) { s.structure[9].observations[1].feature = 6; },
     "$.structure[key=9].observations[key=7].id_feat", "only 6 points"},
    {"LandmarkObservedTwiceInAView",
     [](Scene& s) { s.structure[9].observations[1].view = 4; },
     "$.structure[key=9].observations[key=4]", "twice"},
    {"LandmarkUnsorted",
     [](Scene& s) {
       std::swap(s.structure[9].observations[0],
                 s.structure[9].observations[1]);
     },
     "$.structure[key=9].observations[key=4]", "sorted"},
    {"LandmarkObservedOnce",
     [](Scene& s) { s.structure[0].observations.pop_back(); },
     "$.structure[key=0].observations", "two observations"},
    {"ControlPointNan",
     [](Scene& s) { s.control_points[5].position.z() = kNan; },
     "$.control_points[key=5].X", "finite"},
    {"ControlPointOfUnknownView",
     [](Scene& s) { s.control_points[6].observations[0].view = 2; },
     "$.control_points[key=6].observations[key=2]", "no view 2"},
    {"RatioOfUnknownView", [](Scene& s) { s.scale_ratios[0].views.last = 2; },
     "$.lowlap.scale_ratios[views=7,4,2].views", "no view 2"},
    {"RatioOfTwoViews", [](Scene& s) { s.scale_ratios[0].views.last = 7; },
     "$.lowlap.scale_ratios[views=7,4,7].views", "differ"},
    {"RatioWithoutRelativePose",
     [](Scene& s) { s.scale_ratios[0].views.last = 10; },
     "$.lowlap.scale_ratios[views=7,4,10].views", "no relative pose"},
    {"RatioTwice",
     [](Scene& s) {
       s.scale_ratios.push_back(s.scale_ratios[0]);
       std::swap(s.scale_ratios[1].views.first, s.scale_ratios[1].views.last);
     },
     "$.lowlap.scale_ratios[views=1,4,7]", "twice"},
    {"RatioNan", [](Scene& s) { s.scale_ratios[0].log_ratio = kNan; },
     RATIO ".log_ratio", "finite"},
    {"RatioStddevInfinite",
     [](Scene& s) { s.scale_ratios[0].log_ratio_stddev = kInf; },
     RATIO ".log_ratio_stddev", "finite"},
    {"RatioStddevNegative",
     [](Scene& s) { s.scale_ratios[0].log_ratio_stddev = -1; },
     RATIO ".log_ratio_stddev", "negative"},
    {"RatioNfaNan", [](Scene& s) { s.scale_ratios[0].log10_nfa = kNan; },
     RATIO ".log10_nfa", "finite"},
    {"SupportNegativeCandidates",
     [](Scene& s) { s.scale_ratios[0].kinds[0].candidates = -1; },
     RATIO ".kinds[0].candidates", "negative"},
    {"SupportNegativeInliers",
     [](Scene& s) { s.scale_ratios[0].kinds[1].inliers = -1; },
     RATIO ".kinds[1].inliers", "negative"},
    {"SupportNfaInfinite",
     [](Scene& s) { s.scale_ratios[0].kinds[2].log10_nfa = -kInf; },
     RATIO ".kinds[2].log10_nfa", "finite"},
    {"SupportThresholdNan",
     [](Scene& s) { s.scale_ratios[0].kinds[2].threshold_px = kNan; },
     RATIO ".kinds[2].threshold_px", "finite"},
    {"SupportOfNoName", [](Scene& s) { s.scale_ratios[0].kinds[1].kind = ""; },
     RATIO ".kinds[1].kind", "empty"},
    {"SupportTwice",
     [](Scene& s) { s.scale_ratios[0].kinds[1].kind = "points"; },
     RATIO ".kinds[1]", "twice"},
    {"SupportOfNoAgreement",
     [](Scene& s) { s.scale_ratios[0].kinds[0].min_agreeing = 0; },
     RATIO ".kinds[0].min_agreeing", "at least 1"},
    {"RatioRejectedNegative",
     [](Scene& s) { s.scale_ratios[0].num_rejected_negative = -1; },
     RATIO ".num_rejected_negative", "negative"},
    {"CoplanarInlierOfUnknownSegment",
     [](Scene& s) { s.scale_ratios[0].coplanar_inliers[1].line_in_last = 6; },
     RATIO ".coplanar_inliers[3]", "only 6 segments"},
    {"LineDirectionNotUnit",
     [](Scene& s) { s.line_structure[2].line.direction *= 2; },
     LINE ".direction", "unit"},
    {"LineMomentNan",
     [](Scene& s) { s.line_structure[2].line.moment.x() = kNan; },
     LINE ".moment", "finite"},
    {"LineMomentNotOrthogonal",
     [](Scene& s) {
       s.line_structure[2].line.moment +=
           1e-4 * s.line_structure[2].line.direction;
     },
     LINE ".moment", "orthogonal"},
    {"LineStartNan", [](Scene& s) { s.line_structure[2].start.y() = kNan; },
     LINE ".start", "finite"},
    {"LineEndInfinite", [](Scene& s) { s.line_structure[2].end.y() = kInf; },
     LINE ".end", "finite"},
    {"LineObservationOfUnknownSegment",
     [](Scene& s) { s.line_structure[2].observations[0].feature = 6; },
     LINE ".observations[1]", "has only 6"},
    {"LineObservedOnce",
     [](Scene& s) { s.line_structure[2].observations.resize(1); },
     LINE ".observations", "two observations"},
    {"UnrelatedPairOfUnknownView",
     [](Scene& s) {
       s.unrelated_pairs.push_back({5, 7});
     },
     "$.lowlap.unrelated_pairs[4]", "5"},
    {"UnrelatedPairUnordered",
     [](Scene& s) {
       s.unrelated_pairs.push_back({10, 4});
     },
     "$.lowlap.unrelated_pairs[4]", "smaller id"},
    {"UnrelatedPairTwice",
     [](Scene& s) {
       s.unrelated_pairs.push_back({4, 10});
     },
     "$.lowlap.unrelated_pairs[4]", "ascend"},
    {"UnrelatedPairWithARelativePose",
     [](Scene& s) {
       s.unrelated_pairs.insert(s.unrelated_pairs.begin(), {1, 4});
     },
     "$.lowlap.unrelated_pairs[0]", "has a relative pose"},
    {"CoplanarPairOfUnknownLine",
     [](Scene& s) {
       s.coplanar_pairs.push_back({2, 9});
     },
     "$.lowlap.coplanar_pairs[3]", "no line 9"},
    {"CoplanarPairUnordered",
     [](Scene& s) {
       s.coplanar_pairs.push_back({3, 2});
     },
     "$.lowlap.coplanar_pairs[2]", "smaller id"},
    {"CoplanarPairOfOneLine",
     [](Scene& s) {
       s.coplanar_pairs.push_back({3, 3});
     },
     "$.lowlap.coplanar_pairs[2]", "smaller id"},
    {"CoplanarPairTwice",
     [](Scene& s) {
       s.coplanar_pairs.push_back({2, 3});
     },
     "$.lowlap.coplanar_pairs[2]", "twice"},
};

const auto kCaseName = [](const ::testing::TestParamInfo<Case>& info) {
  return std::string(info.param.name);
};
INSTANTIATE_TEST_SUITE_P(Cameras, ValidateSceneCase,
                         ::testing::ValuesIn(kCameraCases), kCaseName);
INSTANTIATE_TEST_SUITE_P(Measurements, ValidateSceneCase,
                         ::testing::ValuesIn(kMeasurementCases), kCaseName);
INSTANTIATE_TEST_SUITE_P(Solution, ValidateSceneCase,
                         ::testing::ValuesIn(kSolutionCases), kCaseName);

TEST(ValidateScene, AcceptsValidScenes) {
  EXPECT_THAT(ValidateScene(Scene()), IsOk());
  EXPECT_THAT(ValidateScene(FullScene()), IsOk());
  EXPECT_THAT(ValidateScene(testing::RandomScene(1, 10, 200, 50)), IsOk());
}

TEST(ValidateScene, ToleratesSmallRoundingOfRotations) {
  Scene scene = FullScene();
  scene.poses[101].rotation(0, 0) += 1e-8;
  Edge(scene).direction *= 1 + 1e-8;
  EXPECT_THAT(ValidateScene(scene), IsOk());
}

// What OpenMVG's partial exports hold.
TEST(ValidateScene, ToleratesLandmarksOfUnposedViews) {
  Scene scene = FullScene();
  scene.poses.clear();
  EXPECT_THAT(ValidateScene(scene), IsOk());
}

TEST(ValidateScene, ToleratesFeatureIndicesWithoutFeatures) {
  Scene scene = FullScene();
  scene.structure[9].observations[2].feature = 1000000;  // view 13 has none
  EXPECT_THAT(ValidateScene(scene), IsOk());
}

TEST(ValidateScene, ToleratesSegmentsOfALineTrackInAnyOrderWithinAView) {
  Scene scene = FullScene();
  std::swap(scene.line_tracks[2][1], scene.line_tracks[2][2]);
  EXPECT_THAT(ValidateScene(scene), IsOk());
}

TEST(ValidateScene, AcceptsEveryLengthOfUtf8) {
  Scene scene = FullScene();
  scene.root_path =
      "a\xC2\x80\xE0\xA0\x80\xEF\xBF\xBF\xF0\x90\x80\x80\xF4\x8F\xBF\xBF";
  EXPECT_THAT(ValidateScene(scene), IsOk());
}

}  // namespace
}  // namespace lowlap
