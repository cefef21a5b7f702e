#include "lowlap/averaging/strategies/internal/vertex_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

double Broken(const std::vector<WeightedArc>& arcs,
              const std::vector<std::size_t>& place) {
  double weight = 0;
  for (const WeightedArc& arc : arcs) {
    if (place[arc.from] > place[arc.to]) weight += arc.weight;
  }
  return weight;
}

double LeastBroken(std::size_t num_vertices,
                   const std::vector<WeightedArc>& arcs) {
  std::vector<std::size_t> place(num_vertices);
  std::iota(place.begin(), place.end(), std::size_t{0});
  double best = Broken(arcs, place);
  while (std::next_permutation(place.begin(), place.end())) {
    best = std::min(best, Broken(arcs, place));
  }
  return best;
}

TEST(OrderVertices, AnAcyclicGraphLosesNothing) {
  Random random(1);
  constexpr std::size_t kVertices = 40;
  std::vector<std::size_t> true_place(kVertices);
  std::iota(true_place.begin(), true_place.end(), std::size_t{0});
  for (std::size_t n = kVertices - 1; n > 0; --n) {
    std::swap(true_place[n],
              true_place[random.Index(static_cast<std::uint32_t>(n + 1))]);
  }
  std::vector<WeightedArc> arcs;
  while (arcs.size() < 300) {
    const std::size_t a = random.Index(kVertices), b = random.Index(kVertices);
    if (true_place[a] < true_place[b]) arcs.push_back({a, b, random.Uniform()});
  }
  EXPECT_EQ(Broken(arcs, OrderVertices(kVertices, arcs)), 0);
}

TEST(OrderVertices, IsCloseToTheBestOfAllOrders) {
  Random random(2);
  int num_best = 0;
  double total = 0, least_total = 0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<WeightedArc> arcs;
    for (std::size_t a = 0; a < 7; ++a) {
      for (std::size_t b = a + 1; b < 7; ++b) {
        if (random.Uniform() < 0.3) continue;
        const bool forward = random.Uniform() < 0.75;
        arcs.push_back(
            {forward ? a : b, forward ? b : a, random.Uniform(0.1, 1)});
      }
    }
    const double broken = Broken(arcs, OrderVertices(7, arcs));
    const double least = LeastBroken(7, arcs);
    EXPECT_GE(broken, least - 1e-12);
    num_best += broken < least + 1e-12 ? 1 : 0;
    total += broken;
    least_total += least;
  }
  EXPECT_GE(num_best, kTrials / 3);
  EXPECT_LT(total, 1.3 * least_total);
}

TEST(OrderVertices, PlacesAreAPermutation) {
  const std::vector<WeightedArc> arcs = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}};
  std::vector<std::size_t> place = OrderVertices(5, arcs);
  std::sort(place.begin(), place.end());
  EXPECT_EQ(place, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(OrderVertices, ALightArcIsBrokenForHeavyOnes) {
  const std::vector<std::size_t> place =
      OrderVertices(3, {{0, 1, 1.0}, {1, 2, 1.0}, {2, 0, 0.1}});
  EXPECT_LT(place[0], place[1]);
  EXPECT_LT(place[1], place[2]);
}

}  // namespace
}  // namespace lowlap
