#include "lowlap/core/result.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace lowlap {
namespace {

TEST(Error, ToStringLeavesOutEmptyParts) {
  Error error{ErrorCode::kParse, "message", "file.json", "$.views"};
  EXPECT_EQ(error.ToString(), "file.json: $.views: message");
  error.place.clear();
  EXPECT_EQ(error.ToString(), "file.json: message");
  error.file.clear();
  EXPECT_EQ(error.ToString(), "message");
  error.place = "$.views";
  EXPECT_EQ(error.ToString(), "$.views: message");
}

// Messages quote what stands in a file.
TEST(Error, ToStringDoesNotUpsetATerminal) {
  const Error error{ErrorCode::kParse, "'\x1B[2J\xFF'", "a\r.json", {}};
  EXPECT_EQ(error.ToString(), "a\\x0D.json: '\\x1B[2J\\xFF'");
}

TEST(Error, CodesHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  const int last = static_cast<int>(ErrorCode::kCancelled);
  for (int code = 0; code <= last; ++code) {
    names.insert(ErrorCodeName(static_cast<ErrorCode>(code)));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(last + 1));
  EXPECT_EQ(names.count("unknown"), 0u);
  EXPECT_EQ(std::string(ErrorCodeName(ErrorCode::kInvalidScene)),
            "invalid_scene");
}

TEST(Result, HoldsAValueOrAnError) {
  const Result<int> value = 3;
  ASSERT_TRUE(value.has_value());
  EXPECT_EQ(*value, 3);
  const Result<int> error = MakeError(ErrorCode::kNotFound, "gone", "f", "p");
  ASSERT_FALSE(error.has_value());
  EXPECT_EQ(error.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(error.error().ToString(), "f: p: gone");
  const Status success;
  EXPECT_TRUE(success.has_value());
}

}  // namespace
}  // namespace lowlap
