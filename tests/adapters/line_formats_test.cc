// Lines of LIMAP and Line3D++.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "adapters/temporary_folder.h"
#include "lowlap/core/internal/atomic_file.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"
#include "third_party_adapters/limap/internal/line_folder.h"
#include "third_party_adapters/limap/internal/line_track.h"
#include "third_party_adapters/line3dpp/internal/line3dpp.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::IsError;
using testing::IsOk;
using testing::VectorNear;

// As LIMAP writes it, with blanks at the ends of lines.
constexpr char kTrack[] =
    "0.0000000000 0.0000000000 1.0000000000 2.0000000000 0.0000000000 "
    "1.0000000000 \n"
    "3 2\n"
    "image_id_list 4 9 9 \n"
    "line_id_list 1 0 2 \n"
    "line2d_list\n"
    "10.5 20 30 40 \n1 2 3 4 \n5 6 7 8 \n";
constexpr char kNodes[] =
    "node_id_list 0 1 2\nscore_list 0.5 1 2\nline3d_list\n"
    "0 0 1 2 0 1\n0 0 1 2 0 1\n0 0 1 2 0 1\n";

class LimapFolder : public ::testing::Test {
 protected:
  /// Two images, as LIMAP's detector and its triangulation leave them.
  void SetUp() override {
    folder_.Write("image_list.txt",
                  "number of images, 2\n4, a.jpg\n9, dir/b, c.jpg\n");
    folder_.Write(Segments(4), "2\n0 0 1 1\n10.5 20 30 40\n");
    folder_.Write(Segments(9), "3\n1 2 3 4\n0 0 1 1\n5 6 7 8\n");
    folder_.Write("finaltracks/track_0.txt", std::string(kTrack) + "END\n");
  }
  static std::string Segments(int id) {
    return "line_detections/lsd/segments/segments_" + std::to_string(id) +
           ".txt";
  }
  static std::string Matches(int id) {
    return "line_matchings/lsd/feats_superpoint/gluestick_n20_top0/matches_" +
           std::to_string(id) + ".txt";
  }
  Result<Scene> Read() { return ReadScene(folder_.Path(), &notes_); }

  const TemporaryFolder folder_;
  SceneNotes notes_;
};

TEST_F(LimapFolder, GivesNamesSegmentsAndLines) {
  const auto scene = Read();
  ASSERT_THAT(scene, IsOk());
  EXPECT_EQ(scene->views.at(4).filename, "a.jpg");
  EXPECT_EQ(scene->views.at(9).filename, "dir/b, c.jpg");
  ASSERT_EQ(scene->features.at(9).segments.size(), 3u);
  EXPECT_EQ(scene->features.at(4).segments[1].start_px, Vec2(10.5, 20));
  ASSERT_EQ(scene->line_structure.size(), 1u);
  const LineLandmark& line = scene->line_structure.at(0);
  EXPECT_EQ(line.end, Vec3(2, 0, 1));
  EXPECT_THAT(line.line.direction, VectorNear(Vec3(1, 0, 0), 1e-12));
  EXPECT_EQ(line.observations, (Track{{4, 1}, {9, 0}, {9, 2}}));
  EXPECT_EQ(scene->line_tracks.at(0), line.observations);
}

TEST_F(LimapFolder, TracksAloneBringTheirSegments) {
  std::filesystem::remove_all(folder_.Path("line_detections"));
  std::filesystem::remove(folder_.Path("image_list.txt"));
  folder_.Write("finaltracks/track_0.txt",
                std::string(kTrack) + kNodes + "END");
  const auto scene = Read();
  ASSERT_THAT(scene, IsOk());
  EXPECT_EQ(scene->line_tracks.at(0), (Track{{4, 0}, {9, 0}, {9, 1}}));
  EXPECT_EQ(scene->features.at(9).segments[1].end_px, Vec2(7, 8));
  EXPECT_THAT(notes_, Contains(HasSubstr("2 segments have other numbers")));
}

