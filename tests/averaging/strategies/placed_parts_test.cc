#include "lowlap/averaging/strategies/internal/placed_parts.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

// Centres that tell the parts apart.
std::vector<Vec3> Centers(std::size_t count, double part) {
  return std::vector<Vec3>(count, Vec3(part, 0, 0));
}

TEST(PlacedParts, NoneAreASolutionWithoutComponents) {
  const TranslationSolution solution = PlacedParts(2).MakeSolution();
  EXPECT_EQ(solution.num_components, 0);
  EXPECT_EQ(solution.component, std::vector<int>(2, -1));
  EXPECT_EQ(solution.center_in_world.size(), 2U);
}

TEST(PlacedParts, TheLargestIsTheFirstComponent) {
  PlacedParts parts(6);
  parts.Add({0, 1}, Centers(2, 1));
  parts.Add({2, 3, 4}, Centers(3, 2));
  const TranslationSolution solution = std::move(parts).MakeSolution();
  EXPECT_EQ(solution.num_components, 2);
  EXPECT_EQ(solution.component, (std::vector<int>{1, 1, 0, 0, 0, -1}));
  EXPECT_EQ(solution.center_in_world[1].x(), 1);
  EXPECT_EQ(solution.center_in_world[2].x(), 2);
}

TEST(PlacedParts, EqualOnesStayInOrder) {
  PlacedParts parts(4);
  parts.Add({2, 3}, Centers(2, 1));
  parts.Add({0, 1}, Centers(2, 2));
  EXPECT_EQ(std::move(parts).MakeSolution().component,
            (std::vector<int>{1, 1, 0, 0}));
}

TEST(PlacedParts, TheLargerPartKeepsAViewOfTwo) {
  PlacedParts parts(5);
  parts.Add({0, 1}, Centers(2, 1));
  parts.Add({1, 2, 3, 4}, Centers(4, 2));
  const TranslationSolution solution = std::move(parts).MakeSolution();
  EXPECT_EQ(solution.component, (std::vector<int>{1, 0, 0, 0, 0}));
  EXPECT_EQ(solution.center_in_world[1].x(), 2);
}

TEST(PlacedParts, APartWithoutViewsOfItsOwnIsNoComponent) {
  PlacedParts parts(5);
  parts.Add({1, 2}, Centers(2, 1));
  parts.Add({0, 1, 2}, Centers(3, 2));
  parts.Add({3, 4}, Centers(2, 3));
  const TranslationSolution solution = std::move(parts).MakeSolution();
  EXPECT_EQ(solution.num_components, 2);
  EXPECT_EQ(solution.component, (std::vector<int>{0, 0, 0, 1, 1}));
}

TEST(PlacedParts, KnowWhatTheyHave) {
  PlacedParts parts(4);
  parts.Add({0, 1}, Centers(2, 1));
  parts.Add({2}, Centers(1, 2));
  EXPECT_TRUE(parts.Has(2));
  EXPECT_FALSE(parts.Has(3));
  EXPECT_TRUE(parts.HasAll({0, 2}));
  EXPECT_FALSE(parts.HasAll({0, 3}));
}

}  // namespace
}  // namespace lowlap
