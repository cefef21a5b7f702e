#include "lowlap/core/internal/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

RunContext WithThreads(int count) {
  RunContext context;
  context.num_threads = count;
  return context;
}

TEST(ParallelFor, CallsEveryItemOnce) {
  for (const int threads : {1, 2, 5}) {
    for (const std::size_t count : {0u, 1u, 3u, 1000u}) {
      std::vector<std::atomic<int>> calls(count);
      ASSERT_THAT(ParallelFor(WithThreads(threads), "", count,
                              [&](std::size_t i) { ++calls[i]; }),
                  IsOk());
      for (const auto& call : calls) EXPECT_EQ(call, 1);
    }
  }
}

TEST(ParallelFor, WhatAnItemThrowsReachesTheCaller) {
  for (const int threads : {1, 4}) {
    std::atomic<int> calls{0};
    EXPECT_THROW(
        {
          const Status ignored =
              ParallelFor(WithThreads(threads), "", 100000, [&](std::size_t i) {
                ++calls;
                if (i == 10) throw std::bad_alloc();
              });
        },
        std::bad_alloc);
    EXPECT_LT(calls, 100000);
  }
}

TEST(ParallelFor, SameResultForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    std::vector<double> results(500);
    const Status status = ParallelFor(WithThreads(threads), "", results.size(),
                                      [&](std::size_t i) {
                                        Random random(42, i);
                                        for (int n = 0; n < 100; ++n)
                                          results[i] += random.Gaussian();
                                      });
    EXPECT_THAT(status, IsOk());
    return results;
  };
  const std::vector<double> expected = run(1);
  EXPECT_EQ(run(2), expected);
  EXPECT_EQ(run(7), expected);
}

TEST(ParallelFor, ReportsProgressInOrderUpToTheTotal) {
  for (const int threads : {1, 4}) {
    RunContext context = WithThreads(threads);
    std::vector<std::size_t> reports;
    context.progress = [&](const std::string& stage, std::size_t done,
                           std::size_t total) {
      EXPECT_EQ(stage, "work");
      EXPECT_EQ(total, 50u);
      reports.push_back(done);
      return true;
    };
    ASSERT_THAT(ParallelFor(context, "work", 50, [](std::size_t) {}), IsOk());
    ASSERT_EQ(reports.size(), 51u);
    for (std::size_t n = 0; n < reports.size(); ++n) EXPECT_EQ(reports[n], n);
  }
}

TEST(ParallelFor, ProgressCanCancel) {
  for (const int threads : {1, 4}) {
    RunContext context = WithThreads(threads);
    context.progress = [](const std::string&, std::size_t done, std::size_t) {
      return done < 10;
    };
    std::atomic<int> calls{0};
    EXPECT_THAT(
        ParallelFor(context, "work", 100000, [&](std::size_t) { ++calls; }),
        IsError(ErrorCode::kCancelled, "work"));
    EXPECT_GE(calls, 10);
    EXPECT_LE(calls, 10 + threads);
  }
}

TEST(ParallelFor, CancelBeforeTheFirstItem) {
  RunContext context;
  context.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  int calls = 0;
  context.num_threads = 1;
  EXPECT_THAT(ParallelFor(context, "work", 10, [&](std::size_t) { ++calls; }),
              IsError(ErrorCode::kCancelled, ""));
  EXPECT_EQ(calls, 0);
}

TEST(ParallelFor, UnnamedStagesReportNothing) {
  RunContext context;
  context.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  EXPECT_THAT(ParallelFor(context, "", 10, [](std::size_t) {}), IsOk());
}

TEST(RunContext, SinksAreOptional) {
  RunContext context;
  context.Log(LogLevel::kInfo, "nobody listens");
  EXPECT_TRUE(context.Progress("stage", 1, 2));
  EXPECT_GE(context.ThreadCount(), 1);
  context.num_threads = 3;
  EXPECT_EQ(context.ThreadCount(), 3);
  std::string heard;
  context.log = [&](LogLevel, const std::string& message) { heard = message; };
  context.Log(LogLevel::kWarning, "hello");
  EXPECT_EQ(heard, "hello");
}

}  // namespace
}  // namespace lowlap
