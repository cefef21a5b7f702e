#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "adapters/temporary_folder.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/validation.h"
#include "support/random_vectors.h"
#include "third_party_adapters/internal/camera_files.h"
#include "third_party_adapters/onedsfm/internal/problem.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {
namespace {

const Vec3 kAxes(1, -1, -1);

// Four cameras and six points, written the way the data sets are: Bundler's
// axes (y up, looking along -z), keypoints counted from (1, 1). Image 3 of five
// is not used.
class OneDSfmFolder : public ::testing::Test {
 protected:
  static constexpr int kImages = 5;
  static constexpr double kFocal = 700;

  void SetUp() override {
    Random random(1);
    const auto uniform = [&] {
      return testing::UniformVec3(random, {-1, -1, -1}, {1, 1, 1});
    };
    for (int n = 0; n < kImages; ++n) {
      poses_.push_back({RotationFromAngleAxis(0.3 * uniform()), 2 * uniform()});
    }
    for (int k = 0; k < 6; ++k) {
      points_.push_back(uniform() + Vec3(0, 0, 8));
    }
    WriteAll();
  }

  // Bundler's camera: R_b = D R, t_b = -R_b C.
  Mat3 BundlerRotation(int n) const {
    return kAxes.asDiagonal() * poses_[n].rotation;
  }

  Vec2 Pixel(int n, const Vec3& point) const {  // from 0
    const Vec3 x = poses_[n].rotation * (point - poses_[n].center);
    return {kFocal * x.x() / x.z() + 399.5, kFocal * x.y() / x.z() + 299.5};
  }

  static std::string Text(const Mat3& m) {
    std::ostringstream out;
    out << std::setprecision(17);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) out << ' ' << m(r, c);
    }
    return out.str();
  }
  static std::string Text(const Vec3& v) {
    std::ostringstream out;
    out << std::setprecision(17) << ' ' << v.x() << ' ' << v.y() << ' '
        << v.z();
    return out.str();
  }

  std::string Geometry(int i, int j) const {
    const Mat3 ri = BundlerRotation(i);
    const Mat3 rij = ri * BundlerRotation(j).transpose();
    const Vec3 tij = (ri * (poses_[j].center - poses_[i].center)).normalized();
    return std::to_string(i) + " " + std::to_string(j) + Text(rij) + Text(tij) +
           "\n";
  }

  void WriteAll() {
    folder_.Write("cc.txt", "0\n1\n2\n4\n");
    folder_.Write("EGs.txt", Geometry(0, 1) + Geometry(2, 1) + Geometry(2, 4) +
                                 Geometry(0, 3) + Geometry(1, 2));
    folder_.Write("list.txt",
                  "images/a.jpg 0 650\nimages/b.jpg\nimages/c.jpg\nd.jpg\n"
                  "images/e.jpg 0 700\n");
    std::ostringstream coords, bundle, tracks;
    coords << std::setprecision(17);
    bundle << std::setprecision(17) << "# Bundle file v0.3\n"
           << kImages << " 1\n";
    for (int n = 0; n < kImages; ++n) {
      coords << "#index = " << n << ", name = images/" << n
             << ".jpg, keys = " << points_.size()
             << ", px = 400, py = 300, focal = " << (n == 2 ? 0 : kFocal)
             << "\n";
      for (std::size_t k = 0; k < points_.size(); ++k) {
        const Vec2 pixel = Pixel(n, points_[k]) + Vec2::Ones();
        coords << k << ' ' << pixel.x() << ' ' << pixel.y()
               << " 0 0 10 20 30\n";
      }
      if (n == 1) {
        bundle << "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";
      } else {
        const Mat3 r = BundlerRotation(n);
        bundle << kFocal << " 0 0\n"
               << Text(r) << "\n"
               << Text(Vec3(-(r * poses_[n].center))) << "\n";
      }
    }
    bundle << "0 0 0\n255 255 255\n0\n";
    tracks << points_.size() << "\n";
    for (std::size_t k = 0; k < points_.size(); ++k) {
      tracks << "5";
      for (int n = 0; n < kImages; ++n) tracks << ' ' << n << ' ' << k;
      tracks << "\n";
    }
    folder_.Write("coords.txt", coords.str());
    folder_.Write("gt_bundle.out", bundle.str());
    folder_.Write("tracks.txt", tracks.str());
  }

  Error FailureWith(const std::string& name, const std::string& content) {
    WriteAll();
    const std::string path = folder_.Write(name, content);
    const auto problem = onedsfm::ReadProblem(folder_.Path());
    if (problem) {
      ADD_FAILURE() << name << " was read: " << content;
      return {};
    }
    EXPECT_EQ(problem.error().file, path);
    return problem.error();
  }

  TemporaryFolder folder_;
  std::vector<Pose> poses_;
  std::vector<Vec3> points_;
};

