#include "lowlap/adjustment/internal/structure/point_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/internal/random.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;

constexpr double kNoisePx = 0.4;

// Every second point lies on grain: its shape is long. Its errors are drawn
// from ratio^exponent along the grain.
TestScene SceneOnGrain(double exponent, double variance_ratio, int max_views,
                       std::uint64_t seed) {
  TestSceneOptions options;
  options.max_point_views = max_views;
  options.num_lines = 0;
  options.seed = seed;
  TestScene test = MakeTestScene(options);
  Random random(seed + 100);
  for (auto& [view, features] : test.scene.features) {
    for (std::size_t n = 0; n < features.points_px.size(); ++n) {
      const double ratio = n % 2 ? variance_ratio : 1;
      // The grain runs roughly one way, as it does on a floor.
      const double angle = random.Uniform(-0.3, 0.3);
      const Vec2 along(std::cos(angle), std::sin(angle));
      const Mat2 shape =
          Mat2::Identity() + (ratio - 1) * along * along.transpose();
      features.point_covariances.emplace_back(shape(0, 0), shape(0, 1),
                                              shape(1, 1));
      const double u = random.Gaussian(kNoisePx);
      const double stretch = std::pow(ratio, 0.5 * exponent);
      features.points_px[n] +=
          stretch * u * along +
          random.Gaussian(kNoisePx) * Vec2(-along.y(), along.x());
    }
  }
  return test;
}

AdjustmentSummary Adjust(TestScene* test) {
  const RunContext context;
  EXPECT_TRUE(BuildStructure(&test->scene, {}, context).has_value());
  auto summary = AdjustScene(&test->scene, {}, context);
  EXPECT_TRUE(summary.has_value());
  return summary ? *summary : AdjustmentSummary{};
}

TEST(PointShape, WhiteningInvertsTheCovariance) {
  const Vec3 covariance(3, 1.2, 1.5);
  const PointShape shape = PointShape::FromCovariance(covariance);
  const Mat2 matrix = (Mat2() << 3, 1.2, 1.2, 1.5).finished();
  const Mat2 whitening = shape.Whitening(1);
  const Mat2 white = whitening * matrix * whitening.transpose();
  EXPECT_NEAR(white(0, 1), 0, 1e-12);
  EXPECT_NEAR(white(0, 0), white(1, 1), 1e-12);
  EXPECT_TRUE(shape.Whitening(0).isApprox(Mat2::Identity(), 1e-15));
  EXPECT_TRUE(PointShape::FromCovariance({2, 0, 2}).Whitening(1).isApprox(
      Mat2::Identity(), 1e-12));
}

TEST(PointShape, OfANearlySingularCovarianceIsFinite) {
  const PointShape shape =
      PointShape::FromCovariance({3, 1.7320508075688772, 1});
  EXPECT_TRUE(std::isfinite(shape.log_variance_ratio));
  EXPECT_TRUE(shape.Whitening(1).allFinite());
}

TEST(PointShape, ExponentIsThatOfTheErrors) {
  for (const double exponent : {0.0, 0.5, 1.0}) {
    TestScene test = SceneOnGrain(exponent, 20, 6, 3);
    EXPECT_NEAR(Adjust(&test).point_shape_exponent, exponent, 0.15);
  }
}

TEST(PointShape, ExponentStaysInTheMiddleWithoutThreeViews) {
  TestScene test = SceneOnGrain(1, 20, 2, 3);
  EXPECT_DOUBLE_EQ(Adjust(&test).point_shape_exponent, 0.5);
}

TEST(PointShape, PointsOnGrainDoLessHarm) {
  double with_shapes = 0, without = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    TestScene known = SceneOnGrain(1, 100, 6, seed);
    TestScene unknown = known;
    for (auto& [view, features] : unknown.scene.features) {
      features.point_covariances.clear();
    }
    Adjust(&known);
    Adjust(&unknown);
    with_shapes += ComparePoses(known.true_poses, known.scene).mean_center;
    without += ComparePoses(unknown.true_poses, unknown.scene).mean_center;
  }
  EXPECT_LT(with_shapes, 0.8 * without);
}

}  // namespace
}  // namespace lowlap
