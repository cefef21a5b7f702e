#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <sstream>

#include "adapters/temporary_folder.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "third_party_adapters/colmap/internal/model.h"
#include "third_party_adapters/colmap/internal/model_scene.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::colmap {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string Content(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A model by hand: camera 1 looks along z from the origin, camera 2 from
/// (1, 0, 0) after a quarter turn about z: x_cam = (-Y, X - 1, Z).
class ColmapModel : public ::testing::Test {
 protected:
  ColmapModel() {
    folder_.Write("model/cameras.txt",
                  "# a comment\n\n3 PINHOLE 800 600 500 510 400 300\n");
    folder_.Write("model/images.txt",
                  "# IMAGE_ID, ...\n"
                  "1 1 0 0 0 0 0 0 3 left/a.jpg\n"
                  "500 402 7 1 2 -1 \n"
                  "4 0.70710678118654757 0 0 0.70710678118654757 0 -1 0 3 b.jpg"
                  "\r\n"
                  "300 300 7\n"
                  "6 1 0 0 0 9 9 9 3 c.jpg\n"
                  "\n");
    folder_.Write("model/points3D.txt", "7 1 1 5 10 20 30 0.5 1 0 4 0\n");
  }

  Result<Scene> Read(SceneNotes* notes = nullptr) const {
    return ReadScene(folder_.Path("model"), notes);
  }
  Scene Scene_() const {
    const auto scene = Read();
    EXPECT_TRUE(scene.has_value()) << scene.error().ToString();
    return scene ? *scene : Scene();
  }
  Error ReadError() const {
    const auto scene = Read();
    EXPECT_FALSE(scene.has_value());
    return scene ? Error{} : scene.error();
  }

  TemporaryFolder folder_;
};

TEST_F(ColmapModel, TextIsReadInOurConventions) {
  SceneNotes notes;
  const auto read = Read(&notes);
  ASSERT_TRUE(read.has_value()) << read.error().ToString();
  const Scene& scene = *read;
  ASSERT_EQ(scene.views.size(), 3u);
  EXPECT_EQ(scene.views.at(1).filename, "left/a.jpg");
  EXPECT_EQ(scene.views.at(4).filename, "b.jpg");
  EXPECT_EQ(scene.intrinsics.at(3).principal_point_px, Vec2(399.5, 299.5));
  EXPECT_LT((scene.poses.at(4).center - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((scene.poses.at(4).CamFromWorld() * Vec3(1, 1, 5) - Vec3(-1, 0, 5))
                .norm(),
            1e-15);
  EXPECT_THAT(scene.features.at(1).points_px,
              ElementsAre(Vec2(499.5, 401.5), Vec2(0.5, 1.5)));
  EXPECT_EQ(scene.features.count(6), 0u);
  ASSERT_EQ(scene.structure.size(), 1u);
  const Landmark& landmark = scene.structure.at(7);
  ASSERT_EQ(landmark.observations.size(), 2u);
  EXPECT_EQ(landmark.observations[1].view, 4u);
  EXPECT_EQ(landmark.observations[1].pixel_px, Vec2(299.5, 299.5));
  // 400 + 500 / 5 and 300 + 510 / 5 are the pixels of image 1.
  EXPECT_LT((scene.FindIntrinsic(1)->Project(landmark.position) -
             landmark.observations[0].pixel_px)
                .norm(),
            1e-12);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("1 colours")));
}

