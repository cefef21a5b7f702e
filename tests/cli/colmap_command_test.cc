// Databases and models of COLMAP on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "adapters/colmap_database.h"
#include "cli_fixture.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;

/// A simulated room of eight views in a database: keypoints and matches, but no
/// relative pose, as COLMAP leaves it.
class ColmapCommand : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    SyntheticOptions options;
    options.num_views = 8;
    options.pairs = "window:3";
    options.points_per_wall = 60;
    options.lines_per_wall = 0;
    options.noise_px = 0.5;
    const SyntheticScene synthetic = *Simulate(options);
    const Scene& scene = synthetic.scene;
    ColmapDatabase file(Database(), ColmapDatabase::Version::k3_8);
    camera_ = scene.intrinsics.begin()->second;
    file.AddCamera(1, 1, camera_.width_px, camera_.height_px, Parameters());
    for (const auto& [id, features] : scene.features) {
      std::vector<float> keypoints;
      for (const Vec2& point : features.points_px) {
        keypoints.push_back(static_cast<float>(point.x() + 0.5));
        keypoints.push_back(static_cast<float>(point.y() + 0.5));
      }
      const int number = static_cast<int>(id.value()) + 1;
      file.AddImage(number, std::to_string(number) + ".jpg", 1, keypoints, 2);
    }
    for (const auto& [pair, pose] : scene.relative_poses) {
      std::vector<std::uint32_t> matches;
      for (const FeatureMatch& match : pose.point_inliers) {
        matches.insert(matches.end(), {match.first, match.second});
      }
      file.AddMatches(static_cast<int>(pair.first.value()) + 1,
                      static_cast<int>(pair.second.value()) + 1, matches);
    }
  }
  std::string Database() const { return Path("database.db"); }
  // Of camera_, in COLMAP's pixels.
  std::vector<double> Parameters() const {
    return {camera_.fx_px, camera_.fy_px, camera_.principal_point_px.x() + 0.5,
            camera_.principal_point_px.y() + 0.5};
  }

  // As COLMAP guesses them.
  void MakeFocalLengthWrong() {
    camera_.fx_px *= 1.2;
    camera_.fy_px *= 1.2;
    sqlite3* connection = nullptr;
    ASSERT_EQ(sqlite3_open(Database().c_str(), &connection), SQLITE_OK);
    const std::string change =
        "UPDATE cameras SET params = " + ColmapDatabase::Blob(Parameters());
    EXPECT_EQ(
        sqlite3_exec(connection, change.c_str(), nullptr, nullptr, nullptr),
        SQLITE_OK);
    sqlite3_close(connection);
  }

  Intrinsic camera_;
};

TEST_F(ColmapCommand, ModelsAreMergedByADatabase) {
  for (const char* part :
       {"1.jpg,2.jpg,3.jpg,4.jpg", "5.jpg,6.jpg,7.jpg,8.jpg"}) {
    const Outcome solved =
        Lowlap("solve " + Database() + " --exclude " + part + " -o " +
               Path(std::string("without") + part[0]));
    ASSERT_EQ(solved.exit_code, 0) << solved.output;
  }
  const std::string models = "merge " + Path("without1") + "/scene.lowlap " +
                             Path("without5") + "/scene.lowlap --no-adjust ";
  const Outcome merged =
      Lowlap(models + "--database " + Database() + " -o " + Path("merged"));
  ASSERT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_THAT(merged.output, HasSubstr("cameras placed: 8/8"));
  // As --scene takes it.
  ASSERT_EQ(Lowlap(models + "--scene " + Database() + " -o " + Path("same"))
                .exit_code,
            0);
  EXPECT_EQ(ReadText(Path("merged/scene.lowlap")),
            ReadText(Path("same/scene.lowlap")));
}

