// OpenMVG's files and conventions in the text form.
#include <gtest/gtest.h>

#include "io/worked_example.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::OpenMvgWorkedExample;
using testing::Replaced;
using testing::VectorNear;

TEST(OpenMvgJson, ReadsTheWorkedExample) {
  const std::string text = OpenMvgWorkedExample();
  ASSERT_EQ(text.size(), 4245u);  // as OpenMVG wrote it
  const Result<Scene> read = ParseSceneJson(text);
  ASSERT_THAT(read, IsOk());
  const Scene& scene = *read;
  EXPECT_EQ(scene.root_path, "/data/images");
  ASSERT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(scene.ImagePath(1), "/data/images/sub/b.jpg");
  EXPECT_EQ(scene.views.at(0).width_px, 640);
  EXPECT_EQ(scene.views.at(1).pose_id, 1u);
  const Intrinsic& intrinsic = scene.intrinsics.at(0);
  EXPECT_EQ(intrinsic.model, CameraModel::kRadialK3);
  EXPECT_EQ(intrinsic.fx_px, 500);
  EXPECT_EQ(intrinsic.fy_px, 500);
  EXPECT_EQ(intrinsic.distortion, (std::vector<double>{-0.1, 0.01, 0}));
  EXPECT_EQ(scene.poses.at(1).center, Vec3(-3, 0, 1));
  EXPECT_EQ(scene.poses.at(1).rotation(0, 2), -0.6);
  // Sorted by view, whatever the order of the file.
  const Landmark& landmark = scene.structure.at(0);
  ASSERT_EQ(landmark.observations.size(), 2u);
  EXPECT_EQ(landmark.observations[0].view, 0u);
  EXPECT_EQ(landmark.observations[0].feature, 7u);
  for (const PointObservation& observation : landmark.observations) {
    const Vec3 in_cam =
        scene.FindPose(observation.view)->CamFromWorld() * landmark.position;
    EXPECT_THAT(intrinsic.Project(in_cam),
                VectorNear(observation.pixel_px, 1e-6));
  }
  EXPECT_TRUE(scene.relative_poses.empty());
}

TEST(OpenMvgJson, OldVersions) {
  std::string text = Replaced(OpenMvgWorkedExample(), "\"0.3\"", "\"0.2\"");
  EXPECT_THAT(ParseSceneJson(text), IsOk());
  // Views were not polymorphic before 0.3 ...
  const std::string id = "\"polymorphic_id\": 1073741824,";
  const std::string plain = Replaced(Replaced(text, id, ""), id, "");
  EXPECT_THAT(ParseSceneJson(plain), IsOk());
  EXPECT_EQ(*ParseSceneJson(plain), *ParseSceneJson(text));
  EXPECT_THAT(
      ParseSceneJson(Replaced(plain, "\"0.2\"", "\"0.3\"")),
      IsError(ErrorCode::kParse, "$.views[key=1]: key \"polymorphic_id\""));
  // ... and there were no control points before 0.2.
  const std::string oldest = Replaced(Replaced(plain, "\"0.2\"", "\"0.1\""),
                                      ",\n    \"control_points\": []", "");
  EXPECT_EQ(*ParseSceneJson(oldest), *ParseSceneJson(text));
  EXPECT_THAT(ParseSceneJson(Replaced(oldest, "\"0.1\"", "\"0.2\"")),
              IsError(ErrorCode::kParse, "\"control_points\" is missing"));
}