TEST_F(LimapFolder, MatchesNeedPosesToBecomeInliers) {
  folder_.Write(Matches(4), "9 0 1\n9 1 2\n");
  folder_.Write(Matches(9), "4 1 0\n");
  EXPECT_TRUE(Read()->relative_poses.empty());
  EXPECT_THAT(notes_, Contains(HasSubstr("1 pairs of images have matches")));
  // The model that limap_text.py makes of LIMAP's own.
  folder_.Write("sparse/cameras.txt", "1 PINHOLE 640 480 500 500 320.5 240\n");
  folder_.Write("sparse/images.txt",
                "4 1 0 0 0 0 0 0 1 a.jpg\n\n9 1 0 0 0 -1 0 0 1 b.jpg\n\n");
  folder_.Write("sparse/points3D.txt", "");
  const auto scene = Read();
  ASSERT_THAT(scene, IsOk());
  const RelativePose& pose = scene->relative_poses.at({4, 9});
  EXPECT_EQ(pose.direction, Vec3(-1, 0, 0));
  EXPECT_EQ(pose.line_inliers, (std::vector<FeatureMatch>{{0, 1}, {1, 2}}));
  EXPECT_EQ(scene->intrinsics.at(1).principal_point_px, Vec2(320, 239.5));
}

TEST_F(LimapFolder, PickledMatchesAreNoted) {
  folder_.Write(Matches(4) + ".npy", "");
  std::filesystem::rename(folder_.Path(Matches(4) + ".npy"),
                          std::filesystem::path(folder_.Path(Matches(4)))
                              .replace_extension(".npy"));
  ASSERT_THAT(Read(), IsOk());
  EXPECT_THAT(notes_, Contains(HasSubstr("limap_text.py")));
}

TEST_F(LimapFolder, DamagedFilesAreErrorsWithFileAndLine) {
  const auto expect = [&](const std::string& name, const std::string& text,
                          const std::string& message,
                          ErrorCode code = ErrorCode::kParse) {
    const std::string path = folder_.Path(name);
    const auto before = ReadWholeFile(path);
    folder_.Write(name, text);
    EXPECT_THAT(Read(), IsError(code, message));
    if (before) {
      folder_.Write(name, *before);
    } else {
      std::filesystem::remove(path);
    }
  };
  expect(Segments(4), "2\n0 0 1 1\n", "segments_4.txt: line 3: the file ends");
  expect(Segments(4), "1\n0 0 1 1\n2", "segments_4.txt: line 3: more than");
  expect(Segments(4), "-2\n", "'-2' is not the number of segments");
  expect(Segments(4), "4000000000\n0 0 1 nan\n", "line 2: 'nan' is not");
  expect(Segments(4), "1\n0 0 1 1\n", "segment 1 of image 4",
         ErrorCode::kInvalidScene);
  expect(Matches(4), "9 0\n", "matches_4.txt: line 2: the file ends");
  expect(Matches(4), "9 2 0\n", "line 1: image 4 has no segment 2");
  expect(Matches(4), "7 0 0\n", "line 1: image 7 has no segment 0");
  expect(Matches(4), "4 0 0\n", "line 1: the image is matched with itself");
  expect("image_list.txt", "number of images, 3\n4, a.jpg\n", "has 1 images");
  expect("image_list.txt", "number of images, 1\nfour\n", "line 2: 'id, name'");
  expect("finaltracks/track_2.txt", std::string(kTrack) + "END",
         "has no track_1.txt", ErrorCode::kInvalidScene);
  expect("finaltracks/track_0.txt", "0 0 0 0 0 0 2 2\n", "has no length");
  std::filesystem::create_directories(folder_.Path("line_detections/deeplsd"));
  EXPECT_THAT(Read(), IsError(ErrorCode::kUnsupported, "deeplsd, lsd"));
}

TEST(LimapTrack, EveryTruncationIsAnErrorWithItsLine) {
  const std::string text = std::string(kTrack) + kNodes + "END\n";
  ASSERT_THAT(limap::ParseLineTrack(text, "track_0.txt"), IsOk());
  for (std::size_t n = 0; n + 1 < text.size(); ++n) {
    if (!std::isspace(text[n])) continue;
    EXPECT_THAT(limap::ParseLineTrack(text.substr(0, n), "track_0.txt"),
                IsError(ErrorCode::kParse, "track_0.txt: line "));
  }
}

TEST(LimapTrack, IsWrittenAsLimapWritesIt) {
  const FileLine line = *limap::ParseLineTrack(std::string(kTrack) + "END", {});
  EXPECT_THAT(limap::FormatLineTrack(line),
              ::testing::StartsWith(
                  "0.0000000000 0.0000000000 1.0000000000 2.0000000000 "
                  "0.0000000000 1.0000000000 \n3 2\nimage_id_list 4 9 9 \n"
                  "line_id_list 1 0 2 \nline2d_list\n10.5000000000 "));
}

