#include "lowlap/pipeline/stage_log.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

TEST(StageLog, KeepsTheStagesInTheOrderInWhichTheyEnd) {
  StageLog log;
  { const StageLog::Scope scope(&log, "first"); }
  {
    const StageLog::Scope outer(&log, "outer");
    const StageLog::Scope inner(&log, "inner");
  }
  ASSERT_EQ(log.stages().size(), 3u);
  EXPECT_EQ(log.stages()[0].name, "first");
  EXPECT_EQ(log.stages()[1].name, "inner");
  EXPECT_EQ(log.stages()[2].name, "outer");
  EXPECT_GE(log.stages()[2].wall_s, log.stages()[1].wall_s);
}

TEST(StageLog, MayBeNull) { const StageLog::Scope scope(nullptr, "stage"); }

TEST(PeakMemory, IsThatOfARunningProgram) {
  EXPECT_GT(PeakMemoryMb(), 1.0);
  EXPECT_LT(PeakMemoryMb(), 1e6);
}

}  // namespace
}  // namespace lowlap
