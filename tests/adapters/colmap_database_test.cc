#include "adapters/colmap_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "adapters/temporary_folder.h"
#include "lowlap/geometry/internal/rotation.h"
#include "third_party_adapters/colmap/internal/database.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::colmap {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Version = ColmapDatabase::Version;

// A quarter turn about z, and a step along x: not unit, as a file may be.
const std::vector<double> kQuarterTurn = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
const std::vector<double> kStep = {2, 0, 0};

std::string PoseSql(const std::vector<double>& q,
                    const std::vector<double>& t) {
  return ", " + ColmapDatabase::Blob(q) + ", " + ColmapDatabase::Blob(t);
}

/// Three images of one camera, with 2, 4 and 6 columns of keypoints.
class ColmapDatabaseFile : public ::testing::Test {
 protected:
  std::string Path() const { return folder_.Path("database.db"); }

  void Fill(ColmapDatabase* database) {
    database->AddCamera(5, 1, 800, 600, {500, 510, 400, 300});
    database->AddImage(1, "left/a.jpg", 5, {10.5F, 20.25F, 30, 40}, 2);
    database->AddImage(2, "left/b.jpg", 5, {11, 21, 1, 0.5F, 31, 41, 1, 0}, 4);
    database->AddImage(
        9, "c.jpg", 5,
        {12, 22, 1, 0, 0, 1, 32, 42, 1, 0, 0, 1, 7, 8, 1, 0, 0, 1}, 6);
  }

  Database Read() {
    auto database = ReadDatabase(Path());
    EXPECT_TRUE(database.has_value()) << database.error().ToString();
    return database ? std::move(*database) : Database{};
  }
  Error ReadError() {
    auto database = ReadDatabase(Path());
    EXPECT_FALSE(database.has_value());
    return database ? Error{} : database.error();
  }

  TemporaryFolder folder_;
};

TEST_F(ColmapDatabaseFile, EveryVersionGivesTheSame) {
  for (const Version version : {Version::k3_6, Version::k3_8, Version::k4_0}) {
    std::filesystem::remove(Path());
    ColmapDatabase file(Path(), version);
    Fill(&file);
    file.AddMatches(1, 2, {0, 1, 1, 0});
    file.AddMatches(1, 9, {0, 2});
    file.AddMatches(2, 9, {});
    const std::string unset = version == Version::k3_6 ? ""
                              : version == Version::k4_0
                                  ? ", NULL, NULL"
                                  : PoseSql({0, 0, 0, 0}, {0, 0, 0});
    file.AddGeometry(1, 2, {1, 0}, 2, unset);
    file.AddGeometry(1, 9, {}, 1, unset);

    const Database read = Read();
    const Scene& scene = read.scene;
    ASSERT_EQ(scene.views.size(), 3u);
    EXPECT_EQ(scene.views.at(1).filename, "left/a.jpg");
    EXPECT_EQ(scene.views.at(9).intrinsic_id, 5u);
    EXPECT_EQ(scene.intrinsics.at(5).fy_px, 510);
    EXPECT_EQ(scene.intrinsics.at(5).principal_point_px, Vec2(399.5, 299.5));
    EXPECT_THAT(scene.features.at(1).points_px,
                ElementsAre(Vec2(10, 19.75), Vec2(29.5, 39.5)));
    EXPECT_THAT(scene.features.at(2).points_px,
                ElementsAre(Vec2(10.5, 20.5), Vec2(30.5, 40.5)));
    EXPECT_EQ(scene.features.at(9).points_px[2], Vec2(6.5, 7.5));
    ASSERT_EQ(read.matches.size(), 2u);
    EXPECT_THAT(read.matches.at({1, 2}), ElementsAre(FeatureMatch{1, 0}));
    EXPECT_THAT(read.matches.at({1, 9}), ElementsAre(FeatureMatch{0, 2}));
    EXPECT_THAT(read.relative_poses, IsEmpty());
    EXPECT_EQ(scene.unrelated_pairs, (std::vector<ViewPair>{{2, 9}}));
    EXPECT_THAT(read.notes, IsEmpty());
  }
}

