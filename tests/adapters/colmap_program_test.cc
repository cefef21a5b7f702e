// The real COLMAP, where it is installed: its database is solved, and its tools
// take what is exported.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <regex>
#include <sstream>

#include "adapters/temporary_folder.h"
#include "cli/cli_fixture.h"
#include "support/data_folder.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {
namespace {

bool HasColmap() {
  return std::system("command -v colmap > /dev/null 2>&1") == 0;
}

Outcome Shell(const std::string& command) {
  Outcome outcome;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) {
    outcome.output.append(buffer, n);
  }
  const int status = ::pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

Outcome Colmap(const std::string& arguments) {
  return Shell("QT_QPA_PLATFORM=offscreen colmap " + arguments);
}

double MeanErrorPx(const Landmark& landmark, const Scene& scene) {
  double sum_px = 0;
  for (const PointObservation& observation : landmark.observations) {
    const Vec3 in_cam =
        scene.FindPose(observation.view)->CamFromWorld() * landmark.position;
    sum_px += (scene.FindIntrinsic(observation.view)->Project(in_cam) -
               observation.pixel_px)
                  .norm();
  }
  return sum_px / static_cast<double>(landmark.observations.size());
}

struct Errors {
  std::size_t num_residuals = 0;
  double cost_px = 0;         // as COLMAP's adjustment reports it
  double mean_of_points = 0;  // as its analysis does
};

Errors ReprojectionErrors(const Scene& scene) {
  Errors errors;
  double squares = 0;
  for (const auto& [id, landmark] : scene.structure) {
    for (const PointObservation& observation : landmark.observations) {
      const Vec3 in_cam =
          scene.FindPose(observation.view)->CamFromWorld() * landmark.position;
      squares += (scene.FindIntrinsic(observation.view)->Project(in_cam) -
                  observation.pixel_px)
                     .squaredNorm();
      errors.num_residuals += 2;
    }
    errors.mean_of_points += MeanErrorPx(landmark, scene) /
                             static_cast<double>(scene.structure.size());
  }
  errors.cost_px =
      std::sqrt(0.5 * squares / static_cast<double>(errors.num_residuals));
  return errors;
}

// The number that COLMAP prints behind a name.
double Printed(const std::string& output, const std::string& name) {
  std::smatch match;
  const std::regex pattern(name + R"( *: ([-+.0-9e]+))");
  return std::regex_search(output, match, pattern) ? std::stod(match[1]) : NAN;
}

class RealColmap : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasColmap()) GTEST_SKIP() << "skipped: no colmap";
  }
  std::string Path(const std::string& name) const { return folder_.Path(name); }
  std::string Folder(const std::string& name) const {
    std::filesystem::create_directories(Path(name));
    return Path(name);
  }
  static void ExpectDone(const Outcome& outcome) {
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  }
  static Scene Read(const std::string& path) {
    const auto scene = ReadScene(path);
    EXPECT_TRUE(scene.has_value()) << scene.error().ToString();
    return scene ? *scene : Scene();
  }

  TemporaryFolder folder_;
};

