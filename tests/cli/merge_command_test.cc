// `lowlap merge`, run as a user would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli_fixture.h"

namespace lowlap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A measured room of nine views, and solutions of its views 0-3 and 5-8.
class MergeCommand : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    Expect(
        "simulate --kind room --views 9 --points 40 --lines 60 --noise 0.3 "
        "--pairs window:2 -o " +
        Path("room.lowlap") + " --truth " + Path("truth.lowlap"));
    SolveWithout("4,5,6,7,8", "first");
    SolveWithout("0,1,2,3,4", "second");
  }

  static void Expect(const std::string& arguments) {
    const Outcome outcome = Lowlap(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  }
  void SolveWithout(const std::string& views, const std::string& name) const {
    Expect("solve " + Path("room.lowlap") + " --exclude " + views + " -o " +
           Path(name));
  }
  Outcome Merge(const std::string& arguments) const {
    return Lowlap("merge " + Path("first/scene.lowlap") + " " +
                  Path("second/sfm_data.json") + " -o " + Path("merged") + " " +
                  arguments);
  }
};

TEST_F(MergeCommand, MakesOneModelOfTwo) {
  const Outcome merged = Merge("--strict --scene " + Path("room.lowlap") +
                               " --gt " + Path("truth.lowlap"));
  EXPECT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_THAT(merged.output, AllOf(HasSubstr("first/scene.lowlap: 4 cameras"),
                                   HasSubstr("cameras placed: 9/9"),
                                   HasSubstr("position error")));
  const std::string summary = ReadText(Path("merged/summary.json"));
  EXPECT_THAT(summary, AllOf(HasSubstr("\"command\": \"merge\""),
                             HasSubstr("bear out all of it")));
  const std::string report = ReadText(Path("merged/report.html"));
  EXPECT_THAT(report, AllOf(HasSubstr("\"warnings\":[],\"notes\":["),
                            HasSubstr("bear out all of it"),
                            Not(HasSubstr("\"notes\":[]"))));
}

// Without view 4 and all that sees past it, nothing joins the two.
TEST_F(MergeCommand, WritesNothingIfNothingTiesTheModels) {
  Expect(
      "simulate --kind room --views 9 --points 40 --lines 60 --noise 0.3 "
      "--pairs chain -o " +
      Path("chain.lowlap"));
  const Outcome refused =
      Merge("--scene " + Path("chain.lowlap") + " --exclude 000004.png");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, AllOf(HasSubstr("the models cannot be merged"),
                                    HasSubstr("no relative pose joins them"),
                                    HasSubstr("000005.png, 000006.png")));
  EXPECT_EQ(FilesIn("merged"), 0u);
}

TEST_F(MergeCommand, NeedsMeasurements) {
  const Outcome neither = Merge("");
  EXPECT_EQ(neither.exit_code, 1);
  EXPECT_THAT(neither.output, HasSubstr("--images"));
  const std::string both =
      "--scene " + Path("room.lowlap") + " --images " + Path("first");
  EXPECT_NE(Merge(both).exit_code, 0);
  const Outcome no_model =
      Lowlap("merge --scene " + Path("room.lowlap") + " -o " + Path("merged"));
  EXPECT_NE(no_model.exit_code, 0);
  const Outcome missing = Lowlap("merge " + Path("missing.json") + " --scene " +
                                 Path("room.lowlap") + " -o " + Path("merged"));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.output, HasSubstr("missing.json"));
}

// What was measured has pairs, matches and intrinsics of its own.
TEST_F(MergeCommand, RefusesFlagsOfPhotographsForWhatWasMeasured) {
  Write("K.txt", "1000 0 320\n0 1000 240\n0 0 1\n");
  for (const std::string& flag :
       {std::string("--pairs chain"), "--cache " + Path("cache"),
        std::string("--focal 1000"), "--intrinsics " + Path("K.txt")}) {
    for (const std::string& measured :
         {"--scene " + Path("room.lowlap"), "--database " + Path("a.db")}) {
      const Outcome refused = Merge(measured + " " + flag);
      EXPECT_NE(refused.exit_code, 0);
      EXPECT_THAT(refused.output,
                  HasSubstr(measured.substr(0, measured.find(' ')) +
                            " excludes " + flag.substr(0, flag.find(' '))));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(Path("merged")));
}

TEST_F(MergeCommand, RefusesASceneAndADatabaseAtOnceAndWhatIsNone) {
  const Outcome both =
      Merge("--scene " + Path("room.lowlap") + " --database " + Path("a.db"));
  EXPECT_NE(both.exit_code, 0);
  EXPECT_THAT(both.output, HasSubstr("--scene excludes --database"));
  const Outcome none = Merge("--database " + Path("room.lowlap"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(
      none.output,
      HasSubstr("room.lowlap: --database: there is no COLMAP database"));
  const Outcome missing = Merge("--database " + Path("missing.db"));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.output, HasSubstr("missing.db"));
}

// Blank photographs hold nothing to measure: what is said is about what was
// read before.
TEST_F(MergeCommand, ReadsTruthAndModelsBeforeItMeasures) {
  std::filesystem::create_directories(Path("images"));
  for (const char* name : {"images/000002.pgm", "images/000006.pgm"}) {
    Write(name, "P5\n64 48\n255\n" + std::string(64 * 48, 'x'));
  }
  const std::string images = "--images " + Path("images") + " --focal 60 ";
  EXPECT_THAT(Merge(images + "--gt " + Path("missing.json")).output,
              HasSubstr("missing.json: no such"));
  EXPECT_THAT(Merge(images).output,
              Not(HasSubstr("image of the measured scene")));
  std::filesystem::rename(Path("images/000002.pgm"), Path("images/a.pgm"));
  std::filesystem::rename(Path("images/000006.pgm"), Path("images/b.pgm"));
  EXPECT_THAT(Merge(images).output,
              HasSubstr("first/scene.lowlap: none of its placed cameras is an "
                        "image of the measured scene"));
}

TEST_F(MergeCommand, NamesAModelOfOtherPhotographs) {
  std::string text = ReadText(Path("second/sfm_data.json"));
  for (std::size_t at; (at = text.find(".png")) != std::string::npos;) {
    text.replace(at, 4, ".jpg");
  }
  for (std::size_t at; (at = text.find("\"00000")) != std::string::npos;) {
    text.replace(at, 6, "\"other");
  }
  Write("other.json", text);
  const Outcome merged = Lowlap("merge " + Path("other.json") + " --scene " +
                                Path("room.lowlap") + " -o " + Path("merged"));
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_THAT(merged.output,
              AllOf(HasSubstr("other.json"),
                    HasSubstr("is an image of the measured scene"),
                    Not(HasSubstr("placed:"))));
}

}  // namespace
}  // namespace lowlap
