// Every format against every other: what both hold survives A -> B -> A.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include "adapters/temporary_folder.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/scene/validation.h"
#include "scene/example_scenes.h"
#include "scene/scene_inventory.h"
#include "support/matchers.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using testing::InventoryOf;
using testing::IsOk;
using testing::SceneItem;

void ExpectSame(const Scene& a, const Scene& b, const SceneContents& contents) {
  // Texts have ten decimals or more.
  constexpr double kTolerance = 1e-8;
  ASSERT_EQ(a.views.size(), b.views.size());
  const std::vector<SceneItem> items_a = InventoryOf(a, contents);
  const std::vector<SceneItem> items_b = InventoryOf(b, contents);
  ASSERT_EQ(items_a.size(), items_b.size());
  for (std::size_t n = 0; n < items_a.size(); ++n) {
    EXPECT_EQ(items_a[n].what, items_b[n].what);
    EXPECT_THAT(items_a[n].numbers,
                ::testing::Pointwise(::testing::DoubleNear(kTolerance),
                                     items_b[n].numbers))
        << items_a[n].what;
  }
}

/// Something of every kind of content. One photograph has no distortion, so
/// that every format holds it exactly; the principal point is off the middle.
Scene ExampleScene() {
  Scene scene = testing::RandomScene(5, 5, 60, 60);
  Intrinsic& intrinsic = scene.intrinsics.at(0);
  intrinsic.model = CameraModel::kPinhole;
  intrinsic.distortion.clear();
  intrinsic.principal_point_px = {315, 247};
  // Another camera, with a prior.
  scene.intrinsics[3] = intrinsic;
  scene.intrinsics.at(3).fx_px = scene.intrinsics.at(3).fy_px = 710;
  scene.views.at(2).intrinsic_id = 3;
  scene.views.at(2).local_path = "sub";
  scene.views.at(1).center_prior = CenterPrior{{1, 1, 1}, {1, 2, 3}};
  scene.given_intrinsics[0] = intrinsic;
  scene.poses.begin()->second.center_covariance = 2 * Mat3::Identity();
  // Two cameras of a rig; LIMAP has no matches of views at one place.
  scene.poses.erase(scene.views.at(4).pose_id);
  scene.views.at(4).pose_id = scene.views.at(0).pose_id;
  scene.control_points[4].position = {1, 2, 3};
  ViewFeatures& features = scene.features.at(0);
  features.point_covariances.assign(features.points_px.size(), Vec3(1, 0, 2));
  features.segments[0].stddev_px = 0.75;
  features.repeated_points = {1, 2};
  features.repeated_segments = {0};
  RelativePose& pose = scene.relative_poses.begin()->second;
  pose.covariance = Eigen::Matrix<double, 5, 5>::Identity();
  pose.alternatives.push_back({pose.rotation, -pose.direction, -3, {}});
  pose.weakness = PoseWeakness::kRepeats;
  scene.unrelated_pairs = {{0, 4}};
  return scene;
}

SceneContents Common(const SceneContents& a, const SceneContents& b) {
  SceneContents common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(),
                        std::inserter(common, common.begin()));
  return common;
}

/// Of formats that need something of a camera, what they keep without one.
const SceneContents kNeedNoCamera = {
    SceneContent::kSegments, SceneContent::kLineTracks, SceneContent::kLines,
    SceneContent::kLineObservations};

/// Formats that keep a scene by themselves. A database of COLMAP does not: it
/// is written into one that exists.
std::vector<std::string> RoundTripFormats() {
  std::vector<std::string> names;
  for (const SceneFormat& format : AllSceneFormats()) {
    if (format.read && format.write && format.name != "colmap-db") {
      names.push_back(format.name);
    }
  }
  return names;
}

SceneFormat FormatNamed(const std::string& name) {
  const SceneFormats formats = AllSceneFormats();
  return **FindNamedSceneFormat(formats, name);
}

class FormatRoundTrip
    : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  /// The scene that comes back; empty, with a failure, if none does.
  Scene Back(const Scene& scene, const SceneFormat& format) {
    const std::string path =
        folder_.Path("file" + std::to_string(++num_files_) + format.extension);
    EXPECT_THAT(WriteScene(scene, path, format.name), IsOk());
    // By what is in it.
    const Result<Scene> read = ReadScene(path);
    EXPECT_THAT(read, IsOk());
    return read ? *read : Scene();
  }

  const TemporaryFolder folder_;
  int num_files_ = 0;
};

TEST_P(FormatRoundTrip, KeepsWhatBothHold) {
  const SceneFormat a = FormatNamed(std::get<0>(GetParam()));
  const SceneFormat b = FormatNamed(std::get<1>(GetParam()));
  SceneContents common = Common(a.holds, b.holds);
  if (Common(b.needs, a.holds) != b.needs ||
      Common(a.needs, b.holds) != a.needs) {
    common = Common(common, kNeedNoCamera);
  }
  if (common.empty()) return;  // nothing passes between them
  const Scene in_a = Back(ExampleScene(), a);
  ExpectSame(in_a, ExampleScene(), a.holds);
  const Scene in_b = Back(in_a, b);
  ExpectSame(Back(in_b, a), in_a, common);
}