TEST_F(RealColmap, SolvesItsDatabaseAndTakesTheResult) {
  const std::string sample = RoomFolder();
  const std::string database = Path("database.db");
  const std::string images = sample + "/images";
  double fx = 0, fy = 0, cx = 0, cy = 0, zero = 0;
  {
    std::ifstream k(images + "/K.txt");
    ASSERT_TRUE(k >> fx >> zero >> cx >> zero >> fy >> cy);
  }
  std::ofstream list(Path("list.txt"));
  for (const auto& entry : std::filesystem::directory_iterator(images)) {
    if (entry.path().extension() == ".jpg") {
      list << entry.path().filename().string() << "\n";
    }
  }
  list.close();
  std::ostringstream params;
  params << fx << "," << fy << "," << cx + 0.5 << "," << cy + 0.5;
  ExpectDone(Colmap("feature_extractor --database_path " + database +
                    " --image_path " + images + " --image_list_path " +
                    Path("list.txt") +
                    " --ImageReader.single_camera 1 --ImageReader.camera_model "
                    "PINHOLE --ImageReader.camera_params " +
                    params.str() + " --SiftExtraction.use_gpu 0"));
  ExpectDone(Colmap("exhaustive_matcher --database_path " + database +
                    " --SiftMatching.use_gpu 0"));

  const Outcome solved =
      Lowlap("solve " + database + " --images " + images + " --gt " + sample +
             "/gt_dense_cameras -o " + Path("out"));
  ExpectDone(solved);
  std::cout << solved.output;
  for (const std::string format : {"colmap", "colmap-bin"}) {
    ExpectDone(Lowlap("convert " + Path("out") + "/scene.lowlap " +
                      Path(format) + " --to " + format));
  }
  const Scene exported = Read(Path("colmap-bin"));
  ASSERT_GE(exported.poses.size(), 3u);
  ASSERT_GE(exported.structure.size(), 50u);

  // Of either form, COLMAP sees the same scene as we do.
  const Errors ours = ReprojectionErrors(exported);
  for (const std::string format : {"colmap", "colmap-bin"}) {
    const Outcome analyzed = Colmap("model_analyzer --path " + Path(format));
    ExpectDone(analyzed);
    EXPECT_EQ(Printed(analyzed.output, "Registered images"),
              static_cast<double>(exported.poses.size()));
    EXPECT_EQ(Printed(analyzed.output, "Points"),
              static_cast<double>(exported.structure.size()));
    EXPECT_NEAR(Printed(analyzed.output, "Mean reprojection error"),
                ours.mean_of_points, 1e-6);
  }
  // Its adjustment starts from the errors that we compute.
  const Outcome adjusted =
      Colmap("bundle_adjuster --input_path " + Path("colmap-bin") +
             " --output_path " + Folder("adjusted") +
             " --BundleAdjustment.refine_focal_length 0"
             " --BundleAdjustment.refine_extra_params 0");
  ExpectDone(adjusted);
  EXPECT_EQ(Printed(adjusted.output, "Residuals"),
            static_cast<double>(ours.num_residuals));
  EXPECT_NEAR(Printed(adjusted.output, "Initial cost"), ours.cost_px, 1e-6);
  const Errors after = ReprojectionErrors(Read(Path("adjusted")));
  EXPECT_NEAR(Printed(adjusted.output, "Final cost"), after.cost_px, 1e-6);

  // Its database's matches are triangulated on our poses; the errors that it
  // stores are those that we compute.
  ExpectDone(Colmap("point_triangulator --database_path " + database +
                    " --image_path " + images + " --input_path " +
                    Path("colmap-bin") + " --output_path " +
                    Folder("triangulated")));
  ExpectDone(Colmap("model_converter --input_path " + Path("triangulated") +
                    " --output_path " + Folder("text") + " --output_type TXT"));
  const Scene triangulated = Read(Path("triangulated"));
  EXPECT_EQ(triangulated.poses.size(), exported.poses.size());
  // COLMAP normalises quaternions whenever it reads them, here once more.
  Scene as_text = Read(Path("text"));
  ASSERT_EQ(as_text.poses.size(), triangulated.poses.size());
  for (auto& [id, pose] : as_text.poses) {
    const Pose& binary = triangulated.poses.at(id);
    EXPECT_LT((pose.rotation - binary.rotation).norm(), 1e-14);
    EXPECT_LT((pose.center - binary.center).norm(),
              1e-14 * (1 + binary.center.norm()));
    pose = binary;
  }
  EXPECT_TRUE(as_text == triangulated);
  std::ifstream points(Path("text") + "/points3D.txt");
  std::size_t compared = 0;
  for (std::string line; std::getline(points, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream numbers(line);
    std::uint32_t id = 0;
    double skipped = 0, theirs_px = 0;
    numbers >> id;
    for (int n = 0; n < 6; ++n) numbers >> skipped;
    ASSERT_TRUE(numbers >> theirs_px) << line;
    ASSERT_EQ(triangulated.structure.count(id), 1u);
    EXPECT_NEAR(MeanErrorPx(triangulated.structure.at(id), triangulated),
                theirs_px, 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 20u);
}

}  // namespace
}  // namespace lowlap
