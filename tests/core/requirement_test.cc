#include "lowlap/core/internal/requirement.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/matchers.h"

namespace lowlap {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Require, NamesTheFirstThatDoesNotHold) {
  EXPECT_TRUE(Require({{true, "one"}, {true, "two"}}));
  EXPECT_THAT(Require({{true, "one"}, {false, "two"}, {false, "three"}}),
              testing::IsError(ErrorCode::kInvalidArgument, "two"));
}

TEST(IsPositive, OfFiniteNumbersAboveZero) {
  EXPECT_TRUE(IsPositive(1e-300));
  for (const double value : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_FALSE(IsPositive(value)) << value;
  }
}

TEST(RequireNotNegative, NamesTheNumber) {
  EXPECT_TRUE(RequireNotNegative({{0, "a"}, {3, "b"}}));
  for (const double value : {-1e-9, kNan, kInfinity}) {
    EXPECT_THAT(RequireNotNegative({{0, "a"}, {value, "the other"}}),
                testing::IsError(ErrorCode::kInvalidArgument, "the other"));
  }
}

}  // namespace
}  // namespace lowlap
