#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/geometry/similarity.h"
#include "lowlap/scene/scene.h"

namespace lowlap::test {

/// Cameras in a row, 1.2 m apart, look at four walls of different tilt, 4 to
/// 10 m away, that carry points and lines; metres, 1200 x 800 px.
struct TestSceneOptions {
  int num_views = 6;
  int num_points = 400;
  int num_lines = 150;
  /// A track is seen by so many consecutive views at most.
  int max_point_views = 6;
  int max_line_views = 6;
  double noise_px = 0;
  /// Share of the observations that lie anywhere in the image.
  double point_outliers = 0;
  double line_outliers = 0;
  /// Coplanar inliers for consecutive triplets: lines of one wall, the first
  /// seen in (first, middle), the second in (middle, last).
  int pairs_per_triplet = 0;
  double wrong_pairs = 0;  // share of pairs whose lines are of two walls
  /// Only the first wall, which faces the cameras.
  bool frontal_wall_only = false;
  CameraModel model = CameraModel::kPinhole;
  std::vector<double> distortion;
  std::uint64_t seed = 1;
};

struct TestScene {
  Scene scene;  // with the true poses, no structure
  std::map<PoseId, Pose> true_poses;
  std::map<PointTrackId, Vec3> true_points;
  std::map<LineTrackId, PluckerLine> true_lines;
  std::map<LineTrackId, int> wall_of_line;
  std::vector<FeatureRef> outlier_points;
  std::vector<FeatureRef> outlier_segments;
};

TestScene MakeTestScene(const TestSceneOptions& options);

/// Turns every camera by about angle_rad and moves it by about distance.
void PerturbPoses(double angle_rad, double distance, std::uint64_t seed,
                  Scene* scene);

/// Rebuilds the centres of the row with every baseline scaled by
/// exp(N(0, log_stddev)): what errors of scale ratios do to a chain.
void PerturbScales(double log_stddev, std::uint64_t seed, Scene* scene);

/// Moves all points of a part of an image alike.
void AddCommonErrors(double stddev_px, std::uint64_t seed, Scene* scene);

struct PoseErrors {
  double mean_center = 0;  // after a similarity alignment, world units
  double max_center = 0;
  double max_rotation_rad = 0;
};
PoseErrors ComparePoses(const std::map<PoseId, Pose>& truth,
                        const Scene& scene);

/// By which the centres miss the true ones, once the least similarity has moved
/// these to them.
std::map<PoseId, Vec3> CenterErrors(const TestScene& test);

/// The mean of their squares over the variances that are stated: 1 if these
/// hold.
double NormalisedCenterError(const TestScene& test);

/// The structure from the poses, adjusted; expects that both succeed and leave
/// a valid scene.
AdjustmentSummary BuildAndAdjust(Scene* scene,
                                 const AdjustmentOptions& options = {});

/// Poses and structure (not the features) in a world moved by `similarity`.
Scene Transformed(const Scene& scene, const Similarity& similarity);

}  // namespace lowlap::test
