#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/scene/features.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsOk;

double ShareOfWrong(std::size_t right, std::size_t all) {
  return 1.0 - static_cast<double>(right) / static_cast<double>(all);
}

TEST(WrongMatches, SharesAsAsked) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kCorridor;
  options.num_views = 20;
  options.wrong_point_share = 0.3;
  options.wrong_line_share = 0.5;
  for (const bool fits : {true, false}) {
    options.wrong_fits_epipolar = fits;
    const Result<SyntheticScene> synthetic = Simulate(options);
    ASSERT_THAT(synthetic, IsOk());
    EXPECT_NEAR(ShareOfWrong(synthetic->true_points.size(),
                             synthetic->scene.point_tracks.size()),
                0.3, 0.05);
    EXPECT_NEAR(ShareOfWrong(synthetic->true_lines.size(),
                             synthetic->scene.line_tracks.size()),
                0.5, 0.05);
  }
}

// Squared Sampson distances, in pixels, of the matches of wrong tracks.
std::vector<double> WrongResiduals(const SyntheticScene& synthetic) {
  const Scene& scene = synthetic.scene;
  std::map<FeatureRef, PointTrackId> track_of;
  for (const auto& [id, track] : scene.point_tracks) {
    for (const FeatureRef& ref : track) track_of[ref] = id;
  }
  std::vector<double> residuals;
  for (const auto& [pair, edge] : scene.relative_poses) {
    const NormalizedFeatures first = NormalizeFeatures(
        scene.features.at(pair.first), *scene.FindIntrinsic(pair.first));
    const NormalizedFeatures second = NormalizeFeatures(
        scene.features.at(pair.second), *scene.FindIntrinsic(pair.second));
    for (const FeatureMatch& match : edge.point_inliers) {
      const PointTrackId id = track_of.at({pair.first, match.first});
      EXPECT_EQ(id, track_of.at({pair.second, match.second}));
      if (synthetic.true_points.count(id) > 0) continue;
      residuals.push_back(
          first.focal_px *
          std::sqrt(SampsonSquared(EssentialFromPose(edge.Cam2FromCam1()),
                                   first.points[match.first],
                                   second.points[match.second])));
    }
  }
  return residuals;
}

TEST(WrongMatches, FitTheEpipolarGeometryOrNot) {
  SyntheticOptions options;
  options.wrong_point_share = 0.3;
  const Result<SyntheticScene> fitting = Simulate(options);
  ASSERT_THAT(fitting, IsOk());
  const std::vector<double> small = WrongResiduals(*fitting);
  ASSERT_GT(small.size(), 50u);
  for (const double residual : small) EXPECT_LT(residual, 1e-6);

  options.wrong_fits_epipolar = false;
  const Result<SyntheticScene> gross = Simulate(options);
  ASSERT_THAT(gross, IsOk());
  const std::vector<double> large = WrongResiduals(*gross);
  ASSERT_GT(large.size(), 50u);
  const auto beyond = std::count_if(large.begin(), large.end(),
                                    [](double r) { return r > 10; });
  EXPECT_GT(beyond, 0.8 * large.size());
}

TEST(WrongMatches, AreFarFromThePointTheyReplace) {
  SyntheticOptions options;
  const Result<SyntheticScene> right = Simulate(options);
  options.wrong_point_share = 1.0;
  options.trifocal_point_share = options.trifocal_line_share = 1.0;
  const Result<SyntheticScene> wrong = Simulate(options);
  ASSERT_THAT(right, IsOk());
  ASSERT_THAT(wrong, IsOk());
  EXPECT_TRUE(wrong->true_points.empty());
  EXPECT_EQ(wrong->true_lines.size(), right->true_lines.size());
  // No match of a wrong track is a match of the right scene.
  for (const auto& [pair, edge] : wrong->scene.relative_poses) {
    const auto& wrong_first = wrong->scene.features.at(pair.first).points_px;
    const auto& wrong_second = wrong->scene.features.at(pair.second).points_px;
    const auto& right_first = right->scene.features.at(pair.first).points_px;
    const auto& right_second = right->scene.features.at(pair.second).points_px;
    const RelativePose& truth = right->scene.relative_poses.at(pair);
    for (const FeatureMatch& a : edge.point_inliers) {
      for (const FeatureMatch& b : truth.point_inliers) {
        const double displacement =
            (wrong_first[a.first] - right_first[b.first]).norm() +
            (wrong_second[a.second] - right_second[b.second]).norm();
        ASSERT_GT(displacement, 1e-3);
      }
    }
  }
}

}  // namespace
}  // namespace lowlap