TEST_F(OneDSfmFolder, GivesAValidScene) {
  const auto problem = onedsfm::ReadProblem(folder_.Path());
  ASSERT_TRUE(problem) << problem.error().ToString();
  const Scene& scene = problem->scene;
  const Status valid = ValidateScene(scene);
  EXPECT_TRUE(valid) << valid.error().ToString();
  ASSERT_EQ(scene.views.size(), 4u);
  EXPECT_EQ(scene.views.count(3), 0u);
  EXPECT_EQ(scene.views.at(4).filename, "e.jpg");
  EXPECT_EQ(scene.views.at(4).local_path, "images");
  EXPECT_EQ(scene.views.at(0).width_px, 800);
  EXPECT_EQ(scene.views.at(0).height_px, 600);
  EXPECT_EQ(scene.FindIntrinsic(2), nullptr);  // no focal length anywhere
  ASSERT_NE(scene.FindIntrinsic(0), nullptr);
  EXPECT_EQ(scene.FindIntrinsic(0)->fx_px, kFocal);  // coords before list
  EXPECT_TRUE(scene.poses.empty());
  EXPECT_EQ(scene.point_tracks.size(), 6u);
  EXPECT_EQ(scene.point_tracks.at(0).size(), 4u);
  EXPECT_EQ(problem->notes.size(), 3u);  // unused, repeated, no focal length
}

TEST_F(OneDSfmFolder, RelativePosesAreThoseOfTheCameras) {
  const auto problem = onedsfm::ReadProblem(folder_.Path());
  ASSERT_TRUE(problem);
  ASSERT_EQ(problem->scene.relative_poses.size(), 3u);
  for (const auto& [views, pose] : problem->scene.relative_poses) {
    const Pose& first = poses_[views.first.value()];
    const Pose& second = poses_[views.second.value()];
    EXPECT_LT(
        (pose.rotation - second.rotation * first.rotation.transpose()).norm(),
        1e-12);
    const Vec3 direction =
        (second.rotation * (first.center - second.center)).normalized();
    EXPECT_LT((pose.direction - direction).norm(), 1e-12);
    EXPECT_EQ(pose.point_inliers.size(), 6u);
  }
}

TEST_F(OneDSfmFolder, KeypointsAreSeenWhereTheIntrinsicsPutThem) {
  const auto problem = onedsfm::ReadProblem(folder_.Path());
  ASSERT_TRUE(problem);
  for (const std::uint32_t view : {0u, 1u, 4u}) {
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const Vec2 expected = problem->scene.FindIntrinsic(view)->Project(
          poses_[view].rotation * (points_[k] - poses_[view].center));
      EXPECT_LT(
          (problem->scene.features.at(view).points_px[k] - expected).norm(),
          1e-9);
    }
  }
}

TEST_F(OneDSfmFolder, TruePosesAreOursAndEmptyCamerasAreLeftOut) {
  const auto truth = onedsfm::ReadTrueCameras(folder_.Path());
  ASSERT_TRUE(truth) << truth.error().ToString();
  EXPECT_EQ(truth->poses.size(), 4u);
  EXPECT_EQ(truth->views.count(1), 0u);
  EXPECT_EQ(truth->views.at(4).filename, "e.jpg");
  for (const auto& [n, pose] : truth->poses) {
    EXPECT_LT((pose.rotation - poses_[n.value()].rotation).norm(), 1e-12);
    EXPECT_LT((pose.center - poses_[n.value()].center).norm(), 1e-12);
  }
}

