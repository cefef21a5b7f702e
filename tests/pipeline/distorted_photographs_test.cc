// Photographs with a strong barrel distortion are measured as well as the same
// ones without.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "lowlap/evaluation/internal/relative_errors.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/measure_images.h"
#include "support/data_folder.h"
#include "support/matchers.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::IsOk;

// The lens that shows the corners of the pinhole's photograph in its own.
Intrinsic Distorted(const Intrinsic& pinhole, double k1) {
  Intrinsic lens = pinhole;
  lens.model = CameraModel::kRadialK1;
  lens.distortion = {k1};
  const double r2 =
      std::pow(0.5 * pinhole.ImageDiagonal() / pinhole.MeanFocalPx(), 2);
  lens.fx_px /= 1 + k1 * r2;
  lens.fy_px /= 1 + k1 * r2;
  return lens;
}

// Writes what the lens would have shown.
void Warp(const std::string& from, const Intrinsic& pinhole,
          const Intrinsic& lens, const std::string& to) {
  const cv::Mat image = cv::imread(from, cv::IMREAD_GRAYSCALE);
  cv::Mat map(image.size(), CV_32FC2), warped;
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.cols; ++x) {
      const Vec2 p = pinhole.Project(*lens.Bearing(Vec2(x, y)));
      map.at<cv::Vec2f>(y, x) = {static_cast<float>(p.x()),
                                 static_cast<float>(p.y())};
    }
  }
  cv::remap(image, warped, map, cv::noArray(), cv::INTER_CUBIC,
            cv::BORDER_REPLICATE);
  cv::imwrite(to, warped);
}

struct Quality {
  std::size_t poses = 0, points = 0, lines = 0;
  ErrorStatistics rotation_deg, direction_deg;
};

Quality Measure(Scene scene) {
  MeasurementOptions options;
  options.pairs = "cycle";
  options.features.tilts.max_tilt = 1;
  StageLog stages;
  Quality quality;
  EXPECT_THAT(MeasureImages(&scene, options, {}, &stages), IsOk());
  quality.poses = scene.relative_poses.size();
  for (const auto& [views, pose] : scene.relative_poses) {
    quality.points += pose.point_inliers.size();
    quality.lines += pose.line_inliers.size();
  }
  const auto truth = strecha::ReadGroundTruth(RoomFolder());
  EXPECT_THAT(truth, IsOk());
  const RelativePoseEvaluation errors =
      EvaluateRelativePoses(scene, *GroundTruthByName(scene, *truth));
  quality.rotation_deg = errors.rotation_deg;
  quality.direction_deg = errors.direction_deg;
  std::printf(
      "%zu poses, %zu points, %zu lines, median errors %.3f and %.3f degrees\n",
      quality.poses, quality.points, quality.lines, quality.rotation_deg.median,
      quality.direction_deg.median);
  return quality;
}

// The photographs of the room as a lens with this k1 would have shown them,
// which is known.
Scene SeenThrough(const Scene& straight, double k1, const std::string& folder) {
  const Intrinsic& pinhole = straight.intrinsics.at(0);
  IntrinsicSource known;
  known.scene.emplace();
  known.scene->intrinsics[0] = Distorted(pinhole, k1);
  fs::create_directories(folder);
  for (const auto& [id, view] : straight.views) {
    Warp(straight.ImagePath(id), pinhole, known.scene->intrinsics[0],
         folder + "/" + fs::path(view.filename).stem().string() + ".png");
  }
  const auto scene = SceneFromImages(folder, known, {});
  EXPECT_THAT(scene, IsOk());
  return *scene;
}

TEST(DistortedPhotographs, AreMeasuredAsWellAsStraightOnes) {
  const std::string folder =
      (fs::temp_directory_path() /
       ("lowlap_distorted_" + std::to_string(::getpid())))
          .string();
  IntrinsicSource source;
  source.calibration =
      *strecha::ReadCalibrationMatrix(RoomFolder() + "/images/K.txt");
  const auto straight = SceneFromImages(RoomFolder() + "/images", source, {});
  ASSERT_THAT(straight, IsOk());
  // Resampled as well: that alone moves the medians of eleven pairs.
  const Scene hardly = SeenThrough(*straight, -0.001, folder + "/hardly");
  const Scene distorted = SeenThrough(*straight, -0.2, folder + "/distorted");
  const Quality without = Measure(hardly);
  const Quality with = Measure(distorted);
  // The same photographs taken for straight ones.
  Scene ignored = distorted;
  ignored.intrinsics[0].model = CameraModel::kPinhole;
  ignored.intrinsics[0].distortion.clear();
  const Quality unknown = Measure(ignored);
  fs::remove_all(folder);

  EXPECT_GE(with.poses, without.poses);
  EXPECT_GT(with.points, 0.85 * without.points);
  EXPECT_GT(with.lines, 0.85 * without.lines);
  EXPECT_LT(with.rotation_deg.median, 1.25 * without.rotation_deg.median);
  EXPECT_LT(with.direction_deg.median, 1.25 * without.direction_deg.median);
  EXPECT_GT(unknown.rotation_deg.median, 5 * with.rotation_deg.median);
}

}  // namespace
}  // namespace lowlap
