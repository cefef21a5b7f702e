// Files of other programs on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli_fixture.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;

class ConvertCommand : public Cli {};

TEST_F(ConvertCommand, ListsWhatEveryFormatHolds) {
  const Outcome listed = Lowlap("convert --formats");
  ASSERT_EQ(listed.exit_code, 0) << listed.output;
  EXPECT_THAT(listed.output, HasSubstr("limap (read and written): "));
  EXPECT_THAT(listed.output, HasSubstr("obj (written only): "));
  EXPECT_THAT(listed.output, HasSubstr("1dsfm (read only): "));
}

TEST_F(ConvertCommand, CountsWhatIsLeftOut) {
  ASSERT_EQ(Lowlap("simulate --kind room --views 4 -o " + Path("a.lowlap") +
                   " --truth " + Path("truth.lowlap"))
                .exit_code,
            0);
  const Outcome written =
      Lowlap("convert " + Path("truth.lowlap") + " " + Path("poses.kitti"));
  ASSERT_EQ(written.exit_code, 0) << written.output;
  EXPECT_THAT(written.output, HasSubstr("warning: kitti cannot hold "));
  EXPECT_THAT(written.output, HasSubstr(" intrinsics"));
  EXPECT_THAT(written.output, HasSubstr(": left out\n"));
  // Whatever its name is.
  std::filesystem::rename(Path("poses.kitti"), Path("00.txt"));
  const Outcome read =
      Lowlap("convert " + Path("00.txt") + " " + Path("back.json"));
  ASSERT_EQ(read.exit_code, 0) << read.output;
  EXPECT_EQ(read.output, "");
  EXPECT_EQ(Lowlap("evaluate " + Path("truth.lowlap") + " " + Path("00.txt"))
                .exit_code,
            0);
}

TEST_F(ConvertCommand, SaysWhereNothingIsLeft) {
  Write("00.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n");
  const std::string poses = Path("00.txt") + " ";
  for (const char* option : {" --drop-solution", " --max-point-matches 5"}) {
    const Outcome without =
        Lowlap("convert " + poses + Path("views.json") + option);
    EXPECT_EQ(without.exit_code, 0) << without.output;
    EXPECT_THAT(without.output, HasSubstr("holds no measurements"));
  }
  const Outcome judged =
      Lowlap("evaluate " + poses + poses + "--relative-poses");
  EXPECT_EQ(judged.exit_code, 1);
  EXPECT_THAT(judged.output, HasSubstr("no relative poses to judge"));
}

TEST_F(ConvertCommand, ReadsInTheFormatThatIsNamed) {
  Write("lines", "1 0 0 1 2 0 1 2 4 0 10 20 30 40 9 0 1 2 3 4\n");
  const std::string output = " " + Path("out.json");
  EXPECT_EQ(Lowlap("convert " + Path("lines") + output + " --from line3dpp")
                .exit_code,
            0);
  const Outcome wrong =
      Lowlap("convert " + Path("lines") + output + " --from bundler");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.output, HasSubstr(Path("lines") + ": line 1: "));
}

TEST_F(ConvertCommand, NeedsTwoFiles) {
  const Outcome outcome = Lowlap("convert " + Path("a.json"));
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("error: "));
}

}  // namespace
}  // namespace lowlap