// Though its ids are others.
TEST_F(OneDSfmFolder, IsATruthForScenesOfTheSameNames) {
  Scene scene;
  scene.views[7].local_path = scene.views[0].local_path = "images";
  scene.views[7].filename = "e.jpg";
  scene.views[0].filename = "c.png";
  const auto truth = ReadGroundTruth(folder_.Path(), scene);
  ASSERT_TRUE(truth) << truth.error().ToString();
  ASSERT_EQ(truth->size(), 2u);
  EXPECT_LT((truth->at(7).center - poses_[4].center).norm(), 1e-12);
  EXPECT_LT((truth->at(0).center - poses_[2].center).norm(), 1e-12);
}

TEST_F(OneDSfmFolder, GeometriesAloneAreEnough) {
  TemporaryFolder bare;
  bare.Write("sub/EGs.txt", Geometry(0, 1) + Geometry(1, 4));
  const auto problem = onedsfm::ReadProblem(bare.Path("sub"));
  ASSERT_TRUE(problem) << problem.error().ToString();
  EXPECT_EQ(problem->scene.views.size(), 3u);
  EXPECT_EQ(problem->scene.relative_poses.size(), 2u);
  EXPECT_TRUE(ValidateScene(problem->scene));
  const auto truth = onedsfm::ReadTrueCameras(bare.Path("sub"));
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().code, ErrorCode::kNotFound);
}

TEST_F(OneDSfmFolder, IsReadLikeAnySceneFile) {
  EXPECT_TRUE(onedsfm::IsProblemFolder(folder_.Path()));
  const auto scene = ReadScene(folder_.Path());
  ASSERT_TRUE(scene) << scene.error().ToString();
  EXPECT_EQ(*scene, onedsfm::ReadProblem(folder_.Path())->scene);
  TemporaryFolder other;
  EXPECT_FALSE(onedsfm::IsProblemFolder(other.Path("none")));
  EXPECT_FALSE(ReadScene(folder_.Path("cc.txt")));
}

TEST_F(OneDSfmFolder, ATrackThatSeesAnImageTwiceIsLeftOutThere) {
  folder_.Write("tracks.txt", "1\n4 0 1 0 2 1 1 2 1\n");
  const auto problem = onedsfm::ReadProblem(folder_.Path());
  ASSERT_TRUE(problem);
  const Track expected = {{1, 1}, {2, 1}};
  EXPECT_EQ(problem->scene.point_tracks.at(0), expected);
}

TEST_F(OneDSfmFolder, MissingGeometriesAreNamed) {
  std::filesystem::remove(folder_.Path("EGs.txt"));
  const auto problem = onedsfm::ReadProblem(folder_.Path());
  ASSERT_FALSE(problem);
  EXPECT_EQ(problem.error().code, ErrorCode::kNotFound);
  EXPECT_NE(problem.error().message.find("EGs.txt"), std::string::npos);
}

