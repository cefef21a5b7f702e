#include "lowlap/matching/internal/loops/place_transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lowlap {
namespace {

PlaceTransfer::Match Moved(double x, double y, const Vec2& by) {
  return {Vec2(x, y), Vec2(x, y) + by};
}

TEST(PlaceTransfer, MovesAPlaceAsTheNearestMatches) {
  const PlaceTransfer transfer(
      {Moved(100, 100, {50, 0}), Moved(400, 100, {-30, 7})}, 20);
  const auto near_first = transfer.Apply({108, 91});
  ASSERT_TRUE(near_first);
  EXPECT_EQ(*near_first, Vec2(158, 91));
  const auto near_second = transfer.Apply({390, 110});
  ASSERT_TRUE(near_second);
  EXPECT_EQ(*near_second, Vec2(360, 117));
}

TEST(PlaceTransfer, HearsTheMostOfThree) {
  // The fourth is farther off than the others.
  const PlaceTransfer transfer({Moved(4, 0, {99, 99}), Moved(0, 0, {10, -2}),
                                Moved(2, 2, {10, -2}), Moved(9, 9, {99, 99})},
                               30);
  const auto place = transfer.Apply({0, 1});
  ASSERT_TRUE(place);
  EXPECT_EQ(*place, Vec2(10, -1));
}

// The cells that it searches must not show: also across their borders, and left
// of and above the origin.
TEST(PlaceTransfer, FindsWhatLiesWithinTheRadiusAndNothingElse) {
  std::vector<PlaceTransfer::Match> matches;
  for (int n = 0; n < 40; ++n) {
    matches.push_back(Moved(-211 + 37 * (n % 8), -95 + 41 * (n / 8), {n, 0}));
  }
  constexpr double kRadiusPx = 12;
  const PlaceTransfer transfer(matches, kRadiusPx);
  int num_found = 0;
  for (double x = -230; x < 80; x += 7) {
    for (double y = -110; y < 90; y += 7) {
      double nearest_px = HUGE_VAL;
      for (const auto& match : matches) {
        nearest_px = std::min(nearest_px, (match.from_px - Vec2(x, y)).norm());
      }
      const bool is_found = transfer.Apply({x, y}).has_value();
      EXPECT_EQ(is_found, nearest_px < kRadiusPx) << x << ' ' << y;
      num_found += is_found ? 1 : 0;
    }
  }
  EXPECT_GT(num_found, 100);
}

TEST(PlaceTransfer, TellsNothingOfPlacesThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(PlaceTransfer({}, 5).Apply({1, 1}));
  const PlaceTransfer transfer({Moved(1, 1, {nan, 0}), Moved(nan, 1, {1, 0})},
                               5);
  EXPECT_FALSE(transfer.Apply({1, 1}));
  EXPECT_FALSE(PlaceTransfer({Moved(1, 1, {2, 2})}, 5).Apply({nan, 1}));
}

}  // namespace
}  // namespace lowlap