TEST_F(ColmapModel, BinaryHoldsTheSame) {
  const Scene scene = Scene_();
  const auto notes = WriteScene(scene, folder_.Path("binary"), "colmap-bin");
  ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
  const auto back = ReadScene(folder_.Path("binary"));
  ASSERT_TRUE(back.has_value()) << back.error().ToString();
  EXPECT_EQ(back->views, scene.views);
  EXPECT_EQ(back->features, scene.features);
  EXPECT_EQ(back->structure.at(7), scene.structure.at(7));
  // u64 n; u32 id, i32 model, u64 width, u64 height, 4 doubles.
  const std::string cameras = Content(folder_.Path("binary/cameras.bin"));
  ASSERT_EQ(cameras.size(), 8u + 24 + 32);
  EXPECT_EQ(cameras.substr(0, 16),
            std::string("\1\0\0\0\0\0\0\0\3\0\0\0\1\0\0\0", 16));
  // 3 x (64 + 1 + 8) and the names, then 3 points.
  EXPECT_EQ(Content(folder_.Path("binary/images.bin")).size(),
            8u + 3 * 73 + 10 + 5 + 5 + 3 * 24);
  EXPECT_EQ(Content(folder_.Path("binary/points3D.bin")).size(),
            8u + 51 + 2 * 8);
  for (const char* name : {"rigs.bin", "frames.bin"}) {
    EXPECT_FALSE(std::filesystem::exists(folder_.Path("binary") + "/" + name));
  }
}

TEST_F(ColmapModel, TruncatedBinaryFilesAreErrors) {
  ASSERT_TRUE(WriteScene(Scene_(), folder_.Path("binary"), "colmap-bin"));
  for (const std::string name : {"cameras", "images", "points3D"}) {
    const std::string path = "binary/" + name + ".bin";
    const std::string whole = Content(folder_.Path(path));
    for (std::size_t size = 0; size < whole.size(); ++size) {
      folder_.Write(path, whole.substr(0, size));
      const auto scene = ReadScene(folder_.Path("binary"));
      ASSERT_FALSE(scene.has_value()) << name << " " << size;
      EXPECT_EQ(scene.error().code, ErrorCode::kParse);
      EXPECT_EQ(scene.error().file, folder_.Path(path));
      EXPECT_THAT(scene.error().place, HasSubstr("byte"));
    }
    folder_.Write(path, whole + "x");
    EXPECT_FALSE(ReadScene(folder_.Path("binary")).has_value());
    folder_.Write(path, std::string(7, '\xff') + whole.substr(7));
    EXPECT_FALSE(ReadScene(folder_.Path("binary")).has_value());
    folder_.Write(path, whole);
  }
  EXPECT_TRUE(ReadScene(folder_.Path("binary")).has_value());
}

