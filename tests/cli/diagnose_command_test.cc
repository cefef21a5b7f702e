// `lowlap diagnose` and `lowlap subsets`, run as a user would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cli_fixture.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;

class DiagnoseCommand : public Cli {
 protected:
  void Simulate(const std::string& arguments) const {
    const Outcome simulated = Lowlap(
        "simulate --kind room --points 40 --lines 60 --noise 0.3 " + arguments +
        " -o " + Path("room.lowlap") + " --truth " + Path("truth.lowlap"));
    ASSERT_EQ(simulated.exit_code, 0) << simulated.output;
  }
  Outcome OnRoom(const std::string& command,
                 const std::string& arguments) const {
    return Lowlap(command + " " + Path("room.lowlap") + " " + arguments);
  }
};

TEST_F(DiagnoseCommand, AChainHingesOnItsCameras) {
  Simulate("--views 5 --pairs chain");
  const Outcome firm =
      OnRoom("diagnose", "--strict --json " + Path("diagnosis.json"));
  EXPECT_EQ(firm.exit_code, 0) << firm.output;
  EXPECT_THAT(firm.output, HasSubstr("firm: all 5 views"));
  EXPECT_THAT(firm.output, HasSubstr("on 000002.png hang"));
  const std::string json = ReadText(Path("diagnosis.json"));
  for (const char* key : {"\"firm\": true", "\"hinges\"", "\"floating\"",
                          "\"by_triplets\"", "\"advice\""}) {
    EXPECT_THAT(json, HasSubstr(key));
  }
}

TEST_F(DiagnoseCommand, WhatIsWeakFailsIfAskedFor) {
  Simulate("--views 5 --pairs chain");
  const std::string severe = "--min-inliers 1000000 ";
  const Outcome told = OnRoom("diagnose", severe);
  EXPECT_EQ(told.exit_code, 0) << told.output;
  EXPECT_THAT(told.output, HasSubstr("WEAK"));
  EXPECT_THAT(told.output, HasSubstr("what would mend it"));
  EXPECT_THAT(told.output, HasSubstr("At 000001.png: one photograph"));
  EXPECT_EQ(OnRoom("diagnose", severe + "--strict").exit_code, 2);
  EXPECT_NE(OnRoom("diagnose", "--max-stddev 0").exit_code, 0);
  EXPECT_NE(OnRoom("diagnose", "--max-log10-nfa nan").exit_code, 0);
}

TEST_F(DiagnoseCommand, PartsWithoutALinkFloat) {
  Simulate("--views 6 --pairs chain");
  const Outcome told = OnRoom("diagnose", "--strict --exclude 000002.png");
  EXPECT_EQ(told.exit_code, 2) << told.output;
  EXPECT_THAT(told.output, HasSubstr("not firm: one scale for 3 of 5 views"));
  EXPECT_THAT(told.output, HasSubstr("no relative pose joins them"));
  EXPECT_THAT(told.output, HasSubstr("Two photographs between"));
}

TEST_F(DiagnoseCommand, SubsetsAreResumed) {
  Simulate("--views 6 --pairs window:3");
  const std::string common = "--drop 2 --jobs 2 -q --gt " +
                             Path("truth.lowlap") + " -o " + Path("out");
  const Outcome some = OnRoom("subsets", common + " --sample 4");
  ASSERT_EQ(some.exit_code, 0) << some.output;
  EXPECT_THAT(some.output, HasSubstr("subsets: 4\n"));
  // A line that a killed run left half written is solved again.
  const std::string four = ReadText(Path("out/results.jsonl"));
  Write("out/results.jsonl", four.substr(0, four.size() - 9));
  const Outcome all = OnRoom("subsets", common);
  ASSERT_EQ(all.exit_code, 0) << all.output;
  EXPECT_THAT(all.output, HasSubstr("subsets: 15\n"));
  EXPECT_THAT(all.output, HasSubstr("silent failures: 0"));
  const std::string table = ReadText(Path("out/results.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 16);
  // What was known is taken as it was, times included.
  const std::size_t second_line = four.find('\n') + 1;
  EXPECT_THAT(ReadText(Path("out/results.jsonl")),
              HasSubstr(four.substr(
                  second_line, four.find('\n', second_line) - second_line)));
  EXPECT_TRUE(std::filesystem::exists(Path("out/results.svg")));
  // The tables are of what was asked for last.
  ASSERT_EQ(OnRoom("subsets", common + " --sample 4").exit_code, 0);
  const std::string fewer = ReadText(Path("out/results.csv"));
  EXPECT_EQ(std::count(fewer.begin(), fewer.end(), '\n'), 5);
  for (const char* option : {" --no-adjust", " --principal-point-stddev 0.0003",
                             " --no-directions", " --coplanar-ties pairs"}) {
    const Outcome other = OnRoom("subsets", common + option);
    EXPECT_EQ(other.exit_code, 1) << option;
    EXPECT_THAT(other.output,
                HasSubstr("results of another scene or of other"));
  }
}

TEST_F(DiagnoseCommand, SubsetsNeedTruthAndViews) {
  Simulate("--views 5 --pairs chain");
  EXPECT_NE(OnRoom("subsets", "-o " + Path("out")).exit_code, 0);
  const Outcome few =
      OnRoom("subsets",
             "--drop 3 --gt " + Path("truth.lowlap") + " -o " + Path("out"));
  EXPECT_EQ(few.exit_code, 1);
  EXPECT_THAT(few.output, HasSubstr("three must remain"));
}

}  // namespace
}  // namespace lowlap