TEST_F(ColmapCommand, ADatabaseIsSolvedAndTheResultGoesBack) {
  const Outcome solved = Lowlap("solve " + Database() + " -o " + Path("out"));
  ASSERT_EQ(solved.exit_code, 0) << solved.output;
  EXPECT_THAT(solved.output, HasSubstr("cameras placed: 8/8"));
  const std::string scene = Path("out") + "/scene.lowlap";

  const Outcome inspected = Lowlap("inspect " + Database());
  EXPECT_EQ(inspected.exit_code, 0) << inspected.output;
  EXPECT_THAT(inspected.output, HasSubstr("views 8, intrinsics 1"));

  ASSERT_EQ(Lowlap("convert " + scene + " " + Path("model") + " --to colmap")
                .exit_code,
            0);
  const Outcome model = Lowlap("inspect " + Path("model"));
  EXPECT_THAT(model.output, HasSubstr("views 8, intrinsics 1, poses 8"));

  // Stored relative poses are the scene's, and are enough to solve it again.
  const Outcome stored = Lowlap("convert " + scene + " " + Database());
  ASSERT_EQ(stored.exit_code, 0) << stored.output;
  ASSERT_EQ(
      Lowlap("convert " + Database() + " " + Path("stored.lowlap")).exit_code,
      0);
  const Outcome again =
      Lowlap("solve " + Path("stored.lowlap") + " -o " + Path("again"));
  ASSERT_EQ(again.exit_code, 0) << again.output;
  EXPECT_THAT(again.output, HasSubstr("cameras placed: 8/8"));
}

TEST_F(ColmapCommand, AWrongFocalLengthIsRefinedAndViewsRelatedOnceMore) {
  MakeFocalLengthWrong();
  const Outcome solved = Lowlap("solve " + Database() +
                                " --refine-intrinsics focal -o " + Path("out"));
  ASSERT_EQ(solved.exit_code, 0) << solved.output;
  EXPECT_THAT(solved.output, HasSubstr("relative poses once more"));
  EXPECT_THAT(solved.output, HasSubstr("firm: 8"));
  const Outcome stored =
      Lowlap("convert " + Path("out/scene.lowlap") + " " + Database());
  EXPECT_EQ(stored.exit_code, 0) << stored.output;
  EXPECT_THAT(stored.output, HasSubstr("stay as they are: 1 of them up to "));
}

TEST_F(ColmapCommand, SoTheyAreForAMerge) {
  ASSERT_EQ(Lowlap("solve " + Database() + " --exclude 7.jpg,8.jpg -o " +
                   Path("part"))
                .exit_code,
            0);
  MakeFocalLengthWrong();
  const Outcome merged =
      Lowlap("merge " + Path("part") + "/scene.lowlap --database " +
             Database() + " --refine-intrinsics focal -o " + Path("out"));
  ASSERT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_THAT(merged.output, HasSubstr("relative poses once more"));
  EXPECT_THAT(merged.output, HasSubstr("cameras placed: 8/8"));
}

TEST_F(ColmapCommand, ViewsAreLeftOutByName) {
  const Outcome inspected =
      Lowlap("inspect " + Database() + " --exclude 3.jpg,4.jpg");
  EXPECT_EQ(inspected.exit_code, 0) << inspected.output;
  EXPECT_THAT(inspected.output, HasSubstr("views 6,"));
}

TEST_F(ColmapCommand, WhatIsWrongIsSaid) {
  const Outcome photographs = Lowlap("solve " + Database() + " --images " +
                                     Path("none") + " -o " + Path("out"));
  EXPECT_EQ(photographs.exit_code, 1);
  EXPECT_THAT(photographs.output, HasSubstr(Path("none") + "/1.jpg"));
  ASSERT_EQ(Lowlap("convert " + Database() + " " + Path("a.lowlap")).exit_code,
            0);
  const Outcome no_matches =
      Lowlap("solve " + Path("a.lowlap") + " --images . -o " + Path("out"));
  EXPECT_EQ(no_matches.exit_code, 1);
  EXPECT_THAT(no_matches.output, HasSubstr("--images goes with matches"));
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(Database().c_str(), &connection), SQLITE_OK);
  sqlite3_exec(connection, "UPDATE keypoints SET rows = 7 WHERE image_id = 2",
               nullptr, nullptr, nullptr);
  sqlite3_close(connection);
  const Outcome broken = Lowlap("solve " + Database() + " -o " + Path("out"));
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_THAT(broken.output, HasSubstr("table keypoints, image_id 2"));
  EXPECT_EQ(FilesIn("out"), 0u);
}

}  // namespace
}  // namespace lowlap
