#include "lowlap/study/internal/result_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

class ResultLogTest : public ::testing::Test {
 protected:
  ResultLogTest() { std::filesystem::remove(path_); }
  ~ResultLogTest() override { std::filesystem::remove(path_); }

  Result<ResultLog> Open(const std::string& settings = "seed 1\n") {
    records_.clear();
    return ResultLog::Open(path_, settings, [&](const std::string& record) {
      records_.push_back(record);
      return record != "[]";
    });
  }

  const std::string path_ =
      ::testing::TempDir() + "/lowlap_result_log_" +
      ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::vector<std::string> records_;
};

TEST_F(ResultLogTest, GoesOnWhereItWas) {
  for (int n = 0; n < 3; ++n) {
    const auto log = Open();
    ASSERT_THAT(log, IsOk());
    EXPECT_EQ(records_.size(), 2u * static_cast<std::size_t>(n));
    ASSERT_THAT(log->Append("{\"n\": " + std::to_string(n) + "}"), IsOk());
    ASSERT_THAT(log->Append("{}"), IsOk());
  }
  ASSERT_THAT(Open(), IsOk());
  ASSERT_EQ(records_.size(), 6u);
  EXPECT_EQ(records_[2], "{\"n\": 1}");
}

// Wherever a killed study stopped: what was whole is there, and nothing else.
TEST_F(ResultLogTest, WhatIsHalfWrittenIsDropped) {
  {
    const auto log = Open();
    ASSERT_THAT(log->Append("{\"a\": 1}"), IsOk());
    ASSERT_THAT(log->Append("{\"b\": 2}"), IsOk());
  }
  const std::string whole = ReadWholeFile(path_).value();
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const std::string text = whole.substr(0, size);
    std::ofstream(path_, std::ios::binary) << text;
    const auto log = Open();
    ASSERT_THAT(log, IsOk()) << text;
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_EQ(static_cast<long>(records_.size()), std::max(0l, lines - 1));
    ASSERT_THAT(log->Append("{\"c\": 3}"), IsOk());
    ASSERT_THAT(Open(), IsOk());
    EXPECT_EQ(records_.back(), "{\"c\": 3}");
  }
}

TEST_F(ResultLogTest, OtherSettingsAndRubbishAreRefused) {
  ASSERT_THAT(Open(), IsOk());
  EXPECT_THAT(Open("seed 2\n"),
              IsError(ErrorCode::kInvalidArgument, "other options"));
  std::ofstream(path_, std::ios::app) << "{}\n[]\n";
  EXPECT_THAT(Open(), IsError(ErrorCode::kParse, "line 3"));
  EXPECT_THAT(ResultLog::Open(path_ + "/missing", "", nullptr),
              IsError(ErrorCode::kIo, "missing"));
}

}  // namespace
}  // namespace lowlap