INSTANTIATE_TEST_SUITE_P(
    AllPairs, FormatRoundTrip,
    ::testing::Combine(::testing::ValuesIn(RoundTripFormats()),
                       ::testing::ValuesIn(RoundTripFormats())),
    [](const auto& pair) {
      std::string name =
          std::get<0>(pair.param) + "_to_" + std::get<1>(pair.param);
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(SceneFormats, WhatAFormatCannotHoldIsCounted) {
  const TemporaryFolder folder;
  const Scene scene = ExampleScene();
  for (const SceneFormat& format : AllSceneFormats()) {
    if (!format.write || format.name == "colmap-db") continue;
    const auto notes = WriteScene(
        scene, folder.Path(format.name + format.extension), format.name);
    ASSERT_THAT(notes, IsOk()) << format.name;
    std::string all;
    for (const std::string& note : *notes) all += note + "\n";
    for (const ContentKind& kind : ContentKinds()) {
      const std::string counted =
          std::to_string(kind.count(scene)) + " " + kind.name;
      if (kind.content == SceneContent::kDistortions) continue;
      ASSERT_GT(kind.count(scene), 0u) << kind.name;
      if (format.holds.count(kind.content) > 0) {
        EXPECT_THAT(all, ::testing::Not(HasSubstr(" " + counted + ",")));
      } else {
        EXPECT_THAT(all, HasSubstr(format.name + " cannot hold "));
        EXPECT_THAT(all, HasSubstr(counted));
      }
    }
  }
}

// Without names, who reads the file can only count.
TEST(SceneFormats, BalWarnsWhereAPlaceIsNotTheIdOfItsView) {
  const TemporaryFolder folder;
  Scene scene = testing::RandomScene(1, 3, 5, 0);
  for (auto& [id, intrinsic] : scene.intrinsics) {
    intrinsic.model = CameraModel::kPinhole;
    intrinsic.distortion.clear();
    intrinsic.fy_px = intrinsic.fx_px;
  }
  const auto warning = HasSubstr("camera n of the file is the n-th");
  auto notes = WriteScene(scene, folder.Path("whole.bal"));
  ASSERT_THAT(notes, IsOk());
  EXPECT_THAT(*notes, ::testing::Not(::testing::Contains(warning)));
  scene.poses.erase(scene.views.at(1).pose_id);
  notes = WriteScene(scene, folder.Path("part.bal"));
  ASSERT_THAT(notes, IsOk());
  EXPECT_THAT(*notes, ::testing::Contains(warning));
}

TEST(SceneFormats, DamagedTextGivesAValidSceneOrAnErrorWithItsFile) {
  const TemporaryFolder folder;
  Random random(9);
  int num_errors = 0;
  for (const char* name :
       {"bundler", "nvm", "bal", "tum", "kitti", "line3dpp"}) {
    const std::string path = folder.Path("file");
    ASSERT_THAT(WriteScene(testing::RandomScene(5, 3, 6, 6), path, name),
                IsOk());
    const std::string text = *ReadWholeFile(path);
    for (int n = 0; n < 200; ++n) {
      std::string damaged = text;
      for (int change = 0; change < 3; ++change) {
        damaged[random.Index(static_cast<std::uint32_t>(text.size()))] =
            "0123456789-.e \nx"[random.Index(16)];
      }
      folder.Write("file", damaged);
      const Result<Scene> scene = ReadScene(path, nullptr, name);
      if (scene) {
        EXPECT_THAT(ValidateScene(*scene), IsOk()) << damaged;
      } else {
        ++num_errors;
        EXPECT_EQ(scene.error().file, path) << scene.error().ToString();
      }
    }
  }
  EXPECT_GT(num_errors, 100);
}

TEST(SceneFormats, TheTableHasEveryFormatAndWhatItHolds) {
  const std::string table = TabulateSceneFormats(AllSceneFormats());
  for (const SceneFormat& format : AllSceneFormats()) {
    EXPECT_FALSE(format.holds.empty()) << format.name;
    EXPECT_THAT(table, HasSubstr(format.name + " (" +
                                 (!format.read    ? "written only"
                                  : !format.write ? "read only"
                                                  : "read and written") +
                                 "): " + format.description));
  }
  EXPECT_THAT(table, HasSubstr("holds everything"));
  EXPECT_THAT(table, HasSubstr("cameras of views that have poses\n"));
}

TEST(SceneFormats, ANamedFormatIsReadWhateverTheFileLooksLike) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("poses.json", "1 0 0 0 0 0 0 1\n");
  SceneNotes notes;
  EXPECT_THAT(ReadScene(path, &notes, "tum"), IsOk());
  EXPECT_FALSE(ReadScene(path, &notes, "kitti"));
  EXPECT_FALSE(ReadScene(path, &notes, "no format"));
}

}  // namespace
}  // namespace lowlap
