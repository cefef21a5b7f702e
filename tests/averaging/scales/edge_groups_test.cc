#include "lowlap/averaging/scales/internal/edge_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<EdgeGroup> GroupsOf(std::size_t num_views, const Edges& edges,
                                const Edges& ratios) {
  RandomProblem made =
      MakeRandomProblem(num_views, edges, 1, /*with_ratios=*/false);
  for (const auto& [reference, target] : ratios) {
    made.AddRatio(reference, target);
  }
  return RankedEdgeGroups(made.problem, ChainEdgeScales(made.problem));
}

TEST(RankedEdgeGroups, AreTheEdgesThatRatiosJoin) {
  const auto groups =
      GroupsOf(7, {{0, 1}, {5, 4}, {1, 2}, {5, 6}, {2, 3}}, {{0, 2}, {2, 4}});
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_THAT(groups[0].edges, ElementsAre(0, 2, 4));
  EXPECT_THAT(groups[0].views, ElementsAre(0, 1, 2, 3));
  // An edge without a ratio is alone, though it shares a view.
  EXPECT_THAT(groups[1].edges, ElementsAre(1));
  EXPECT_THAT(groups[1].views, ElementsAre(4, 5));
  EXPECT_THAT(groups[2].edges, ElementsAre(3));
  EXPECT_THAT(groups[2].views, ElementsAre(5, 6));
}

TEST(RankedEdgeGroups, OfMoreViewsComeFirstThenOfMoreEdges) {
  // A path over three views, a triangle, and a path over four.
  const auto groups = GroupsOf(
      10, {{0, 1}, {1, 2}, {3, 4}, {4, 5}, {3, 5}, {6, 7}, {7, 8}, {8, 9}},
      {{0, 1}, {2, 3}, {3, 4}, {5, 6}, {6, 7}});
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_THAT(groups[0].views, ElementsAre(6, 7, 8, 9));
  EXPECT_THAT(groups[1].edges, ElementsAre(2, 3, 4));
  EXPECT_THAT(groups[2].edges, ElementsAre(0, 1));
}

TEST(RankedEdgeGroups, OfAnEmptyProblemAreNone) {
  EXPECT_THAT(GroupsOf(3, {}, {}), IsEmpty());
}

}  // namespace
}  // namespace lowlap
