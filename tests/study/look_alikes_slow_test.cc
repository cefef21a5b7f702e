#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "lowlap/study/internal/look_alikes/study.h"
#include "lowlap/study/internal/look_alikes/trial_json.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;

TEST(MakePhotographPair, TheSameSeedGivesTheSamePhotographs) {
  const auto a = MakePhotographPair(RepeatedKind::kTiles, true, 5);
  const auto b = MakePhotographPair(RepeatedKind::kTiles, true, 5);
  const auto elsewhere = MakePhotographPair(RepeatedKind::kTiles, false, 5);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_TRUE(a.images[n].Validate().has_value());
    EXPECT_EQ(a.images[n].pixels, b.images[n].pixels);
  }
  EXPECT_EQ(elsewhere.images[0].pixels, a.images[0].pixels);
  EXPECT_NE(elsewhere.images[1].pixels, a.images[1].pixels);
  EXPECT_NE(MakePhotographPair(RepeatedKind::kTiles, true, 6).images[0].pixels,
            a.images[0].pixels);
}

TEST(LookAlikeStudy, JoinsNoTwoPlacesAndGoesOnWhereItStopped) {
  LookAlikeStudy study;
  study.num_pairs = 2;
  RunContext context;
  context.seed = 77;
  std::string log;
  const Status done = RunLookAlikeStudy(
      context,
      [&](const LookAlikeKey& key, const LookAlikeTrial& trial) {
        log += ToJsonLine(key, trial) + "\n";
        return Status();
      },
      &study);
  ASSERT_TRUE(done.has_value());
  ASSERT_EQ(study.trials.size(), 12u);
  int same = 0;
  for (const auto& [key, trial] : study.trials) {
    if (std::get<1>(key)) {
      same += trial.is_accepted ? 1 : 0;
      EXPECT_LT(trial.rotation_error_deg, 2) << std::get<2>(key);
    } else {
      EXPECT_FALSE(trial.is_accepted)
          << RepeatedKindName(std::get<0>(key)) << ' ' << std::get<2>(key);
      EXPECT_FALSE(trial.reason.empty());
    }
  }
  EXPECT_GE(same, 1);

  LookAlikeStudy read;
  read.num_pairs = 2;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(AddJsonLine(line, &read)) << line;
  }
  int again = 0;
  ASSERT_TRUE(RunLookAlikeStudy(
                  context,
                  [&](const LookAlikeKey&, const LookAlikeTrial&) {
                    ++again;
                    return Status();
                  },
                  &read)
                  .has_value());
  EXPECT_EQ(again, 0);
  EXPECT_EQ(LookAlikeFiles(read), LookAlikeFiles(study));
  EXPECT_THAT(LookAlikeFiles(study)[1].second, HasSubstr("0 of 2"));
}

TEST(LookAlikeStudy, RefusesWhatIsNoStudyOrRecord) {
  LookAlikeStudy study;
  study.num_pairs = 0;
  EXPECT_FALSE(RunLookAlikeStudy({}, nullptr, &study).has_value());
  for (const char* line :
       {"", "{}", "nothing", "{\"kind\":\"doors\"}",
        "{\"kind\":\"tiles\",\"same_place\":true,\"seed\":1}"}) {
    EXPECT_FALSE(AddJsonLine(line, &study)) << line;
  }
  EXPECT_TRUE(study.trials.empty());
}

}  // namespace
}  // namespace lowlap