TEST(LimapWrite, HasWhatLimapReads) {
  const TemporaryFolder folder;
  const Scene scene = testing::RandomScene(2, 3, 10, 12);
  const std::string path = folder.Path("out");
  SceneNotes notes = *WriteScene(scene, path, "limap");
  EXPECT_THAT(notes, Contains(HasSubstr("1 intrinsics have distortion")));
  // Ids are those of COLMAP, which start at 1.
  EXPECT_EQ(*ReadWholeFile(path + "/image_list.txt"),
            "number of images, 3\n1, 0.jpg\n2, 1.jpg\n3, 2.jpg\n");
  EXPECT_THAT(*ReadWholeFile(path + "/triangulated_lines_nv2.obj"),
              ::testing::StartsWith("v "));
  EXPECT_TRUE(std::filesystem::exists(path + "/finaltracks/track_11.txt"));
  const Scene back = *ReadScene(path);
  EXPECT_EQ(back.line_structure.size(), 12u);
  // Features are those of the pinhole that the model has.
  const Intrinsic& pinhole = back.intrinsics.at(1);
  EXPECT_FALSE(pinhole.HasDistortion());
  const Vec2 raw = scene.features.at(0).segments[0].start_px;
  EXPECT_THAT(
      back.features.at(1).segments[0].start_px,
      VectorNear(
          Vec2(pinhole.Project(scene.intrinsics.at(0).Bearing(raw).value())),
          1e-9));
}

TEST(LimapWrite, CountsTracksWithoutALine) {
  const TemporaryFolder folder;
  Scene scene = testing::RandomScene(2, 3, 10, 12);
  scene.line_structure.erase(5);
  scene.coplanar_pairs.clear();
  for (const char* format : {"limap", "line3dpp"}) {
    EXPECT_THAT(*WriteScene(scene, folder.Path(format), format),
                Contains("1 line tracks without a triangulated line were left "
                         "out"));
  }
}

TEST(LimapWrite, DoesNotMixWithAnotherResult) {
  const TemporaryFolder folder;
  const std::string path = folder.Path("out");
  ASSERT_THAT(WriteScene(testing::RandomScene(2, 3, 10, 12), path, "limap"),
              IsOk());
  ASSERT_THAT(WriteScene(testing::RandomScene(3, 3, 10, 12), path, "limap"),
              IsOk());
  EXPECT_THAT(WriteScene(testing::RandomScene(2, 3, 10, 11), path, "limap"),
              IsError(ErrorCode::kInvalidArgument, "finaltracks"));
  EXPECT_THAT(WriteScene(testing::RandomScene(2, 2, 10, 12), path, "limap"),
              IsError(ErrorCode::kInvalidArgument, "segments_3.txt"));
}

// Images that stay, but without segments or without matches.
TEST(LimapWrite, DoesNotLeaveFilesThatItDoesNotWrite) {
  const TemporaryFolder folder;
  const std::string path = folder.Path("out");
  const Scene scene = testing::RandomScene(2, 3, 10, 12);
  ASSERT_FALSE(scene.relative_poses.empty());
  ASSERT_THAT(WriteScene(scene, path, "limap"), IsOk());

  Scene unmatched = scene;
  for (auto& [views, pose] : unmatched.relative_poses) {
    if (views.first == 0) pose.line_inliers.clear();
  }
  const std::string matches = "line_matchings/lowlap/feats_lowlap/lowlap/";
  EXPECT_THAT(WriteScene(unmatched, path, "limap"),
              IsError(ErrorCode::kInvalidArgument, "matches_1.txt"));
  // So are those that limap_text.py made for LIMAP.
  std::filesystem::rename(path + "/" + matches + "matches_1.txt",
                          path + "/" + matches + "matches_1.npy");
  EXPECT_THAT(WriteScene(unmatched, path, "limap"),
              IsError(ErrorCode::kInvalidArgument, "matches_1.npy"));
  std::filesystem::remove(path + "/" + matches + "matches_1.npy");
  EXPECT_THAT(WriteScene(unmatched, path, "limap"), IsOk());

  Scene unseen;
  unseen.intrinsics = scene.intrinsics;
  unseen.views = scene.views;
  unseen.poses = scene.poses;
  std::filesystem::remove_all(path + "/finaltracks");
  EXPECT_THAT(WriteScene(unseen, path, "limap"),
              IsError(ErrorCode::kInvalidArgument, "segments_1.txt"));
}