TEST_F(ColmapModel, AnUnknownCameraModelIsUnsupported) {
  ASSERT_TRUE(WriteScene(Scene_(), folder_.Path("binary"), "colmap-bin"));
  std::string cameras = Content(folder_.Path("binary/cameras.bin"));
  cameras[12] = 99;
  folder_.Write("binary/cameras.bin", cameras);
  const auto scene = ReadScene(folder_.Path("binary"));
  ASSERT_FALSE(scene.has_value());
  EXPECT_EQ(scene.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(scene.error().file, folder_.Path("binary/cameras.bin"));
  EXPECT_THAT(scene.error().message, HasSubstr("camera 3 has model 99"));
}

TEST_F(ColmapModel, WhatIsWrongWithTextIsNamedWithItsLine) {
  struct Case {
    const char* file;
    const char* content;
    const char* place;
    const char* message;
  };
  for (const Case& wrong :
       {Case{"cameras.txt", "3 PINHOLE 800 600 500 510 400\n", "line 1",
             "a parameter is expected"},
        {"cameras.txt", "\n3 WIDE 800 600 500\n", "line 2",
         "camera 3 has model WIDE"},
        {"cameras.txt", "3 PINHOLE 800 600 500 510 400 300 1\n", "line 1",
         "fewer parameters"},
        {"images.txt", "1 1 0 0 0 0 0 0 3 a b.jpg\n\n", "line 1", "no blanks"},
        {"images.txt", "1 1 0 0 0 0 0 0 3 a.jpg\n", "line 1", "second line"},
        {"images.txt", "1 1 0 0 0 0 0 0 3 a.jpg\n5 x -1\n", "line 2",
         "'x' is not a pixel"},
        {"points3D.txt", "7 1 1 5 10 20 300 0.5\n", "line 1", "a colour"},
        {"rigs.txt", "1 2 CAMERA 3 LIDAR 4 0\n", "line 1", "CAMERA, IMU"}}) {
    SCOPED_TRACE(wrong.content);
    const std::string path = std::string("model/") + wrong.file;
    const std::string before = Content(folder_.Path(path));
    folder_.Write(path, wrong.content);
    const Error error = ReadError();
    EXPECT_EQ(error.file, folder_.Path(path));
    EXPECT_EQ(error.place, wrong.place);
    EXPECT_THAT(error.message, HasSubstr(wrong.message));
    if (before.empty()) {
      std::filesystem::remove(folder_.Path(path));
    } else {
      folder_.Write(path, before);
    }
  }
}

TEST_F(ColmapModel, FilesThatContradictEachOtherAreErrors) {
  const auto message = [&](const char* file, const char* content) {
    const std::string path = std::string("model/") + file;
    const std::string before = Content(folder_.Path(path));
    folder_.Write(path, content);
    const Error error = ReadError();
    EXPECT_EQ(error.code, ErrorCode::kInvalidScene);
    folder_.Write(path, before);
    return error.message;
  };
  EXPECT_THAT(message("cameras.txt", "2 PINHOLE 8 6 5 5 4 3\n"),
              HasSubstr("image 1 has camera 3"));
  EXPECT_THAT(message("points3D.txt", "7 1 1 5 0 0 0 0 1 0 4 9\n"),
              HasSubstr("point 9 of image 4, which is not there"));
  EXPECT_THAT(message("points3D.txt", "8 1 1 5 0 0 0 0 1 0 4 0\n"),
              HasSubstr("belongs to another point"));
  EXPECT_THAT(message("points3D.txt", "7 1 1 5 0 0 0 0 1 0 5 0\n"),
              HasSubstr("image 5"));
  // As a text that was cut between two lines.
  EXPECT_THAT(message("points3D.txt", "# 1 point\n"),
              HasSubstr("belongs to point 7, which is not there"));
}

TEST_F(ColmapModel, APoseWithoutAPlaceIsNone) {
  folder_.Write("model/images.txt",
                "1 1 0 0 0 nan nan nan 3 a.jpg\n500 402 7\n"
                "4 1 0 0 0 0 0 0 3 b.jpg\n300 198 7\n");
  SceneNotes notes;
  const auto scene = Read(&notes);
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  EXPECT_EQ(scene->views.size(), 2u);
  EXPECT_EQ(scene->poses.size(), 1u);
  EXPECT_THAT(notes, Contains(HasSubstr("1 images have no complete pose")));
}

// The pose of a frame counts, not that of the image line.
TEST_F(ColmapModel, PosesOfARigAreThoseOfFrameAndSensor) {
  folder_.Write("model/cameras.txt",
                "3 PINHOLE 800 600 500 510 400 300\n"
                "5 PINHOLE 800 600 500 510 400 300\n");
  folder_.Write("model/images.txt",
                "1 1 0 0 0 7 7 7 3 left/1.jpg\n\n"
                "2 1 0 0 0 7 7 7 5 right/1.jpg\n\n");
  folder_.Write("model/points3D.txt", "");
  folder_.Write("model/rigs.txt",
                "1 3 CAMERA 3 CAMERA 5 1 1 0 0 0 -0.5 0 0 IMU 1 0\n");
  folder_.Write("model/frames.txt",
                "1 1 0.70710678118654757 0 0 0.70710678118654757 0 -1 0 2 "
                "CAMERA 3 1 CAMERA 5 2\n");
  SceneNotes notes;
  const auto scene = Read(&notes);
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  EXPECT_LT((scene->poses.at(1).center - Vec3(1, 0, 0)).norm(), 1e-15);
  // Half a unit along the x axis of the left camera, which is -Y.
  EXPECT_LT((scene->poses.at(2).center - Vec3(1, -0.5, 0)).norm(), 1e-15);
  EXPECT_EQ(scene->poses.at(1).rotation, scene->poses.at(2).rotation);
  EXPECT_THAT(notes, Contains(HasSubstr("rigid")));

  // Both forms hold rigs and frames.
  const auto model = ReadModel(folder_.Path("model"), ModelForm::kText);
  ASSERT_TRUE(model.has_value());
  Model text, binary;
  for (const char* name : kModelParts) {
    ParseText(FormatText(*model, name), name, &text);
    ParseBinary(FormatBinary(*model, name), name, &binary);
  }
  for (const char* name : kModelParts) {
    EXPECT_EQ(FormatText(text, name), FormatText(*model, name));
    EXPECT_EQ(FormatText(binary, name), FormatText(*model, name));
  }
}

TEST_F(ColmapModel, RigsThatAreThereFollowThePoses) {
  const Scene scene = Scene_();
  folder_.Write("model/rigs.txt", "3 1 CAMERA 3\n");
  folder_.Write("model/frames.txt", "1 3 1 0 0 0 9 9 9 1 CAMERA 3 1\n");
  ASSERT_TRUE(WriteScene(scene, folder_.Path("model"), "colmap"));
  const Scene back = Scene_();
  EXPECT_EQ(back.poses.size(), 3u);
  EXPECT_LT((back.poses.at(1).center - scene.poses.at(1).center).norm(), 1e-12);
}

/// Ids from 0, random poses, and what a model cannot hold.
Scene SolvedScene() {
  SyntheticOptions options;
  options.num_views = 6;
  options.points_per_wall = 40;
  options.noise_px = 0.5;
  return TrueSolution(*Simulate(options));
}

TEST(ColmapExport, ComesBackAndGoesOutTheSame) {
  const Scene scene = SolvedScene();
  ASSERT_GT(scene.structure.size(), 20u);
  const TemporaryFolder folder;
  for (const char* format : {"colmap", "colmap-bin"}) {
    SCOPED_TRACE(format);
    const std::string once = folder.Path(std::string(format) + "1");
    const std::string twice = folder.Path(std::string(format) + "2");
    const auto notes = WriteScene(scene, once, format);
    ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
    EXPECT_THAT(*notes, ElementsAre(HasSubstr("relative poses")));
    const auto back = ReadScene(once);
    ASSERT_TRUE(back.has_value()) << back.error().ToString();
    ASSERT_TRUE(WriteScene(*back, twice, format).has_value());
    for (const auto& entry : std::filesystem::directory_iterator(once)) {
      const std::string name = entry.path().filename().string();
      EXPECT_EQ(Content(twice + "/" + name), Content(entry.path().string()))
          << name;
    }
    // Ids are one more, the rest is as it was.
    ASSERT_EQ(back->views.size(), scene.views.size());
    ASSERT_EQ(back->structure.size(), scene.structure.size());
    for (const auto& [id, view] : scene.views) {
      const ViewId moved = id.value() + 1;
      EXPECT_EQ(back->views.at(moved).filename, view.filename);
      EXPECT_EQ(back->features.at(moved).points_px.size(),
                scene.features.at(id).points_px.size());
      EXPECT_LT((back->FindPose(moved)->rotation - scene.FindPose(id)->rotation)
                    .norm(),
                1e-13);
      for (const auto& [track, landmark] : scene.structure) {
        const Vec3& position = landmark.position;
        const auto pixel = [&position](const Scene& s, ViewId v) {
          return s.FindIntrinsic(v)->Project(s.FindPose(v)->CamFromWorld() *
                                             position);
        };
        const auto& all = landmark.observations;
        if (std::any_of(all.begin(), all.end(), [view = id](const auto& o) {
              return o.view == view;
            })) {
          EXPECT_LT((pixel(*back, moved) - pixel(scene, id)).norm(), 1e-9);
        }
      }
    }
  }
}

// Poses whose numbers lie anywhere, from a millionth to a million units from
// the origin, close to no turn, and at half turns, where the quaternion's sign
// is free.
TEST(ColmapExport, PosesAreStableToTheByte) {
  Scene scene;
  scene.intrinsics[0] = SolvedScene().intrinsics.begin()->second;
  const auto add = [&](const Mat3& rotation, const Vec3& center) {
    const auto id = static_cast<std::uint32_t>(scene.views.size());
    scene.views[id] =
        ViewOfImage(id, std::to_string(id) + ".jpg", 0, scene.intrinsics.at(0));
    scene.poses[id] = {rotation, center};
  };
  for (const double angle : {0.0, kPi}) {
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)}) {
      add(RotationFromAngleAxis(angle * axis), Vec3::Zero());
    }
  }
  // Rounded again and again, this one goes back and forth.
  const Mat3 rotation =
      RotationFromQuaternion({0.036297376308041862, -0.060793082429341894,
                              0.99689049922444894, -0.03458372677884114});
  add(rotation, -(rotation.transpose() * Vec3(-419.639, 1734.54, -546.296)));
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  while (scene.views.size() < 20000) {
    Vec4 q(normal(generator), normal(generator), normal(generator),
           normal(generator));
    if (scene.views.size() % 3 == 1) q[0] *= 1e-9;
    if (scene.views.size() % 3 == 2) q.tail<3>() *= 1e-7;
    add(RotationFromQuaternion(q),
        std::pow(10.0, static_cast<double>(scene.views.size() % 13) - 6) *
            Vec3(normal(generator), normal(generator), normal(generator)));
  }
  SceneNotes notes;
  const auto once = ModelFromScene(scene, &notes);
  ASSERT_TRUE(once.has_value()) << once.error().ToString();
  const auto back = SceneFromModel(*once, &notes);
  ASSERT_TRUE(back.has_value()) << back.error().ToString();
  const auto twice = ModelFromScene(*back, &notes);
  ASSERT_TRUE(twice.has_value()) << twice.error().ToString();
  EXPECT_EQ(FormatBinary(*once, "images"), FormatBinary(*twice, "images"));
}

