// `lowlap compare` and `lowlap ablate`, run as a user would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli_fixture.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class CompareCommand : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    const Outcome simulated = Lowlap(
        "simulate --kind room --views 6 --pairs window:2 --noise 0.5 --points "
        "40 --lines 60 -o " +
        Path("room.lowlap") + " --truth " + Path("truth.lowlap"));
    ASSERT_EQ(simulated.exit_code, 0) << simulated.output;
  }

  Outcome OnRoom(const std::string& command,
                 const std::string& arguments) const {
    return Lowlap(command + " " + Path("room.lowlap") + " " + arguments);
  }
};

TEST_F(CompareCommand, ATableAndFilesComeOut) {
  const Outcome compared = OnRoom(
      "compare", "--gt " + Path("truth.lowlap") +
                     " --strategies graph,chain,1dsfm+lud -o " + Path("out"));
  ASSERT_EQ(compared.exit_code, 0) << compared.output;
  for (const char* part :
       {"graph", "chain", "1dsfm+lud", "6/6", "error before", "error after"}) {
    EXPECT_THAT(compared.output, HasSubstr(part));
  }
  for (const char* name :
       {"compare.csv", "compare.json", "position_error.svg",
        "cameras_placed.svg", "direction_error.svg", "time.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(Path("out") + "/" + name)) << name;
  }
  EXPECT_EQ(FilesIn("out"), 6u);
}

TEST_F(CompareCommand, WithoutTruthAndAdjustment) {
  const Outcome compared = OnRoom("compare",
                                  "--no-adjust --features coplanar "
                                  "--strategies graph,chain -o " +
                                      Path("out"));
  ASSERT_EQ(compared.exit_code, 0) << compared.output;
  EXPECT_THAT(compared.output, HasSubstr("difference before"));
  EXPECT_THAT(compared.output, Not(HasSubstr("after")));
  EXPECT_TRUE(std::filesystem::exists(Path("out/difference.svg")));
  // Another run of it leaves no plot of this one.
  ASSERT_EQ(OnRoom("compare", "--no-adjust --strategies graph --gt " +
                                  Path("truth.lowlap") + " -o " + Path("out"))
                .exit_code,
            0);
  EXPECT_TRUE(std::filesystem::exists(Path("out/position_error.svg")));
  EXPECT_FALSE(std::filesystem::exists(Path("out/difference.svg")));
}

TEST_F(CompareCommand, UnknownStrategiesAreRefused) {
  const Outcome refused =
      OnRoom("compare", "--strategies graph,guess -o " + Path("out"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output,
              HasSubstr("unknown strategy 'guess'; known: graph, chain"));
  EXPECT_EQ(FilesIn("out"), 0u);
}

TEST_F(CompareCommand, AFileInPlaceOfTheOutputFolderIsNamed) {
  Write("file", "in the way");
  for (const char* command : {"compare", "ablate"}) {
    const Outcome refused =
        OnRoom(command, "--gt " + Path("truth.lowlap") + " -o " + Path("file"));
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.output, HasSubstr(Path("file")));
    EXPECT_THAT(refused.output, HasSubstr("cannot be made a folder"));
  }
}

TEST_F(CompareCommand, AblationPrintsItsTables) {
  const Outcome ablated =
      OnRoom("ablate", "--gt " + Path("truth.lowlap") +
                           " --thresholds 1,4 -o " + Path("out"));
  ASSERT_EQ(ablated.exit_code, 0) << ablated.output;
  for (const char* part :
       {"1 px", "4 px", "a contrario", "points + lines", "coplanar",
        "all + adjustment", "mean position error", "6/6", "pairs",
        "planes + directions"}) {
    EXPECT_THAT(ablated.output, HasSubstr(part));
  }
  EXPECT_EQ(FilesIn("out"), 5u);
}

TEST_F(CompareCommand, AblationNeedsTruthAndPositiveThresholds) {
  EXPECT_NE(OnRoom("ablate", "").exit_code, 0);
  const Outcome refused =
      OnRoom("ablate", "--thresholds 0 --gt " + Path("truth.lowlap"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("thresholds must be positive"));
}

}  // namespace
}  // namespace lowlap
