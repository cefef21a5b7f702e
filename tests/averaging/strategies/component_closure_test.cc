#include "lowlap/averaging/strategies/internal/component_closure.h"

#include <gtest/gtest.h>

#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

// Views on a ring around the origin, `lift` moves every other one up.
std::vector<Vec3> Ring(int count, double lift) {
  std::vector<Vec3> centers;
  for (int n = 0; n < count; ++n) {
    const double angle = 2 * EIGEN_PI * n / count;
    centers.emplace_back((3 + 0.4 * (n % 3)) * std::cos(angle),
                         3 * std::sin(angle), n % 2 ? lift : 0);
  }
  return centers;
}

// The views in a gauge of their own, with an error of stddev_rad.
RigidComponent MakeBody(const std::vector<Vec3>& centers,
                        const std::vector<std::size_t>& views, double scale,
                        double stddev_rad, Random* random) {
  RigidComponent component;
  component.views = views;
  component.stddev_rad = stddev_rad;
  for (const std::size_t view : views) {
    const double x = random->Gaussian(stddev_rad);
    const double y = random->Gaussian(stddev_rad);
    component.centers.push_back(scale * (centers[view] + Vec3(x, y, 0)) +
                                Vec3(1, 2, 3));
  }
  return component;
}

// A ring of twelve views in `count` arcs that meet in single views.
std::vector<RigidComponent> Arcs(const std::vector<Vec3>& centers, int count,
                                 double stddev_rad, Random* random) {
  std::vector<RigidComponent> components;
  const std::size_t length = centers.size() / static_cast<std::size_t>(count);
  for (int b = 0; b < count; ++b) {
    std::vector<std::size_t> views;
    for (std::size_t n = 0; n <= length; ++n) {
      views.push_back((static_cast<std::size_t>(b) * length + n) %
                      centers.size());
    }
    components.push_back(
        MakeBody(centers, views, b == 0 ? 1 : 0.5 + b, stddev_rad, random));
  }
  return components;
}

TEST(CloseComponents, ThreeArcsCloseARing) {
  const std::vector<Vec3> centers = Ring(12, 0);
  Random random(1);
  const std::vector<RigidComponent> components =
      Arcs(centers, 3, 1e-6, &random);
  const auto placements = CloseComponents(components);
  for (std::size_t b = 0; b < components.size(); ++b) {
    ASSERT_TRUE(placements[b].has_value()) << b;
    for (std::size_t n = 0; n < components[b].views.size(); ++n) {
      const Vec3 placed = placements[b]->scale * components[b].centers[n] +
                          placements[b]->translation;
      // In the gauge of the first component.
      EXPECT_LT(
          (placed - centers[components[b].views[n]] - Vec3(1, 2, 3)).norm(),
          1e-4);
    }
  }
}

TEST(CloseComponents, APlanarRingOfFourStaysOpen) {
  Random random(1);
  const auto placements = CloseComponents(Arcs(Ring(12, 0), 4, 0.005, &random));
  for (std::size_t b = 1; b < 4; ++b) EXPECT_FALSE(placements[b].has_value());
}

TEST(CloseComponents, HeightClosesARingOfFour) {
  const std::vector<Vec3> centers = {{0, 0, 0},  {1, 0, 2},  {2, 0, 0},
                                     {2, 1, -2}, {2, 2, 0},  {1, 2, 2.5},
                                     {0, 2, 1},  {-1, 1, -2}};
  Random random(1);
  const std::vector<RigidComponent> components =
      Arcs(centers, 4, 1e-6, &random);
  const auto placements = CloseComponents(components);
  for (std::size_t b = 1; b < 4; ++b) {
    ASSERT_TRUE(placements[b].has_value());
    EXPECT_NEAR(placements[b]->scale, 1 / (0.5 + static_cast<double>(b)), 1e-3);
  }
}

TEST(CloseComponents, ABodyAtOneViewIsFree) {
  const std::vector<Vec3> centers = Ring(12, 0);
  Random random(1);
  std::vector<RigidComponent> components = Arcs(centers, 3, 1e-6, &random);
  RigidComponent loose;
  loose.views = {0, 100};
  loose.centers = {{0, 0, 0}, {1, 0, 0}};
  components.insert(components.begin() + 1, loose);
  const auto placements = CloseComponents(components);
  EXPECT_TRUE(placements[0].has_value());
  EXPECT_FALSE(placements[1].has_value());
  EXPECT_TRUE(placements[2].has_value());
}

TEST(CloseComponents, NothingToClose) {
  EXPECT_TRUE(CloseComponents({}).empty());
  const std::vector<Vec3> centers = Ring(12, 0);
  Random random(1);
  std::vector<RigidComponent> components = Arcs(centers, 3, 1e-6, &random);
  components.pop_back();  // a chain
  for (const auto& placement : CloseComponents(components)) {
    EXPECT_FALSE(placement.has_value());
  }
}

}  // namespace
}  // namespace lowlap