// The sequence of ids that OpenMVG writes when types repeat.
TEST(OpenMvgJson, TypeAndPointerIdsAreReadAndWritten) {
  const auto view = [](int id, const std::string& polymorphic, unsigned ptr,
                       const std::string& prior) {
    const std::string key = std::to_string(id);
    return "{\"key\": " + key + ", \"value\": {" + polymorphic +
           ", \"ptr_wrapper\": {\"id\": " + std::to_string(ptr) +
           ", \"data\": {\"local_path\": \"\", \"filename\": \"f\", "
           "\"width\": 10, \"height\": 20, \"id_view\": " +
           key + ", \"id_intrinsic\": " + key + ", \"id_pose\": " + key +
           prior + "}}}}";
  };
  const auto intrinsic = [](int id, const std::string& polymorphic,
                            unsigned ptr, const std::string& data) {
    return "{\"key\": " + std::to_string(id) + ", \"value\": {" + polymorphic +
           ", \"ptr_wrapper\": {\"id\": " + std::to_string(ptr) +
           ", \"data\": {" + data + "}}}}";
  };
  const std::string prior =
      ", \"use_pose_center_prior\": true, \"center_weight\": [1.0, 1.0, 1.0], "
      "\"center\": [1.5, 2.0, 3.0]";
  const std::string camera =
      "\"width\": 10, \"height\": 20, \"focal_length\": 5.0, "
      "\"principal_point\": [5.0, 10.0]";
  const std::string text =
      "{\n\"sfm_data_version\": \"0.3\",\n\"root_path\": \"\",\n\"views\": "
      "[\n" +
      view(0, "\"polymorphic_id\": 1073741824", 2147483649u, "") + ",\n" +
      view(1,
           "\"polymorphic_id\": 2147483649, \"polymorphic_name\": "
           "\"view_priors\"",
           2147483650u, prior) +
      ",\n" + view(2, "\"polymorphic_id\": 1", 2147483651u, prior) +
      "\n],\n\"intrinsics\": [\n" +
      intrinsic(0,
                "\"polymorphic_id\": 2147483650, \"polymorphic_name\": "
                "\"pinhole\"",
                2147483652u, camera) +
      ",\n" +
      intrinsic(1,
                "\"polymorphic_id\": 2147483651, \"polymorphic_name\": "
                "\"spherical\"",
                2147483653u, "\"value0\": {\"width\": 10, \"height\": 20}") +
      ",\n" + intrinsic(2, "\"polymorphic_id\": 2", 2147483654u, camera) +
      "\n],\n\"extrinsics\": [],\n\"structure\": [],\n\"control_points\": "
      "[],\n";
  const Result<Scene> scene = ParseSceneJson(Replaced(
      text + "}", "\"control_points\": [],\n", "\"control_points\": []\n"));
  ASSERT_THAT(scene, IsOk());
  EXPECT_FALSE(scene->views.at(0).center_prior);
  ASSERT_TRUE(scene->views.at(2).center_prior);
  EXPECT_EQ(scene->views.at(2).center_prior->center_in_world, Vec3(1.5, 2, 3));
  EXPECT_EQ(scene->intrinsics.at(1).model, CameraModel::kSpherical);
  EXPECT_EQ(scene->intrinsics.at(2), scene->intrinsics.at(0));
  const Result<std::string> written = FormatSceneJson(*scene);
  ASSERT_THAT(written, IsOk());
  EXPECT_EQ(written->substr(0, text.size()), text);
}

TEST(OpenMvgJson, SharedPointersAreFollowed) {
  std::string text = OpenMvgWorkedExample();
  text = Replaced(text, "\"intrinsics\": [",
                  "\"intrinsics\": [{\"key\": 5, \"value\": {"
                  "\"polymorphic_id\": 2147483649, \"polymorphic_name\": "
                  "\"pinhole\", \"ptr_wrapper\": {\"id\": 2147483651, "
                  "\"data\": {\"width\": 640, \"height\": 480, "
                  "\"focal_length\": 700, \"principal_point\": [1, 2]}}}},");
  text = Replaced(text, "\"id_intrinsic\": 0", "\"id_intrinsic\": 5");
  // The second intrinsic is the same object again.
  const std::size_t begin = text.find("\"polymorphic_id\": 2147483649,\n");
  const std::size_t end = text.find("\"extrinsics\"");
  text = text.substr(0, begin) +
         "\"polymorphic_id\": 1, \"ptr_wrapper\": {\"id\": 3}}}],\n" +
         text.substr(end);
  const Result<Scene> scene = ParseSceneJson(text);
  ASSERT_THAT(scene, IsOk());
  EXPECT_EQ(scene->intrinsics.at(0), scene->intrinsics.at(5));
  EXPECT_EQ(scene->intrinsics.at(0).fx_px, 700);
  EXPECT_THAT(ParseSceneJson(Replaced(text, "\"id\": 3}", "\"id\": 9}")),
              IsError(ErrorCode::kParse, "was not given before"));
  EXPECT_THAT(ParseSceneJson(Replaced(text, "\"polymorphic_id\": 1, ",
                                      "\"polymorphic_id\": 7, ")),
              IsError(ErrorCode::kParse, "was not given before"));
}

