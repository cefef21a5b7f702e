#include "lowlap/scale/internal/planes/planes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scale/synthetic_planes.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticPlanes;
using testing::SyntheticPlanes;
using testing::SyntheticPlanesOptions;

// At least `coverage` of the samples are on a plane, and 95 % of those on one
// that has the wall's depth there.
void ExpectWalls(const SyntheticPlanes& scene, const PairPlanes& planes,
                 double coverage, double tolerance) {
  int on_plane = 0, right = 0;
  for (std::size_t n = 0; n < planes.samples.size(); ++n) {
    if (planes.plane_of_sample[n] == PairPlanes::kNoPlane) continue;
    ++on_plane;
    const Vec3& ray = planes.samples[n].ray;
    const double rho =
        planes.planes[planes.plane_of_sample[n]].InverseDepth(ray);
    const double truth = scene.InverseDepthIj(ray);
    right += std::abs(rho / truth - 1) < tolerance;
  }
  EXPECT_GE(on_plane, coverage * planes.samples.size());
  EXPECT_GE(right, 0.95 * on_plane);
}

TEST(FindPlanes, FindsTheWallsExactly) {
  const SyntheticPlanes scene = MakeSyntheticPlanes({}, 3);
  ExpectWalls(scene, scene.PlanesIj(), 0.9, 1e-3);
}

TEST(FindPlanes, FindsTheWallsFromLinesAlone) {
  SyntheticPlanesOptions options;
  options.num_points_per_wall = 0;
  options.num_lines_per_wall = 20;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 4);
  ExpectWalls(scene, scene.PlanesIj(), 0.7, 0.01);
}

TEST(FindPlanes, FindsTheWallsAmongScatteredPoints) {
  SyntheticPlanesOptions options;
  options.num_points_per_wall = 60;
  options.num_scattered = 40;
  options.noise_px = 0.5;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 5);
  ExpectWalls(scene, scene.PlanesIj(), 0.6, 0.05);
}

TEST(FindPlanes, StatesHowSureAPlaneIs) {
  SyntheticPlanesOptions options;
  options.noise_px = 1;
  int within = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, seed);
    SyntheticPlanesOptions exact = options;
    exact.noise_px = 0;
    const PairPlanes truth = MakeSyntheticPlanes(exact, seed).PlanesIj();
    const PairPlanes planes = scene.PlanesIj();
    for (const double x : {-0.4, 0.0, 0.4}) {
      const Vec3 ray(x, 0, 1);
      const int plane = planes.PlaneAt(ray), true_plane = truth.PlaneAt(ray);
      if (plane < 0 || true_plane < 0) continue;
      const double error = planes.planes[plane].InverseDepth(ray) -
                           truth.planes[true_plane].InverseDepth(ray);
      within += std::abs(error) < 2 * planes.planes[plane].Stddev(ray);
      ++all;
    }
  }
  EXPECT_GT(all, 60);
  EXPECT_GT(within, 0.85 * all);
}

TEST(FindPlanes, FindsNoneAmongUnrelatedDepths) {
  SyntheticPlanesOptions options;
  options.num_points_per_wall = 0;
  options.num_scattered = 150;
  int found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    found += static_cast<int>(
        MakeSyntheticPlanes(options, seed).PlanesIj().planes.size());
  }
  EXPECT_LE(found, 2);
}

TEST(FindPlanes, KnowsNoPlaneOutsideItsExtent) {
  SyntheticPlanesOptions options;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 6);
  const PairPlanes planes = scene.PlanesIj();
  EXPECT_EQ(planes.PlaneAt(Vec3(0.8, 0, 1)), PairPlanes::kNoPlane);
  EXPECT_EQ(planes.PlaneAt(Vec3(0, 0.6, 1)), PairPlanes::kNoPlane);
}

TEST(FindPlanes, TakesFewOrNoSamples) {
  EXPECT_TRUE(FindPlanes({}).planes.empty());
  std::vector<DepthSample> samples(3);
  for (int n = 0; n < 3; ++n) samples[n].ray.x() = 0.1 * n;
  EXPECT_TRUE(FindPlanes(samples).planes.empty());
  EXPECT_EQ(FindPlanes(samples).plane_of_sample,
            std::vector<int>(3, PairPlanes::kNoPlane));
  // All of them at one place determine no plane.
  DepthSample sample;
  sample.inverse_depth = 0.3;
  sample.stddev = 0.01;
  sample.speed_px = 100;
  EXPECT_TRUE(FindPlanes(std::vector<DepthSample>(20, sample)).planes.empty());
}

TEST(FindPlanes, DoesNotDependOnTheOrderOfTheMatches) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  options.num_lines_per_wall = 5;
  SyntheticPlanes scene = MakeSyntheticPlanes(options, 7);
  const PairPlanes planes = scene.PlanesIj();
  std::reverse(scene.points_ij.begin(), scene.points_ij.end());
  const PairPlanes reversed = scene.PlanesIj();
  ASSERT_EQ(planes.planes.size(), reversed.planes.size());
  for (std::size_t n = 0; n < planes.planes.size(); ++n) {
    EXPECT_EQ(planes.planes[n].samples, reversed.planes[n].samples);
    EXPECT_EQ(planes.planes[n].parameters, reversed.planes[n].parameters);
  }
}

// Neither among more samples than are used.
TEST(FindPlanes, DoesNotDependOnTheOrderOfManyMatches) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  options.num_points_per_wall = 3 * kMaxPlaneSamples / 4;
  SyntheticPlanes scene = MakeSyntheticPlanes(options, 8);
  const PairPlanes planes = scene.PlanesIj();
  std::rotate(scene.points_ij.begin(), scene.points_ij.begin() + 100,
              scene.points_ij.end());
  const PairPlanes rotated = scene.PlanesIj();
  ASSERT_EQ(planes.planes.size(), rotated.planes.size());
  for (std::size_t n = 0; n < planes.planes.size(); ++n) {
    EXPECT_EQ(planes.planes[n].parameters, rotated.planes[n].parameters);
  }
}

TEST(FindPlanes, MatchesOfOnePlaceAreOneSample) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  SyntheticPlanes scene = MakeSyntheticPlanes(options, 9);
  const PairPlanes planes = scene.PlanesIj();
  const std::vector<MatchedPoint> once = scene.points_ij;
  for (MatchedPoint point : once) {
    point.point_in_middle += 1000;  // another feature
    scene.points_ij.push_back(point);
  }
  const PairPlanes twice = scene.PlanesIj();
  EXPECT_EQ(twice.samples.size(), planes.samples.size());
  EXPECT_EQ(twice.matched.size(), 2 * planes.matched.size());
  ASSERT_EQ(twice.planes.size(), planes.planes.size());
  for (std::size_t n = 0; n < planes.planes.size(); ++n) {
    EXPECT_EQ(twice.planes[n].log10_nfa, planes.planes[n].log10_nfa);
  }
}

}  // namespace
}  // namespace lowlap