TEST(LimapWrite, NamesThatTheImageListCannotHoldAreRefused) {
  const TemporaryFolder folder;
  Scene scene = testing::RandomScene(2, 3, 10, 12);
  for (const char end : {'\n', '\r', '\0'}) {
    scene.views.at(1).filename = std::string("a") + end + "b.jpg";
    EXPECT_THAT(WriteScene(scene, folder.Path("out"), "limap"),
                IsError(ErrorCode::kUnsupported, "image_list.txt: image 2"));
    EXPECT_FALSE(std::filesystem::exists(folder.Path("out")));
  }
  scene.views.at(1).filename = "a b, c.jpg";
  ASSERT_THAT(WriteScene(scene, folder.Path("out"), "limap"), IsOk());
  EXPECT_EQ(ReadScene(folder.Path("out"))->views.at(2).filename, "a b, c.jpg");
}

constexpr char kLine3dppText[] =
    "1 0 0 1 2 0 1 2 4 1 10.5 20 30 40 9 0 1 2 3 4\n"
    "2 5 0 0 6 0 0 8 0 0 7 0 0 2 4 0 0 0 1 1 9 0 1 2 3 4\n";

TEST(Line3dpp, PiecesOfALineBecomeOne) {
  SceneNotes notes;
  const auto scene = line3dpp::ParseLine3dpp(kLine3dppText, "a.txt", &notes);
  ASSERT_THAT(scene, IsOk());
  const LineLandmark& line = scene->line_structure.at(1);
  EXPECT_EQ(line.start, Vec3(5, 0, 0));
  EXPECT_EQ(line.end, Vec3(8, 0, 0));
  EXPECT_EQ(line.observations, (Track{{4, 0}, {9, 0}}));
  EXPECT_EQ(scene->features.at(4).segments[1].end_px, Vec2(30, 40));
  EXPECT_THAT(notes, Contains("1 lines of several pieces were joined"));
}

TEST(Line3dpp, LinesOfOneSegmentAreLeftOut) {
  SceneNotes notes;
  const auto scene = line3dpp::ParseLine3dpp(
      "1 0 0 1 2 0 1 1 4 1 10 20 30 40\n", "a.txt", &notes);
  ASSERT_THAT(scene, IsOk());
  EXPECT_TRUE(scene->line_structure.empty());
  EXPECT_THAT(notes, Contains(HasSubstr("1 lines that one segment")));
}

TEST(Line3dpp, EveryTruncationInALineIsAnErrorOfThatLine) {
  SceneNotes notes;
  const std::string text = kLine3dppText;
  for (std::size_t n = 1; n + 1 < text.size(); ++n) {
    if (!std::isspace(text[n]) || text[n] == '\n') continue;
    EXPECT_THAT(
        line3dpp::ParseLine3dpp(text.substr(0, n), "a.txt", &notes),
        IsError(ErrorCode::kParse, n < text.find('\n') ? "line 1" : "line 2"));
  }
}

TEST(Line3dpp, MalformedFilesAreErrorsWithALine) {
  SceneNotes notes;
  for (const auto& [text, message] :
       std::vector<std::pair<std::string, std::string>>{
           {"0 0\n", "line 1: the line has no length"},
           {"1 1 1 1 1 1 1 0\n", "line 1: the line has no length"},
           {"1 0 0 0 1 0 0 0 7\n", "line 1: the line goes on"},
           {"1 0 0 0 1 0 0 4000000000 4 0 1 1 2 2\n", "line 1: the line ends"},
           {"4000000000 0 0 0 1 0 0\n", "line 1: the line ends"},
           {"1 0 0 0 1 0 0 1 -4 0 1 1 2 2\n", "'-4' is not an image id"},
           {"1 0 0 0 1 0 nan 0\n", "'nan' is not"}}) {
    EXPECT_THAT(line3dpp::ParseLine3dpp(text, "a.txt", &notes),
                IsError(ErrorCode::kParse, message));
  }
}

}  // namespace
}  // namespace lowlap
