// `lowlap compare` and `lowlap solve` on a problem folder of 1DSfM.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iomanip>
#include <map>
#include <sstream>
#include <string>

#include "cli_fixture.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const Vec3 kAxes(1, -1, -1);

std::string Text(const Mat3& m) {
  std::ostringstream out;
  out << std::setprecision(17);
  for (int n = 0; n < 9; ++n) out << ' ' << m(n / 3, n % 3);
  return out.str();
}

std::string Text(const Vec3& v) {
  std::ostringstream out;
  out << std::setprecision(17) << ' ' << v.x() << ' ' << v.y() << ' ' << v.z();
  return out.str();
}

/// A simulated room of eight views as the data sets of 1DSfM are written.
class ProblemFolder : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    SyntheticOptions options;
    options.num_views = 8;
    options.pairs = "window:3";
    options.points_per_wall = 60;
    options.lines_per_wall = 0;
    options.noise_px = 0.5;
    options.pose_noise_factor = 1;
    synthetic_ = *Simulate(options);
    std::string geometries;
    for (const auto& [pair, edge] : synthetic_.scene.relative_poses) {
      const Mat3 first_from_second = edge.rotation.transpose();
      const Mat3 r = kAxes.asDiagonal() * first_from_second;
      geometries += std::to_string(pair.first.value()) + " " +
                    std::to_string(pair.second.value()) +
                    Text(Mat3(r * kAxes.asDiagonal())) +
                    Text(Vec3(-(r * edge.direction))) + "\n";
    }
    Write("EGs.txt", geometries);
    std::ostringstream bundle;
    bundle << "# Bundle file v0.3\n8 0\n";
    for (const auto& [view, pose] : synthetic_.true_poses) {
      const Mat3 r = kAxes.asDiagonal() * pose.rotation;
      bundle << "900 0 0\n"
             << Text(r) << "\n"
             << Text(Vec3(-(r * pose.center))) << "\n";
    }
    Write("gt_bundle.out", bundle.str());
  }

  // Keypoints and tracks; views from `first_without_focal` on have no focal
  // length.
  void WriteTracks(ViewId first_without_focal) const {
    std::ostringstream coords, tracks;
    coords << std::setprecision(17);
    for (const auto& [view, features] : synthetic_.scene.features) {
      coords << "#index = " << view << ", name = images/" << view
             << ".jpg, keys = " << features.points_px.size()
             << ", px = 600, py = 450, focal = "
             << (view < first_without_focal ? 900 : 0) << "\n";
      for (std::size_t k = 0; k < features.points_px.size(); ++k) {
        const auto& point = features.points_px[k];
        coords << k << ' ' << point.x() + 1 << ' ' << point.y() + 1
               << " 0 0 10 20 30\n";
      }
    }
    tracks << synthetic_.scene.point_tracks.size() << "\n";
    for (const auto& [id, track] : synthetic_.scene.point_tracks) {
      tracks << track.size();
      for (const FeatureRef& ref : track) {
        tracks << ' ' << ref.view << ' ' << ref.feature;
      }
      tracks << "\n";
    }
    Write("coords.txt", coords.str());
    Write("tracks.txt", tracks.str());
  }

  Outcome Compare(const std::string& arguments) const {
    return Lowlap("compare " + folder_.string() + " --gt " + folder_.string() +
                  " -o " + Path("out") + " " + arguments);
  }

  SyntheticScene synthetic_;
};

TEST_F(ProblemFolder, IsComparedAgainstItsReference) {
  WriteTracks(8);
  const Outcome compared = Compare("--strategies graph,lud,global_positioning");
  ASSERT_EQ(compared.exit_code, 0) << compared.output;
  EXPECT_THAT(compared.output, HasSubstr("error after"));
  for (const char* row : {"graph", "lud", "global_positioning"}) {
    EXPECT_THAT(compared.output, HasSubstr(row));
  }
  EXPECT_THAT(compared.output, HasSubstr("8/8"));
  EXPECT_THAT(compared.output, Not(HasSubstr("0/8")));
}

// Only strategies on directions can do something.
TEST_F(ProblemFolder, GeometriesAloneAreEnoughForDirections) {
  const Outcome compared = Compare("--strategies graph,lud --no-adjust");
  ASSERT_EQ(compared.exit_code, 0) << compared.output;
  EXPECT_THAT(compared.output, HasSubstr("8/8"));
}

TEST_F(ProblemFolder, ViewsWithoutFocalLengthDoNotStopIt) {
  WriteTracks(6);
  const Outcome compared = Compare("--strategies graph,lud");
  ASSERT_EQ(compared.exit_code, 0) << compared.output;
  EXPECT_THAT(compared.output, HasSubstr("8/8"));
  const Outcome solved =
      Lowlap("solve " + folder_.string() + " -o " + Path("solved"));
  ASSERT_EQ(solved.exit_code, 0) << solved.output;
  EXPECT_THAT(solved.output, HasSubstr("focal length"));
  EXPECT_TRUE(std::filesystem::exists(Path("solved") + "/scene.lowlap"));
}

TEST_F(ProblemFolder, WhatIsLeftOutIsSaid) {
  Write("cc.txt", "0\n1\n2\n3\n4\n5\n6\n");
  const Outcome compared = Compare("--strategies lud --no-adjust");
  ASSERT_EQ(compared.exit_code, 0) << compared.output;
  EXPECT_THAT(compared.output, HasSubstr("warning: "));
  EXPECT_THAT(compared.output, HasSubstr("not used"));
  // The same words, whichever command reads the folder.
  const Outcome inspected = Lowlap("inspect " + folder_.string());
  const Outcome converted =
      Lowlap("convert " + folder_.string() + " " + Path("a.lowlap"));
  ASSERT_EQ(converted.exit_code, 0) << converted.output;
  EXPECT_THAT(converted.output, HasSubstr("not used"));
  EXPECT_EQ(converted.output,
            inspected.output.substr(0, converted.output.size()));
}

}  // namespace
}  // namespace lowlap