// Not those of which verification left nothing, nor what has a pose of lines.
TEST_F(ColmapDatabaseFile, PairsWithoutAMatchWereComparedInVain) {
  ColmapDatabase file(Path(), Version::k3_8);
  Fill(&file);
  file.AddMatches(1, 2, {0, 0});
  file.AddMatches(1, 9, {});
  file.AddMatches(2, 9, {});
  const std::string unset = PoseSql({0, 0, 0, 0}, {0, 0, 0});
  file.AddGeometry(1, 2, {}, 0, unset);
  file.AddGeometry(1, 9, {}, 0, unset);
  file.AddGeometry(2, 9, {}, 2, PoseSql(kQuarterTurn, kStep));
  EXPECT_EQ(Read().scene.unrelated_pairs, (std::vector<ViewPair>{{1, 9}}));
  const auto scene = ReadScene(Path());
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  EXPECT_EQ(scene->unrelated_pairs, (std::vector<ViewPair>{{1, 9}}));
}

TEST_F(ColmapDatabaseFile, StoredPosesAreReadAndOnlyThose) {
  ColmapDatabase file(Path(), Version::k3_8);
  Fill(&file);
  file.AddGeometry(1, 2, {0, 0, 1, 1}, 2, PoseSql(kQuarterTurn, kStep));
  file.AddGeometry(1, 9, {0, 0}, 2, PoseSql({1, 0, 0, 0}, {0, 0, 0}));
  file.AddGeometry(2, 9, {0, 0}, 7, PoseSql(kQuarterTurn, kStep));
  const Database read = Read();
  ASSERT_EQ(read.relative_poses.size(), 1u);
  const RelativePose& pose = read.relative_poses.at({1, 2});
  const Mat3 turn = RotationFromAngleAxis(Vec3(0, 0, kPi / 2));
  EXPECT_LT((pose.rotation - turn).norm(), 1e-15);
  EXPECT_EQ(pose.direction, Vec3::UnitX());
  EXPECT_EQ(pose.point_inliers.size(), 2u);
  EXPECT_EQ(read.matches.size(), 2u);
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("1 pairs that COLMAP took")));

  // As a scene: with tracks of the pair that has a pose.
  SceneNotes notes;
  const auto scene = ReadScene(Path(), &notes);
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  EXPECT_EQ(scene->relative_poses.size(), 1u);
  EXPECT_EQ(scene->point_tracks.size(), 2u);
  EXPECT_THAT(notes,
              Contains(::testing::AllOf(HasSubstr("1 pairs without a stored"),
                                        HasSubstr("`lowlap solve`"))));
}

TEST_F(ColmapDatabaseFile, GuessedFocalLengthsAndUnknownImagesAreNoted) {
  ColmapDatabase file(Path(), Version::k4_0);
  Fill(&file);
  for (const int camera : {6, 7, 8}) {
    file.AddCamera(camera, 0, 800, 600, {960, 400, 300}, false);
  }
  file.AddImage(10, "d.jpg", 6, {1, 2}, 2);
  file.AddImage(11, "e.jpg", 7, {1, 2}, 2);
  file.AddMatches(1, 44, {0, 0});
  // No image has camera 8.
  EXPECT_THAT(Read().notes,
              ElementsAre(HasSubstr("1 pairs name images"),
                          HasSubstr("focal lengths of 2 cameras are COLMAP's "
                                    "guesses")));
}

TEST_F(ColmapDatabaseFile, InlierMatchesIsTheNameOfOld) {
  ColmapDatabase file(Path(), Version::k3_6);
  Fill(&file);
  file.Run("DROP TABLE two_view_geometries");
  file.Run(
      "CREATE TABLE inlier_matches(pair_id INTEGER PRIMARY KEY, rows "
      "INTEGER, cols INTEGER, data BLOB, config INTEGER)");
  file.Run("INSERT INTO inlier_matches VALUES(" + ColmapDatabase::PairId(1, 2) +
           ", 1, 2, " + ColmapDatabase::Blob(std::vector<std::uint32_t>{1, 1}) +
           ", 2)");
  EXPECT_THAT(Read().matches.at({1, 2}), ElementsAre(FeatureMatch{1, 1}));
}

