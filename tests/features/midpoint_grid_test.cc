#include "lowlap/features/internal/lines/midpoint_grid.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

double Distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double share =
      ab.squaredNorm() > 0
          ? std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0)
          : 0.0;
  return (p - a - share * ab).norm();
}

TEST(MidpointGridTest, MissesNothingNearASegment) {
  Random random(1);
  const Vec2 low(-20, 30), high(900, 640);
  // Some lie outside of the box.
  const auto place = [&]() -> Vec2 {
    const double x = random.Uniform(-200, 1100);
    return {x, random.Uniform(-150, 800)};
  };
  MidpointGrid grid(low, high);
  std::vector<Vec2> midpoints;
  for (std::size_t id = 0; id < 3000; ++id) {
    midpoints.push_back(place());
    grid.Insert(id, midpoints.back());
  }
  std::size_t num_found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Vec2 start = place();
    Vec2 end = start + 0.2 * (place() - start);
    if (trial % 10 == 0) end.y() = start.y();
    if (trial % 10 == 1) end.x() = start.x();
    if (trial % 10 == 2) end = start;
    const double reach = random.Uniform(0.1, 40);
    const std::vector<std::size_t> near = grid.Near(start, end, reach);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    for (std::size_t id = 0; id < midpoints.size(); ++id) {
      if (Distance(midpoints[id], start, end) < reach) {
        EXPECT_THAT(near, Contains(id));
      }
    }
    num_found += near.size();
  }
  // It spares most of the work.
  EXPECT_LT(num_found, 300u * 3000u / 20);
}

TEST(MidpointGridTest, ABoxWithoutExtentHoldsEverything) {
  MidpointGrid grid(Vec2::Zero(), Vec2::Zero());
  EXPECT_THAT(grid.Near(Vec2(1, 2), Vec2(3, 4), 1), IsEmpty());
  grid.Insert(7, Vec2(1000, -1000));
  grid.Insert(3, Vec2::Zero());
  EXPECT_THAT(grid.Near(Vec2(1, 2), Vec2(3, 4), 1), ElementsAre(3, 7));
}

}  // namespace
}  // namespace lowlap
