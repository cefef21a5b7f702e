// Reads the scenes that OpenMVG wrote for real photographs.
#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/io/internal/scene_binary.h"
#include "support/data_folder.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsOk;

class RealFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (DataFolder().empty()) GTEST_SKIP() << "skipped: no data";
  }
  static std::string Path(const std::string& name) {
    return DataFolder() + "/openmvg/" + name;
  }
};

TEST_F(RealFilesTest, ListingsAndSolutionsOfOpenMvg) {
  const struct {
    const char* name;
    std::size_t views, poses;
  } kFiles[] = {
      {"fountain-P11/matches/sfm_data.json", 11, 0},
      {"fountain-P11/global/sfm_data_poses.json", 11, 11},
      {"Herz-Jesus-P8/matches/sfm_data.json", 8, 0},
      {"Herz-Jesus-P8/global/sfm_data_poses.json", 8, 8},
      {"castle-P19/matches/sfm_data.json", 19, 0},
      {"castle-P19/global/sfm_data_poses.json", 19, 19},
      {"castle-P19_without_3_9_14/sfm_data.json", 16, 0},
      {"castle-P19_without_3_9_14/global_poses.json", 16, 16},
  };
  for (const auto& file : kFiles) {
    const Result<Scene> scene = ReadSceneJson(Path(file.name));
    ASSERT_THAT(scene, IsOk());
    EXPECT_EQ(scene->views.size(), file.views) << file.name;
    EXPECT_EQ(scene->poses.size(), file.poses) << file.name;
    EXPECT_EQ(scene->intrinsics.size(), 1u) << file.name;
    EXPECT_EQ(scene->intrinsics.at(0).fx_px, 2759.48) << file.name;
    EXPECT_EQ(*ParseSceneJson(*FormatSceneJson(*scene)), *scene);
  }
}

TEST_F(RealFilesTest, StructureReprojectsToItsPixels) {
  const Result<Scene> scene =
      ReadSceneJson(Path("Herz-Jesus-P8/global/sfm_data_all.json"));
  ASSERT_THAT(scene, IsOk());
  EXPECT_EQ(scene->structure.size(), 12766u);
  double sum = 0;
  std::size_t count = 0;
  for (const auto& [id, landmark] : scene->structure) {
    for (const PointObservation& observation : landmark.observations) {
      const Vec3 in_cam =
          scene->FindPose(observation.view)->CamFromWorld() * landmark.position;
      const Vec2 pixel_px =
          scene->FindIntrinsic(observation.view)->Project(in_cam);
      sum += (pixel_px - observation.pixel_px).squaredNorm();
      ++count;
    }
  }
  // OpenMVG drops what is worse than 4 px; its solution is far better.
  EXPECT_LT(std::sqrt(sum / static_cast<double>(count)), 1.0);
  EXPECT_EQ(*ParseSceneBinary(*FormatSceneBinary(*scene)), *scene);
}

}  // namespace
}  // namespace lowlap