TEST_F(ColmapDatabaseFile, WhatIsWrongIsNamedWithTableAndRow) {
  struct Case {
    const char* sql;
    ErrorCode code;
    const char* place;
    const char* message;
  };
  const std::string pair = ColmapDatabase::PairId(1, 2);
  const std::string pair_place = "table matches, pair_id " + pair;
  for (const Case& wrong :
       {Case{"DROP TABLE keypoints", ErrorCode::kInvalidScene,
             "table keypoints", "no such table"},
        {"UPDATE keypoints SET rows = 3 WHERE image_id = 2", ErrorCode::kParse,
         "table keypoints, image_id 2", "32 bytes"},
        {"UPDATE keypoints SET cols = 8, rows = 1 WHERE image_id = 2",
         ErrorCode::kInvalidScene, "table keypoints, image_id 2",
         "2, 4 or 6 columns"},
        {"UPDATE keypoints SET data = x'0000c07f0000c07f0000c07f0000c07f' "
         "WHERE image_id = 1",
         ErrorCode::kInvalidScene, "table keypoints, image_id 1", "not finite"},
        {"UPDATE cameras SET model = 7, params = zeroblob(40)",
         ErrorCode::kUnsupported, "table images, image_id 1",
         "camera 5 has model FOV"},
        {"UPDATE cameras SET params = zeroblob(31)", ErrorCode::kParse,
         "table cameras, camera_id 5", "cut off"},
        {"UPDATE cameras SET width = 'wide'", ErrorCode::kInvalidScene,
         "table cameras, camera_id 5", "width is not an integer"},
        {"UPDATE images SET camera_id = 6 WHERE image_id = 9",
         ErrorCode::kInvalidScene, "table images, image_id 9", "camera 6"},
        {"UPDATE matches SET data = x'0000000002000000'",
         ErrorCode::kInvalidScene, pair_place.c_str(),
         "keypoint 2 does not exist: image 2 has 2"},
        {"UPDATE matches SET pair_id = -5", ErrorCode::kInvalidScene,
         "table matches, pair_id -5", "no pair"},
        {"ALTER TABLE images RENAME COLUMN name TO title", ErrorCode::kParse,
         "table images", "no such column: name"}}) {
    SCOPED_TRACE(wrong.sql);
    std::filesystem::remove(Path());
    ColmapDatabase file(Path(), Version::k3_8);
    Fill(&file);
    file.AddMatches(1, 2, {0, 0});
    file.Run(wrong.sql);
    const Error error = ReadError();
    EXPECT_EQ(error.code, wrong.code) << error.ToString();
    EXPECT_EQ(error.file, Path());
    EXPECT_EQ(error.place, wrong.place);
    EXPECT_THAT(error.message, HasSubstr(wrong.message));
  }
}

TEST_F(ColmapDatabaseFile, TruncatedAndDamagedFilesNeverGiveAScene) {
  {
    ColmapDatabase file(Path(), Version::k3_8);
    Fill(&file);
    file.AddMatches(1, 2, {0, 0});
  }
  std::ifstream stream(Path(), std::ios::binary);
  std::stringstream content;
  content << stream.rdbuf();
  const std::string whole = content.str();
  for (std::size_t size = 0; size < whole.size(); size += 997) {
    folder_.Write("database.db", whole.substr(0, size));
    EXPECT_FALSE(ReadDatabase(Path()).has_value()) << size;
  }
  std::string damaged = whole;
  // All pages but the first, which holds the names of the tables.
  std::memset(damaged.data() + 4096, 0x5a, damaged.size() - 4096);
  folder_.Write("database.db", damaged);
  EXPECT_EQ(ReadError().code, ErrorCode::kParse);
}

TEST_F(ColmapDatabaseFile, ReadingLeavesTheFolderAsItIs) {
  {
    ColmapDatabase file(Path(), Version::k3_8);
    file.Run("PRAGMA journal_mode = WAL");
    Fill(&file);
  }
  Read();
  EXPECT_EQ(
      std::distance(std::filesystem::directory_iterator(folder_.Path()), {}),
      1);
}

TEST_F(ColmapDatabaseFile, AnyPathIsNoHostNorOption) {
  const std::string path = folder_.Path("50%25 of?mode=memory#1.db");
  {
    ColmapDatabase file(path, Version::k4_0);
    Fill(&file);
  }
  ASSERT_EQ(path[0], '/');
  for (const std::string slashes : {"", "/", "//"}) {
    const auto database = ReadDatabase(slashes + path);
    ASSERT_TRUE(database.has_value()) << database.error().ToString();
    EXPECT_EQ(database->scene.views.size(), 3u);
  }
}