TEST(ColmapExport, OnlyPosedViewsAndWhatTheySeeGoOut) {
  Scene scene = SolvedScene();
  const ViewId dropped = scene.views.rbegin()->first;
  scene.poses.erase(scene.views.at(dropped).pose_id);
  // An observation without a feature.
  auto& first = scene.structure.begin()->second.observations;
  first[0].feature = kInvalidId;
  SceneNotes notes;
  const auto model = ModelFromScene(scene, &notes);
  ASSERT_TRUE(model.has_value()) << model.error().ToString();
  EXPECT_EQ(model->images.size(), scene.views.size() - 1);
  EXPECT_THAT(notes, Contains(HasSubstr("1 views without a pose")));
  for (const Point3D& point : model->points) {
    EXPECT_GE(point.track.size(), 2u);
    for (const TrackElement& element : point.track) {
      const auto image = std::find_if(
          model->images.begin(), model->images.end(),
          [&](const Image& i) { return i.id == element.image_id; });
      ASSERT_NE(image, model->images.end());
      EXPECT_EQ(image->points.at(element.point_index).point3d, point.id);
    }
  }
  const std::uint32_t index = model->points[0].track[0].point_index;
  EXPECT_EQ(index, scene.features.at(first[0].view).points_px.size());
}

TEST(ColmapExport, ImagesWithoutNamesAreNamedByTheirViews) {
  Scene scene = SolvedScene();
  for (auto& [id, view] : scene.views) view.filename.clear();
  SceneNotes notes;
  const auto model = ModelFromScene(scene, &notes);
  ASSERT_TRUE(model.has_value()) << model.error().ToString();
  ASSERT_EQ(scene.views.count(0), 1u);
  EXPECT_EQ(model->images[0].id, 1u);
  EXPECT_EQ(model->images[0].name, "image0");
}

// Ids go out one higher, where zero is one of them.
TEST(ColmapExport, AnIdThatBecomesTheReservedOneIsRefused) {
  Scene scene = SolvedScene();
  ASSERT_EQ(scene.views.count(0), 1u);
  scene.views[kInvalidId - 1] = scene.views.at(0);
  SceneNotes notes;
  const auto model = ModelFromScene(scene, &notes);
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(model.error().place, HasSubstr("view 4294967294"));
}

}  // namespace
}  // namespace lowlap::colmap
