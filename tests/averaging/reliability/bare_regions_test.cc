#include "lowlap/averaging/reliability/internal/bare_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

constexpr double kLeastRate = 1e-3;  // has no effect
constexpr double kChance = 2 * kChanceOfBare;

// 1,000 landmarks anywhere in a square, found with a chance by their place.
std::vector<ExpectedSighting> Square(
    const std::function<double(const Vec2&)>& chance) {
  Random random(3);
  std::vector<ExpectedSighting> expected(1000);
  for (ExpectedSighting& seen : expected) {
    seen.pixel_px = {random.Uniform(0, 1000), random.Uniform(0, 1000)};
    seen.is_found = random.Uniform() < chance(seen.pixel_px);
  }
  return expected;
}

double ShareOfBare(const OverlapRegions& regions) {
  return static_cast<double>(regions.num_bare) / regions.num;
}

TEST(DivideOverlap, FewRegionsAreBareHoweverFewLandmarksAreFound) {
  for (const double chance : {0.05, 0.2, 0.5, 1.0}) {
    const OverlapRegions regions =
        DivideOverlap(Square([&](const Vec2&) { return chance; }), kLeastRate);
    EXPECT_GT(regions.num, 150 * chance) << chance;
    EXPECT_LT(ShareOfBare(regions), 0.1) << chance;
    EXPECT_GT(Log10ChanceOfBare(regions, kChance), -1) << chance;
  }
}

TEST(DivideOverlap, WhereNothingIsFoundRegionsAreBare) {
  for (const double part : {0.3, 0.5, 0.8}) {
    const OverlapRegions regions = DivideOverlap(
        Square([&](const Vec2& at) { return at.x() < 1000 * part ? 0.4 : 0; }),
        kLeastRate);
    EXPECT_NEAR(ShareOfBare(regions), 1 - part, 0.15) << part;
    EXPECT_LT(Log10ChanceOfBare(regions, kChance), -2) << part;
  }
}

TEST(DivideOverlap, ARateThatFallsLeavesNoRegionBare) {
  const OverlapRegions regions = DivideOverlap(
      Square([](const Vec2& at) { return 0.8 - 0.6e-3 * at.x(); }), kLeastRate);
  EXPECT_GT(Log10ChanceOfBare(regions, kChance), -1);
}

// Half of the image, of which hardly anything is found.
TEST(DivideOverlap, WhatOthersFindTellsMore) {
  const std::vector<ExpectedSighting> expected =
      Square([](const Vec2& at) { return at.x() < 500 ? 0.02 : 0; });
  EXPECT_GT(Log10ChanceOfBare(DivideOverlap(expected, kLeastRate), kChance),
            -2);
  EXPECT_LT(Log10ChanceOfBare(DivideOverlap(expected, 0.4), kChance), -10);
  // At two thirds of that rate few are bare.
  EXPECT_LT(
      ShareOfBare(DivideOverlap(Square([](const Vec2&) { return 0.27; }), 0.4)),
      0.15);
}

TEST(DivideOverlap, DoesNotDependOnTheOrder) {
  std::vector<ExpectedSighting> expected = Square(
      [](const Vec2& at) { return at.x() < 500 || at.y() < 300 ? 0.4 : 0; });
  const OverlapRegions regions = DivideOverlap(expected, kLeastRate);
  std::reverse(expected.begin(), expected.end());
  const OverlapRegions reversed = DivideOverlap(expected, kLeastRate);
  EXPECT_EQ(regions.num, reversed.num);
  EXPECT_EQ(regions.num_bare, reversed.num_bare);
}

TEST(DivideOverlap, HasNoRegionsWhereHardlyAnythingIsFound) {
  std::vector<ExpectedSighting> expected(100);
  expected[0].is_found = expected[1].is_found = true;
  EXPECT_EQ(DivideOverlap(expected, kLeastRate).num, 0);
  EXPECT_EQ(DivideOverlap({}, kLeastRate).num, 0);
  EXPECT_EQ(Log10ChanceOfBare({}, kChance), 0);
  // All in one place.
  for (ExpectedSighting& seen : expected) seen.is_found = true;
  EXPECT_EQ(DivideOverlap(expected, kLeastRate).num_bare, 0);
}

}  // namespace
}  // namespace lowlap