TEST_F(ColmapDatabaseFile, WhatAWriterHasInItsLogIsRead) {
  ColmapDatabase file(Path(), Version::k3_8);
  file.Run("PRAGMA journal_mode = WAL");
  Fill(&file);
  EXPECT_EQ(Read().scene.views.size(), 3u);
}

/// Two posed pairs, the second of which the database orders the other way.
Scene MeasuredScene(const Scene& read) {
  Scene scene = read;
  // Ids of the scene's own, in another order than the database's.
  scene.views.clear();
  scene.features.clear();
  const std::vector<std::uint32_t> image_of = {9, 1, 2};
  for (std::uint32_t id = 0; id < 3; ++id) {
    scene.views[id] = read.views.at(image_of[id]);
    scene.views[id].pose_id = id;
    scene.features[id] = read.features.at(image_of[id]);
  }
  for (const ViewPair& views : {ViewPair{0, 1}, ViewPair{1, 2}}) {
    RelativePose pose;
    pose.views = views;
    pose.rotation = RotationFromAngleAxis(Vec3(0.1, -0.2, 0.3));
    pose.direction = Vec3(0.6, 0, -0.8);
    pose.point_inliers = {{0, 1}, {1, 0}};
    scene.relative_poses[views] = pose;
  }
  return scene;
}

TEST_F(ColmapDatabaseFile, RelativePosesGoInAndComeOut) {
  for (const Version version : {Version::k3_6, Version::k3_8, Version::k4_0}) {
    std::filesystem::remove(Path());
    {
      ColmapDatabase file(Path(), version);
      Fill(&file);
      file.AddMatches(2, 9, {0, 0});
      file.AddGeometry(2, 9, {0, 0}, 2,
                       version == Version::k3_6 ? "" : ", NULL, NULL");
    }
    const Scene scene = MeasuredScene(Read().scene);
    const auto notes = WriteScene(scene, Path(), "colmap-db");
    ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
    EXPECT_THAT(*notes, IsEmpty());

    const Database read = Read();
    ASSERT_EQ(read.relative_poses.size(), 2u);
    const RelativePose& same = read.relative_poses.at({1, 2});
    const RelativePose& wrote = scene.relative_poses.at({1, 2});
    EXPECT_LT((same.rotation - wrote.rotation).norm(), 1e-15);
    EXPECT_LT((same.direction - wrote.direction).norm(), 1e-15);
    EXPECT_EQ(same.point_inliers, wrote.point_inliers);
    // The other way: x_9 = R^T (x_1 - t).
    const RelativePose& swapped = read.relative_poses.at({1, 9});
    const RelativePose& original = scene.relative_poses.at({0, 1});
    EXPECT_LT((swapped.rotation - original.rotation.transpose()).norm(), 1e-15);
    EXPECT_LT(
        (swapped.direction + original.rotation.transpose() * original.direction)
            .norm(),
        1e-15);
    EXPECT_THAT(swapped.point_inliers,
                ElementsAre(FeatureMatch{0, 1}, FeatureMatch{1, 0}));
    // A pair that the scene has no pose of has no geometry any more, only the
    // matches before it.
    EXPECT_THAT(read.matches.at({2, 9}), ElementsAre(FeatureMatch{0, 0}));
    EXPECT_EQ(read.relative_poses.count({2, 9}), 0u);
  }
}

TEST_F(ColmapDatabaseFile, FundamentalMatricesAreOfColmapsPixels) {
  {
    ColmapDatabase file(Path(), Version::k3_8);
    Fill(&file);
  }
  const Scene scene = MeasuredScene(Read().scene);
  ASSERT_TRUE(WriteRelativePoses(scene, Path()).has_value());
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(Path().c_str(), &connection), SQLITE_OK);
  sqlite3_stmt* statement = nullptr;
  const std::string sql =
      "SELECT F, config FROM two_view_geometries WHERE pair_id = " +
      ColmapDatabase::PairId(1, 2);
  ASSERT_EQ(
      sqlite3_prepare_v2(connection, sql.c_str(), -1, &statement, nullptr),
      SQLITE_OK);
  ASSERT_EQ(sqlite3_step(statement), SQLITE_ROW);
  ASSERT_EQ(sqlite3_column_bytes(statement, 0), 72);
  EXPECT_EQ(sqlite3_column_int(statement, 1), 2);
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> f;
  std::memcpy(f.data(), sqlite3_column_blob(statement, 0), 72);
  sqlite3_finalize(statement);
  sqlite3_close(connection);
  // A point in front of both cameras, in pixels whose corner is (0, 0).
  const RelativePose& pose = scene.relative_poses.at({1, 2});
  const Intrinsic& camera = scene.intrinsics.at(5);
  const Vec3 in_first(0.4, -0.3, 5);
  const Vec2 first = camera.Project(in_first) + Vec2(0.5, 0.5);
  const Vec2 second =
      camera.Project(pose.Cam2FromCam1() * in_first) + Vec2(0.5, 0.5);
  const double error = second.homogeneous().dot(f * first.homogeneous());
  EXPECT_LT(std::abs(error) / f.norm(), 1e-9);
}