TEST_F(OneDSfmFolder, MalformedGeometriesAreErrorsWithALine) {
  const std::string good = Geometry(0, 1);
  Error error = FailureWith("EGs.txt", good + good.substr(0, 40));
  EXPECT_EQ(error.code, ErrorCode::kParse);
  EXPECT_EQ(error.place, "line 2");
  error = FailureWith("EGs.txt", good + "\n1 2 1 0 zero 0 1 0 0 0 1 1 0 0\n");
  EXPECT_EQ(error.place, "line 3");
  EXPECT_NE(error.message.find("'zero'"), std::string::npos);
  error = FailureWith("EGs.txt", "1 2 1 0 0 0 1 0 0 0 2 1 0 0\n");
  EXPECT_NE(error.message.find("no rotation"), std::string::npos);
  error = FailureWith("EGs.txt", "1 2 1 0 0 0 1 0 0 0 1 0 0 0\n");
  EXPECT_NE(error.message.find("no length"), std::string::npos);
  error = FailureWith("EGs.txt", "1 2 1 0 0 0 1 0 0 0 1 1e200 0 0\n");
  EXPECT_NE(error.message.find("no length"), std::string::npos);
  error = FailureWith("EGs.txt", "2 2 1 0 0 0 1 0 0 0 1 1 0 0\n");
  EXPECT_NE(error.message.find("itself"), std::string::npos);
  error = FailureWith("EGs.txt", "1 2 1 0 0 0 1 0 0 0 1 1 0 nan\n");
  EXPECT_EQ(error.code, ErrorCode::kParse);
  error = FailureWith("EGs.txt", "-1 2 1 0 0 0 1 0 0 0 1 1 0 0\n");
  EXPECT_EQ(error.code, ErrorCode::kParse);
}

TEST_F(OneDSfmFolder, OtherMalformedFilesAreErrorsWithAPlace) {
  Error error = FailureWith("cc.txt", "0\n1\ntwo\n");
  EXPECT_EQ(error.place, "line 3");
  error = FailureWith("list.txt", "a.jpg\nb.jpg 0 wide\n");
  EXPECT_EQ(error.place, "line 2");
  error = FailureWith("list.txt", "a.jpg\nb.jpg\n");
  EXPECT_EQ(error.code, ErrorCode::kInvalidScene);
  error = FailureWith("list.txt", "a.jpg\nb\xFF.jpg\n");
  EXPECT_EQ(error.place, "line 2");
  EXPECT_NE(error.message.find("'b\\xFF.jpg' is not UTF-8"), std::string::npos);
  error = FailureWith("coords.txt", "#index = 0, keys = 2\n");
  EXPECT_EQ(error.place, "line 1");
  for (const char* wrong : {"name = \xFF, keys = 0, px = 4, py = 3",
                            "name = a, keys = 0, px = -4, py = 3",
                            "name = a, keys = 0, px = 4, py = 1e10"}) {
    error = FailureWith("coords.txt",
                        std::string("#index = 0, ") + wrong + ", focal = 5\n");
    EXPECT_EQ(error.code, ErrorCode::kParse) << wrong;
    EXPECT_EQ(error.place, "line 1") << wrong;
  }
  error = FailureWith("coords.txt",
                      "#index = 0, name = a, keys = 2, px = 4, py = 3, focal = "
                      "5\n0 1 1 0 0 0 0 0\n");
  EXPECT_EQ(error.code, ErrorCode::kParse);
  error = FailureWith("coords.txt",
                      "#index = 0, name = a, keys = 0, px = 4, py = 3, focal = "
                      "5\n");
  EXPECT_EQ(error.code, ErrorCode::kInvalidScene);
  error = FailureWith("tracks.txt", "2\n2 0 0 1 0\n");
  EXPECT_EQ(error.code, ErrorCode::kParse);
  error = FailureWith("tracks.txt", "1\n2 0 0 1 0\n2 0 1 1 1\n");
  EXPECT_NE(error.message.find("more than the 1 tracks"), std::string::npos);
  error = FailureWith("tracks.txt", "1\n2 0 0 1 99\n");
  EXPECT_EQ(error.code, ErrorCode::kInvalidScene);
  EXPECT_EQ(error.place, "track 0");
}

TEST_F(OneDSfmFolder, ATruncatedBundleIsAnError) {
  const std::string path =
      folder_.Write("gt_bundle.out", "# Bundle file v0.3\n2 0\n700 0 0\n1 0 0");
  const auto truth = onedsfm::ReadTrueCameras(folder_.Path());
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().code, ErrorCode::kParse);
  EXPECT_EQ(truth.error().file, path);
  EXPECT_EQ(truth.error().place, "line 4");
}

}  // namespace
}  // namespace lowlap