TEST(OpenMvgJson, PriorThatIsNotInUseIsNoPrior) {
  const std::string text = Replaced(
      OpenMvgWorkedExample(), "\"polymorphic_id\": 1073741824,",
      "\"polymorphic_id\": 2147483649, \"polymorphic_name\": \"view_priors\",");
  const Result<Scene> scene = ParseSceneJson(text);
  ASSERT_THAT(scene, IsOk());
  EXPECT_FALSE(scene->views.at(1).center_prior);
}

TEST(OpenMvgJson, ExportWithoutIntrinsicsOrPoses) {
  std::string text = OpenMvgWorkedExample();
  const std::size_t begin = text.find("\"intrinsics\"");
  const std::size_t end = text.find("\"structure\"");
  text = text.substr(0, begin) + "\"intrinsics\": [], \"extrinsics\": [],\n" +
         text.substr(end);
  const Result<Scene> scene = ParseSceneJson(text);
  ASSERT_THAT(scene, IsOk());
  EXPECT_EQ(scene->views.at(0).intrinsic_id, kInvalidId);
  EXPECT_EQ(scene->views.at(1).pose_id, 1u);  // unposed, but the id stays
  EXPECT_EQ(scene->structure.size(), 1u);
}

TEST(OpenMvgJson, IgnoresExtraKeysAndKeyOrder) {
  std::string text = Replaced(OpenMvgWorkedExample(), "\"root_path\"",
                              "\"vendor\": {\"any\": [null]}, \"root_path\"");
  text = Replaced(text, "\"width\": 640,", "");
  text = Replaced(text, "\"id_pose\": 1", "\"id_pose\": 1, \"width\": 640");
  EXPECT_EQ(*ParseSceneJson(text), *ParseSceneJson(OpenMvgWorkedExample()));
}

TEST(OpenMvgJson, TwoFocalLengthsKeepTheirGeometricMeanForOpenMvg) {
  Result<Scene> scene = ParseSceneJson(OpenMvgWorkedExample());
  ASSERT_THAT(scene, IsOk());
  scene->intrinsics[0].fx_px = 400;
  scene->intrinsics[0].fy_px = 625;
  const Result<std::string> text = FormatSceneJson(*scene);
  ASSERT_THAT(text, IsOk());
  EXPECT_THAT(*text,
              ::testing::HasSubstr("\"focal_length\": 500.0, \"fx\": 400.0, "
                                   "\"fy\": 625.0, \"principal_point\""));
  EXPECT_EQ(*ParseSceneJson(*text), *scene);
  // A file in which someone changed one of them only.
  EXPECT_THAT(ParseSceneJson(Replaced(*text, "\"focal_length\": 500.0",
                                      "\"focal_length\": 510.0")),
              IsError(ErrorCode::kInvalidScene,
                      "$.intrinsics[key=0].focal_length: must be the"));
  EXPECT_THAT(ParseSceneJson(Replaced(*text, ", \"fy\": 625.0", "")),
              IsError(ErrorCode::kParse, "\"fy\" is missing"));
}

}  // namespace
}  // namespace lowlap