TEST_F(ColmapDatabaseFile, SaysThatOtherCamerasStay) {
  {
    ColmapDatabase file(Path(), Version::k3_8);
    Fill(&file);
  }
  Scene scene = MeasuredScene(Read().scene);
  auto notes = WriteRelativePoses(scene, Path());
  ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
  EXPECT_THAT(*notes, IsEmpty());
  const Intrinsic before = scene.intrinsics.at(5);
  scene.intrinsics.at(5).fx_px *= 1.01;
  notes = WriteRelativePoses(scene, Path());
  ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
  EXPECT_THAT(*notes,
              ElementsAre(HasSubstr("stay as they are: 1 of them up to ")));
  EXPECT_TRUE(Read().scene.intrinsics.at(5) == before);
}

TEST_F(ColmapDatabaseFile, PanoramasHaveNoFundamentalMatrix) {
  for (const Version version : {Version::k3_8, Version::k4_0}) {
    std::filesystem::remove(Path());
    ColmapDatabase file(Path(), version);
    file.AddCamera(5, 17, 800, 400, {800, 400});
    file.AddImage(1, "a.jpg", 5, {10, 20, 30, 40}, 2);
    file.AddImage(2, "b.jpg", 5, {11, 21, 31, 41}, 2);
    Scene scene = Read().scene;
    RelativePose& pose = scene.relative_poses[{1, 2}];
    pose.views = {1, 2};
    pose.direction = Vec3(0.6, 0, -0.8);
    pose.point_inliers = {{0, 0}, {1, 1}};
    const auto written = WriteRelativePoses(scene, Path());
    ASSERT_TRUE(written.has_value()) << written.error().ToString();
    for (const char* unset : {"F", "H"}) {
      const std::string value = file.Query(
          std::string("SELECT quote(") + unset + ") FROM two_view_geometries");
      EXPECT_EQ(value, version == Version::k4_0
                           ? "NULL"
                           : "X'" + std::string(2 * 72, '0') + "'")
          << unset;
    }
    EXPECT_EQ(file.Query("SELECT hex(length(E)) FROM two_view_geometries"),
              file.Query("SELECT hex(72)"));
    EXPECT_EQ(Read().relative_poses.size(), 1u);
  }
}

TEST_F(ColmapDatabaseFile, OtherKeypointsAndNamesAreRefusedAndNothingChanges) {
  {
    ColmapDatabase file(Path(), Version::k3_8);
    Fill(&file);
    file.AddGeometry(1, 2, {1, 1}, 2, PoseSql(kQuarterTurn, kStep));
  }
  Scene moved = MeasuredScene(Read().scene);
  moved.features.at(1).points_px[0].x() += 0.25;
  Scene renamed = MeasuredScene(Read().scene);
  renamed.views.at(2).filename = "other.jpg";
  // SQLite's texts could end at the NUL.
  Scene longer = MeasuredScene(Read().scene);
  longer.views.at(2).filename += std::string("\0.jpg", 5);
  for (const auto& [scene, says] :
       {std::pair<const Scene&, const char*>(moved, "other keypoints"),
        std::pair<const Scene&, const char*>(renamed, "no image 'other.jpg'"),
        std::pair<const Scene&, const char*>(longer, "no image")}) {
    const auto written = WriteRelativePoses(scene, Path());
    ASSERT_FALSE(written.has_value());
    EXPECT_EQ(written.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(written.error().message, HasSubstr(says));
    EXPECT_EQ(Read().relative_poses.size(), 1u);
  }
  EXPECT_EQ(WriteRelativePoses(renamed, folder_.Path("none.db")).error().code,
            ErrorCode::kNotFound);
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("none.db")));
}

}  // namespace
}  // namespace lowlap::colmap
