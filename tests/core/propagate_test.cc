#include "lowlap/core/internal/propagate.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

namespace lowlap {
namespace {

Result<int> Parsed(int value, int* calls) {
  ++*calls;
  if (value < 0) {
    return MakeError(ErrorCode::kParse, "negative", "file", "place");
  }
  return value;
}

Status Check(int value, int* calls) {
  LOWLAP_RETURN_IF_ERROR(Parsed(value, calls));
  return {};
}

Result<std::string> Sum(int a, int b, int* calls) {
  LOWLAP_RETURN_IF_ERROR(Check(a, calls));
  int sum = 0;
  LOWLAP_ASSIGN_OR_RETURN(sum, Parsed(a, calls));
  LOWLAP_ASSIGN_OR_RETURN(const int more, Parsed(b, calls));
  return std::to_string(sum + more);
}

TEST(Propagate, GoesOnWithTheValueAndEvaluatesOnce) {
  int calls = 0;
  const Result<std::string> sum = Sum(2, 3, &calls);
  ASSERT_TRUE(sum);
  EXPECT_EQ(*sum, "5");
  EXPECT_EQ(calls, 3);
}

TEST(Propagate, ReturnsTheErrorUnchangedAsAnotherResult) {
  int calls = 0;
  const Result<std::string> first = Sum(-1, 3, &calls);
  ASSERT_FALSE(first);
  EXPECT_EQ(first.error().code, ErrorCode::kParse);
  EXPECT_EQ(first.error().ToString(), "file: place: negative");
  EXPECT_EQ(calls, 1);
  const Result<std::string> second = Sum(2, -3, &calls);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().ToString(), "file: place: negative");
  EXPECT_EQ(calls, 4);
}

TEST(Propagate, MovesValuesThatCannotBeCopied) {
  const auto sum = [](int value) -> Result<int> {
    const auto make = [&]() -> Result<std::map<int, std::unique_ptr<int>>> {
      std::map<int, std::unique_ptr<int>> made;
      made[0] = std::make_unique<int>(value);
      return made;
    };
    LOWLAP_ASSIGN_OR_RETURN(const auto made, make());
    return *made.at(0);
  };
  EXPECT_EQ(*sum(7), 7);
}

TEST(Propagate, LeavesAResultThatHasAName) {
  const auto length = [](const Result<std::string>& text) -> Result<int> {
    LOWLAP_RETURN_IF_ERROR(text);
    LOWLAP_ASSIGN_OR_RETURN(const std::string copy, text);
    return static_cast<int>(copy.size() + text->size());
  };
  EXPECT_EQ(*length(std::string("abc")), 6);
  EXPECT_FALSE(length(MakeError(ErrorCode::kIo, "gone")));
}

}  // namespace
}  // namespace lowlap
