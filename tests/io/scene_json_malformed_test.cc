#include <gtest/gtest.h>

#include "io/worked_example.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::FullScene;
using testing::Replaced;

struct Case {
  const char* name;
  const char* from;
  const char* to;
  ErrorCode code;
  const char* place;
  const char* message;
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

void ExpectError(const std::string& text, const Case& c) {
  const Result<Scene> scene = ParseSceneJson(text, "scene.json");
  ASSERT_FALSE(scene.has_value());
  EXPECT_EQ(scene.error().code, c.code) << scene.error().ToString();
  EXPECT_EQ(scene.error().file, "scene.json");
  EXPECT_EQ(scene.error().place, c.place) << scene.error().message;
  EXPECT_THAT(scene.error().message, ::testing::HasSubstr(c.message));
}

const auto kCaseName = [](const ::testing::TestParamInfo<Case>& info) {
  return std::string(info.param.name);
};

// OpenMVG's part, damaged in the worked example.
class MalformedOpenMvgPart : public ::testing::TestWithParam<Case> {};

TEST_P(MalformedOpenMvgPart, IsAnErrorWithItsPlace) {
  ExpectError(
      Replaced(testing::OpenMvgWorkedExample(), GetParam().from, GetParam().to),
      GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    , MalformedOpenMvgPart,
    ::testing::Values(
        Case{"UnknownVersion", "\"0.3\"", "\"0.4\"", ErrorCode::kUnsupported,
             "$.sfm_data_version", "\"0.4\""},
        Case{"VersionIsANumber", "\"0.3\"", "0.3", ErrorCode::kParse,
             "$.sfm_data_version", "must be a string"},
        Case{"NoVersion", "\"sfm_data_version\"", "\"version\"",
             ErrorCode::kParse, "$", "\"sfm_data_version\" is missing"},
        Case{"NoStructure", "\"structure\"", "\"structures\"",
             ErrorCode::kParse, "$", "\"structure\" is missing"},
        Case{"ViewsAreAnObject", "\"views\": [", "\"views\": {}, \"x\": [",
             ErrorCode::kParse, "$.views", "must be an array"},
        Case{"ViewIsANumber", "\"views\": [", "\"views\": [17,",
             ErrorCode::kParse, "$.views[0]", "must be an object"},
        Case{"RepeatedKey", "\"height\": 480,", "\"width\": 480,",
             ErrorCode::kParse, "$.views[key=1].width", "is repeated"},
        Case{"RepeatedViewId", "\"key\": 0,\n            \"value\"",
             "\"key\": 1,\n            \"value\"", ErrorCode::kInvalidScene,
             "$.views[key=1].id_view", "must equal the key 1"},
        Case{"NegativeId", "\"id_intrinsic\": 0", "\"id_intrinsic\": -3",
             ErrorCode::kParse, "$.views[key=1].id_intrinsic", "not -3"},
        Case{"TooLargeId", "\"id_pose\": 1", "\"id_pose\": 4294967296",
             ErrorCode::kParse, "$.views[key=1].id_pose", "not 4294967296"},
        Case{"FarTooLargeId", "\"id_pose\": 1",
             "\"id_pose\": 99999999999999999999", ErrorCode::kParse,
             "$.views[key=1].id_pose", "must be an integer"},
        Case{"FractionalId", "\"id_pose\": 1", "\"id_pose\": 1.5",
             ErrorCode::kParse, "$.views[key=1].id_pose", "must be an integer"},
        Case{"TooLargeWidth", "\"width\": 640", "\"width\": 2147483648",
             ErrorCode::kParse, "$.views[key=1].width", "not 2147483648"},
        Case{"KeyIsAString", "\"key\": 1,", "\"key\": \"1\",",
             ErrorCode::kParse, "$.views[0].key", "must be an integer"},
        Case{"ViewIdDiffersFromKey", "\"id_view\": 1", "\"id_view\": 2",
             ErrorCode::kInvalidScene, "$.views[key=1].id_view",
             "must equal the key 1"},
        Case{"NoFilename", "\"filename\": \"b.jpg\",", "", ErrorCode::kParse,
             "$.views[key=1]", "\"filename\" is missing"},
        Case{"FilenameIsNull", "\"b.jpg\"", "null", ErrorCode::kParse,
             "$.views[key=1].filename", "must be a string"},
        Case{"NullPointerType", "1073741824", "0", ErrorCode::kParse,
             "$.views[key=1].polymorphic_id", "null pointer"},
        Case{"NullPointer", "\"id\": 2147483649", "\"id\": 0",
             ErrorCode::kParse, "$.views[key=1].id", "null pointer"},
        Case{"NoPointerData", "\"data\"", "\"date\"", ErrorCode::kParse,
             "$.views[key=1]", "\"data\" is missing"},
        Case{"UnknownViewType", "\"polymorphic_id\": 1073741824",
             "\"polymorphic_id\": 2147483649, \"polymorphic_name\": "
             "\"view_3d\"",
             ErrorCode::kUnsupported, "$.views[key=1]", "view_3d"},
        Case{"UnknownCameraModel", "pinhole_radial_k3", "pinhole_k9",
             ErrorCode::kUnsupported, "$.intrinsics[key=0]", "pinhole_k9"},
        Case{"IntrinsicWithoutName", "\"polymorphic_name\"", "\"name\"",
             ErrorCode::kParse, "$.intrinsics[key=0]",
             "\"polymorphic_name\" is missing"},
        Case{"PrincipalPointTooLong", "320.0,", "320.0, 1.0,",
             ErrorCode::kParse, "$.intrinsics[key=0].principal_point",
             "must have 2 elements, not 3"},
        Case{"DistortionTooShort", "-0.1,", "", ErrorCode::kParse,
             "$.intrinsics[key=0].disto_k3", "must have 3 elements, not 2"},
        Case{"NoDistortion", "\"disto_k3\"", "\"disto_k1\"", ErrorCode::kParse,
             "$.intrinsics[key=0]", "\"disto_k3\" is missing"},
        Case{"FocalIsAString", "500.0", "\"500\"", ErrorCode::kParse,
             "$.intrinsics[key=0].focal_length", "must be a number"},
        Case{"FocalIsNegative", "500.0", "-500.0", ErrorCode::kInvalidScene,
             "$.intrinsics[key=0]", "focal length"},
        Case{"DanglingIntrinsic", "\"id_intrinsic\": 0", "\"id_intrinsic\": 7",
             ErrorCode::kInvalidScene, "$.views[key=1].id_intrinsic",
             "no intrinsic 7"},
        Case{"OrphanPose", "\"id_pose\": 1", "\"id_pose\": 8",
             ErrorCode::kInvalidScene, "$.extrinsics[key=1]", "no view uses"},
        Case{"RotationIsFlat", "\"rotation\": [", "\"rotation\": [1.0,",
             ErrorCode::kParse, "$.extrinsics[key=1].rotation[0]",
             "must be an array"},
        Case{"NotARotation", "0.8,", "0.9,", ErrorCode::kInvalidScene,
             "$.extrinsics[key=1].rotation", "not a rotation"},
        Case{"PoseWithoutCenter", "\"center\"", "\"centre\"", ErrorCode::kParse,
             "$.extrinsics[key=1]", "\"center\" is missing"},
        Case{"RepeatedPose", "\"extrinsics\": [",
             "\"extrinsics\": [{\"key\": 1, \"value\": {\"rotation\": "
             "[[1,0,0],[0,1,0],[0,0,1]], \"center\": [0,0,0]}},",
             ErrorCode::kInvalidScene, "$.extrinsics[key=1].key",
             "id 1 is repeated"},
        Case{"LandmarkWithoutPosition", "\"X\"", "\"Y\"", ErrorCode::kParse,
             "$.structure[key=0]", "\"X\" is missing"},
        Case{"ObservationOfUnknownView",
             "\"key\": 1,\n                        \"value\"",
             "\"key\": 2,\n                        \"value\"",
             ErrorCode::kInvalidScene, "$.structure[key=0].observations[key=2]",
             "no view 2"},
        Case{"ViewObservedTwice",
             "\"key\": 1,\n                        \"value\"",
             "\"key\": 0,\n                        \"value\"",
             ErrorCode::kInvalidScene, "$.structure[key=0].observations[key=0]",
             "twice"},
        Case{"PixelWithoutY", "357.705982,", "", ErrorCode::kParse,
             "$.structure[key=0].observations[key=1].x",
             "must have 2 elements, not 1"},
        Case{"NanLiteral", "-3.0", "NaN", ErrorCode::kParse,
             "line 90, column 21",
             "NaN is not a finite number, at $.extrinsics[key=1].center[0]"},
        Case{"MinusInfinityLiteral", "357.705982", "-Infinity",
             ErrorCode::kParse, "line 139, column 34",
             "-Infinity is not a finite number, at "
             "$.structure[key=0].observations[key=1].x[0]"},
        Case{"InfinityLiteral", "500.0", "Infinity", ErrorCode::kParse,
             "line 53, column 41",
             "Infinity is not a finite number, at "
             "$.intrinsics[key=0].focal_length"},
        Case{"NumberOverflows", "-3.0", "-3.0e999", ErrorCode::kParse,
             "line 90, column 28", "number overflow"},
        Case{"CommaIsMissing", "\"width\": 640,", "\"width\": 640",
             ErrorCode::kParse, "line 15, column 32", "expected '}'"},
        Case{"NotUtf8", "b.jpg", "\xFF.jpg", ErrorCode::kParse,
             "line 13, column 38", "invalid string"},
        Case{"SomethingFollows", "\"control_points\": []\n}",
             "\"control_points\": []\n} x", ErrorCode::kParse,
             "line 159, column 3", "expected end of input"},
        Case{"OwnPartIsAString", "\"root_path\"",
             "\"lowlap\": \"1\", \"root_path\"", ErrorCode::kParse, "$.lowlap",
             "must be an object"},
        Case{"OwnVersionMissing", "\"root_path\"",
             "\"lowlap\": {}, \"root_path\"", ErrorCode::kParse, "$.lowlap",
             "\"version\" is missing"},
        Case{"OwnVersionUnknown", "\"root_path\"",
             "\"lowlap\": {\"version\": 9}, \"root_path\"",
             ErrorCode::kUnsupported, "$.lowlap.version", "version 9"}),
    kCaseName);

// lowlap's part, damaged in the full scene.
class MalformedOwnPart : public ::testing::TestWithParam<Case> {};

TEST_P(MalformedOwnPart, IsAnErrorWithItsPlace) {
  const Result<std::string> text = FormatSceneJson(FullScene());
  ASSERT_TRUE(text.has_value());
  ExpectError(Replaced(*text, GetParam().from, GetParam().to), GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    , MalformedOwnPart,
    ::testing::Values(
        Case{"UnknownSection", "\"relative_poses\"", "\"relative_pose\"",
             ErrorCode::kParse, "$.lowlap.relative_pose", "is not known"},
        Case{"UnknownMember", "\"segments\"", "\"lines\"", ErrorCode::kParse,
             "$.lowlap.features[view=1].lines", "is not known"},
        Case{"FeaturesTwice", "{\"view\": 4,", "{\"view\": 1,",
             ErrorCode::kInvalidScene, "$.lowlap.features[view=1].view",
             "repeated"},
        Case{"OddPoints", "{\"view\": 1, \"points\": [",
             "{\"view\": 1, \"points\": [1.0, ", ErrorCode::kParse,
             "$.lowlap.features[view=1].points", "a multiple of 2"},
        Case{"NestedPoints", "{\"view\": 1, \"points\": [",
             "{\"view\": 1, \"points\": [[1.0, 2.0], ", ErrorCode::kParse,
             "$.lowlap.features[view=1].points[0]", "must be a number"},
        Case{"PointIsAString", "{\"view\": 1, \"points\": [",
             "{\"view\": 1, \"points\": [1, \"2\", ", ErrorCode::kParse,
             "$.lowlap.features[view=1].points[1]", "must be a number"},
        Case{"ShapeTooShort", "\"point_covariances\": [",
             "\"point_covariances\": [1.0, ", ErrorCode::kParse,
             "$.lowlap.features[view=4].point_covariances", "a multiple of 3"},
        Case{"RepeatedNotAnIndex", "\"repeated_points\": [",
             "\"repeated_points\": [-1, ", ErrorCode::kParse,
             "$.lowlap.features[view=4].repeated_points[0]", "must be"},
        Case{"SegmentTooLong", "\"segments\": [", "\"segments\": [1.0, ",
             ErrorCode::kParse, "$.lowlap.features[view=1].segments",
             "a multiple of 5"},
        Case{"WeaknessUnknown", "\"weakness\": \"surroundings\"",
             "\"weakness\": \"sky\"", ErrorCode::kParse,
             "$.lowlap.relative_poses[views=1,4].weakness",
             "weakness \"sky\" is not known"},
        Case{"PairOfThree", "\"views\": [1, 4]", "\"views\": [1, 4, 7]",
             ErrorCode::kParse, "$.lowlap.relative_poses[views=1,4,7].views",
             "two view ids"},
        Case{"PairUnordered", "\"views\": [1, 4]", "\"views\": [4, 1]",
             ErrorCode::kInvalidScene,
             "$.lowlap.relative_poses[views=4,1].views", "smaller id"},
        Case{"PairTwice", "\"views\": [4, 7]", "\"views\": [1, 4]",
             ErrorCode::kInvalidScene, "$.lowlap.relative_poses[views=1,4]",
             "repeated"},
        Case{"NoDirection", "\"direction\"", "\"translation\"",
             ErrorCode::kParse,
             "$.lowlap.relative_poses[views=1,4].translation", "not known"},
        Case{"CovarianceOfNoPose", "{\"id\": 101, \"covariance\"",
             "{\"id\": 99, \"covariance\"", ErrorCode::kInvalidScene,
             "$.lowlap.center_covariances[id=99]", "there is no pose 99"},
        Case{"CenterCovarianceTooLarge", "{\"id\": 101, \"covariance\": [",
             "{\"id\": 101, \"covariance\": [[0, 0, 0], ", ErrorCode::kParse,
             "$.lowlap.center_covariances[id=101].covariance",
             "must have 3 elements, not 4"},
        Case{"CovarianceTooSmall", "\"covariance\": [[1e-05",
             "\"covariance\": [[0, 0, 0, 0], [1e-05", ErrorCode::kParse,
             "$.lowlap.relative_poses[views=1,4].covariance[0]",
             "must have 5 elements, not 4"},
        Case{"AlternativeOfUnknownMember", "\"alternatives\": [{",
             "\"alternatives\": [{\"score\": 1, ", ErrorCode::kParse,
             "$.lowlap.relative_poses[views=1,4].alternatives[0].score",
             "not known"},
        Case{"OddMatches", "\"point_inliers\": [", "\"point_inliers\": [0, ",
             ErrorCode::kParse,
             "$.lowlap.relative_poses[views=1,4].point_inliers",
             "a multiple of 2"},
        Case{"NegativeMatch", "\"point_inliers\": [0, 5",
             "\"point_inliers\": [0, -5", ErrorCode::kParse,
             "$.lowlap.relative_poses[views=1,4].point_inliers[1]", "not -5"},
        Case{"MatchBeyondFeatures", "\"point_inliers\": [0, 5",
             "\"point_inliers\": [0, 6", ErrorCode::kInvalidScene,
             "$.lowlap.relative_poses[views=1,4].point_inliers[1]",
             "has only 6"},
        Case{"TrackTwice", "{\"id\": 4000000000", "{\"id\": 0",
             ErrorCode::kInvalidScene, "$.lowlap.point_tracks[id=0].id",
             "id 0 is repeated"},
        Case{"TrackOfUnknownFeature", "\"observations\": [1, 0, 4, 5]",
             "\"observations\": [1, 0, 4, 55]", ErrorCode::kInvalidScene,
             "$.lowlap.point_tracks[id=0].observations[3]", "has only 6"},
        Case{"TripletOfTwo", "\"views\": [7, 4, 1]", "\"views\": [7, 4]",
             ErrorCode::kParse, "$.lowlap.scale_ratios[views=7,4].views",
             "three view ids"},
        Case{"UnknownVerdict", "\"meaningful\"", "\"maybe\"", ErrorCode::kParse,
             "$.lowlap.scale_ratios[views=7,4,1].verdict",
             "\"maybe\" is not known"},
        Case{"NegativeCount", "\"candidates\": 10", "\"candidates\": -10",
             ErrorCode::kParse,
             "$.lowlap.scale_ratios[views=7,4,1].kinds[0].candidates",
             "not -10"},
        Case{"SupportWithoutNfa", "\"inliers\": 8, \"log10_nfa\": -12.25,",
             "\"inliers\": 8,", ErrorCode::kParse,
             "$.lowlap.scale_ratios[views=7,4,1].kinds[0]",
             "\"log10_nfa\" is missing"},
        Case{"LineTwice", "{\"id\": 3, \"direction\"",
             "{\"id\": 2, \"direction\"", ErrorCode::kInvalidScene,
             "$.lowlap.line_structure[id=2].id", "id 2 is repeated"},
        Case{"OddCoplanarPairs", "\"coplanar_pairs\": [2, 3]",
             "\"coplanar_pairs\": [2, 3, 2]", ErrorCode::kParse,
             "$.lowlap.coplanar_pairs", "a multiple of 2"},
        Case{"CoplanarPairOfUnknownLine", "\"coplanar_pairs\": [2, 3]",
             "\"coplanar_pairs\": [2, 4]", ErrorCode::kInvalidScene,
             "$.lowlap.coplanar_pairs[1]", "no line 4"}),
    kCaseName);

TEST(ParseSceneJson, TruncationAtEveryByteIsAnError) {
  const Result<std::string> text = FormatSceneJson(FullScene());
  ASSERT_TRUE(text.has_value());
  // Without the newline at its end the text is complete.
  for (std::size_t size = 0; size + 1 < text->size(); ++size) {
    const Result<Scene> scene = ParseSceneJson(text->substr(0, size));
    ASSERT_FALSE(scene.has_value()) << size;
    ASSERT_EQ(scene.error().code, ErrorCode::kParse) << size;
    ASSERT_EQ(scene.error().place.substr(0, 5), "line ") << size;
  }
  EXPECT_TRUE(ParseSceneJson(text->substr(0, text->size() - 1)).has_value());
}

TEST(ParseSceneJson, DamageAtEveryByteNeverCrashes) {
  const Result<std::string> text = FormatSceneJson(FullScene());
  ASSERT_TRUE(text.has_value());
  int accepted = 0;
  for (std::size_t n = 0; n < text->size(); ++n) {
    for (const char byte : {'9', '"'}) {
      std::string damaged = *text;
      damaged[n] = byte;
      accepted += ParseSceneJson(damaged).has_value();
    }
  }
  EXPECT_GT(accepted, 0);  // a 9 in place of another digit
}

TEST(ParseSceneJson, DeepNestingIsNoRecursion) {
  const std::string deep(1000000, '[');
  EXPECT_FALSE(ParseSceneJson(deep).has_value());
  EXPECT_FALSE(
      ParseSceneJson("{\"x\":" + deep + std::string(1000000, ']') + "}")
          .has_value());
}

TEST(ParseSceneJson, RootMustBeAnObject) {
  for (const char* text : {"[]", "1", "null", "\"x\""}) {
    const Result<Scene> scene = ParseSceneJson(text);
    ASSERT_FALSE(scene.has_value());
    EXPECT_EQ(scene.error().place, "$");
    EXPECT_EQ(scene.error().message, "must be an object");
  }
}

}  // namespace
}  // namespace lowlap
