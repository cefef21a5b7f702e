#include "lowlap/adjustment/internal/rounds/measurement_cost.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "test_scene.h"

namespace lowlap {
namespace {

using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;

constexpr NoiseScale kNoise{0.5, 2};
constexpr double kWorth = 16;  // of one observation: (t / s)^2

double CostOf(const Scene& scene,
              const std::vector<RelativePosePrior>& priors = {}) {
  const CameraSet cameras(scene);
  StructureState state;
  state.priors = priors;
  state.points = LoadPoints(scene, cameras);
  state.lines = LoadLines(scene, cameras, false);
  const Result<double> cost =
      MeasurementCost(cameras, state, {kNoise, kNoise, kNoise}, 0, {});
  return cost ? *cost : std::numeric_limits<double>::quiet_NaN();
}

TEST(MeasurementCostTest, NothingWithoutErrors) {
  EXPECT_NEAR(CostOf(MakeTestScene({}).scene), 0, 1e-6);
}

TEST(MeasurementCostTest, AFalseObservationCostsItsWorth) {
  TestScene test = MakeTestScene({});
  for (const auto& [id, track] : test.scene.point_tracks) {
    if (track.size() < 4) continue;
    const FeatureRef& ref = track.front();
    test.scene.features.at(ref.view).points_px[ref.feature] += Vec2(0, 300);
    break;
  }
  EXPECT_NEAR(CostOf(test.scene), kWorth, 1e-6);
}

TEST(MeasurementCostTest, TracksOfTwoViewsAreNotAsked) {
  TestSceneOptions options;
  options.max_point_views = 2;
  options.max_line_views = 2;
  options.noise_px = 1;
  options.point_outliers = 0.2;
  EXPECT_EQ(CostOf(MakeTestScene(options).scene), 0);
}

// The points of two views alone, whose relative pose is known; then the second
// view is turned by so much.
struct Pair {
  std::size_t num_points = 0;
  double cost = 0;
};

Pair TurnedPair(double degrees) {
  TestSceneOptions options;
  options.max_point_views = 2;
  options.max_line_views = 2;
  Scene scene = MakeTestScene(options).scene;
  auto& [views, measured] = *scene.relative_poses.begin();
  measured.covariance = 1e-6 * Eigen::Matrix<double, 5, 5>::Identity();
  Pair pair;
  for (const auto& [id, track] : scene.point_tracks) {
    pair.num_points +=
        track.front().view == views.first && track.back().view == views.second;
  }
  const auto priors = LoadRelativePosePriors(scene, CameraSet(scene));
  Pose& pose = scene.poses.at(scene.views.at(views.second).pose_id);
  pose.rotation = RotationFromAngleAxis(RadFromDeg(degrees) * Vec3::UnitX()) *
                  pose.rotation;
  pair.cost = CostOf(scene, priors);
  return pair;
}

TEST(MeasurementCostTest, ARelativePoseThatIsLeftAltogetherCosts) {
  EXPECT_EQ(TurnedPair(0).cost, 0);
  EXPECT_EQ(TurnedPair(8).cost, 0);  // though no point fits
  const Pair pair = TurnedPair(20);
  ASSERT_GT(pair.num_points, 10u);
  const double all = kWorth * static_cast<double>(pair.num_points);
  EXPECT_GT(pair.cost, 0.7 * all);
  EXPECT_LE(pair.cost, all);
}

// With a point's three unknowns, or a line's four, found from the track.
template <class Tracks>
double DegreesOfFreedom(const Tracks& tracks, int unknowns) {
  double sum = 0;
  for (const auto& [id, track] : tracks) {
    if (track.size() > 2) sum += 2.0 * track.size() - unknowns;
  }
  return sum;
}

TEST(MeasurementCostTest, IsAChiSquareOfEitherKind) {
  TestSceneOptions options;
  options.noise_px = kNoise.stddev_px;
  options.num_points = 400;
  options.num_lines = 400;
  options.pairs_per_triplet = 0;
  const Scene scene = MakeTestScene(options).scene;
  Scene points = scene, lines = scene;
  points.line_tracks.clear();
  lines.point_tracks.clear();
  const double of_points = DegreesOfFreedom(scene.point_tracks, 3);
  const double of_lines = DegreesOfFreedom(scene.line_tracks, 4);
  ASSERT_GT(of_points, 500);
  ASSERT_GT(of_lines, 500);
  EXPECT_NEAR(CostOf(points) / of_points, 1, 0.15);
  EXPECT_NEAR(CostOf(lines) / of_lines, 1, 0.15);
}

// However far off they are: what is out counts as such.
TEST(MeasurementCostTest, DriftCosts) {
  TestSceneOptions options;
  options.noise_px = 0.3;
  TestScene test = MakeTestScene(options);
  const double right = CostOf(test.scene);
  test::PerturbScales(0.02, 1, &test.scene);
  const double drifted = CostOf(test.scene);
  test::PerturbScales(0.2, 1, &test.scene);
  EXPECT_GT(drifted, 1.5 * right);
  EXPECT_GT(CostOf(test.scene), drifted);
}

}  // namespace
}  // namespace lowlap
