// What the relative pose of a pair costs. "relative_cost" is the processor time
// over that of OpenCV's MAGSAC essential matrix with a known threshold on the
// same matches, "..._error_deg" how far either rotation is from the true one
// at the median of several scenes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "benchmarks/processor_time.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::kFocalPx;
using testing::ProcessorSeconds;

constexpr int kNumScenes = 8;
constexpr int kNumMatches = 1000;
constexpr double kNoisePx = 0.5;

std::vector<testing::TwoViewScene> Scenes(int wrong_percent) {
  testing::TwoViewSceneOptions options;
  options.num_wrong = kNumMatches * wrong_percent / 100;
  options.num_right = kNumMatches - options.num_wrong;
  options.noise_px = kNoisePx;
  std::vector<testing::TwoViewScene> scenes;
  for (int seed = 0; seed < kNumScenes; ++seed) {
    scenes.push_back(testing::MakeTwoViewScene(options, seed));
  }
  return scenes;
}

std::vector<cv::Point2d> PixelsOf(const std::vector<Vec3>& points) {
  std::vector<cv::Point2d> pixels;
  for (const Vec3& point : points) {
    pixels.emplace_back(kFocalPx * point.x(), kFocalPx * point.y());
  }
  return pixels;
}

Mat3 RotationByOpenCv(const testing::TwoViewScene& scene) {
  const std::vector<cv::Point2d> first = PixelsOf(scene.features1.points);
  const std::vector<cv::Point2d> second = PixelsOf(scene.features2.points);
  const cv::Matx33d camera(kFocalPx, 0, 0, 0, kFocalPx, 0, 0, 0, 1);
  cv::Mat inliers, rotation, translation;
  const cv::Mat essential = cv::findEssentialMat(
      first, second, camera, cv::USAC_MAGSAC, 0.9999, 3 * kNoisePx, inliers);
  cv::recoverPose(essential, first, second, camera, rotation, translation,
                  inliers);
  Mat3 result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      result(row, column) = rotation.at<double>(row, column);
    }
  }
  return result;
}

void RelativePoseAgainstMagsac(benchmark::State& state) {
  const std::vector<testing::TwoViewScene> scenes =
      Scenes(static_cast<int>(state.range(0)));
  cv::setNumThreads(1);
  double ours = 0, reference = 0;
  std::vector<double> our_errors_deg, reference_errors_deg;
  for (auto _ : state) {
    for (const testing::TwoViewScene& scene : scenes) {
      const Mat3& truth = scene.cam2_from_cam1.rotation;
      reference += ProcessorSeconds([&] {
        reference_errors_deg.push_back(
            testing::RotationErrorDeg(RotationByOpenCv(scene), truth));
      });
      ours += ProcessorSeconds([&] {
        const auto result = EstimateRelativePose(scene.Input(), {}, 1);
        our_errors_deg.push_back(
            result ? testing::RotationErrorDeg(result->pose.rotation, truth)
                   : 180.0);
      });
    }
  }
  state.counters["relative_cost"] = ours / reference;
  state.counters["error_deg"] = Median(our_errors_deg);
  state.counters["reference_error_deg"] = Median(reference_errors_deg);
}
BENCHMARK(RelativePoseAgainstMagsac)
    ->ArgName("wrong_percent")
    ->Arg(0)
    ->Arg(30)
    ->Arg(60)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
