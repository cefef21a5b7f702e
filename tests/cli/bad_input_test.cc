// What every command says to input that cannot be right: what is wrong, and
// where; nothing is left behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "cli_fixture.h"
#include "support/data_folder.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class BadInput : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    const Outcome simulated =
        Lowlap("simulate --views 5 --points 30 --lines 15 -o " +
               Path("room.lowlap") + " --truth " + Path("truth.lowlap"));
    ASSERT_EQ(simulated.exit_code, 0) << simulated.output;
    Write("file", "in the way");
  }
  // Refused, with these words, and without leaving anything.
  void ExpectRefused(const std::string& arguments, const std::string& says) {
    const Outcome outcome = Lowlap(arguments);
    EXPECT_NE(outcome.exit_code, 0) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr(says)) << arguments;
    EXPECT_FALSE(std::filesystem::exists(Path("out"))) << arguments;
  }
  std::string Room() const { return Path("room.lowlap"); }
  std::string Truth() const { return Path("truth.lowlap"); }
  std::string Out() const { return " -o " + Path("out") + " "; }
};

TEST_F(BadInput, CommandsAndNumbers) {
  ExpectRefused("calibrate a b", "there is no command 'calibrate'");
  ExpectRefused("solve" + Out(), "the scene is missing: first argument, or -i");
  const std::string solve = "solve " + Room() + Out();
  ExpectRefused(solve + "--threshold -1", "'-1' is not a positive number");
  ExpectRefused(solve + "--threshold nan", "'nan' is not a positive number");
  ExpectRefused(solve + "--seed -1", "'-1' is not a non-negative number");
  // 2^64 and more would be taken for 2^64 - 1.
  for (const char* seed : {"18446744073709551616", "1e3", "7x", "-0", "\"\""}) {
    ExpectRefused(solve + "--seed " + seed, "--seed");
  }
  EXPECT_EQ(
      Lowlap("inspect " + Room() + " --seed 18446744073709551615").exit_code,
      0);
  ExpectRefused(solve + "--principal-point-stddev inf",
                "'inf' is not a non-negative number");
}

TEST_F(BadInput, OptionsThatWouldBeIgnored) {
  const std::string solve = "solve " + Room() + Out();
  ExpectRefused(solve + "-M matches.f.txt", "requires --matchdir");
  for (const char* of_adjustment :
       {"--refine-intrinsics focal", "--adjust-features points",
        "--coplanar-ties both", "--no-directions"}) {
    ExpectRefused(solve + "--no-adjust " + of_adjustment, "excludes");
  }
  ExpectRefused(solve + "--threshold 2", "needs --criterion ransac");
  ExpectRefused("compare " + Room() + Out() + "--reference guess",
                "unknown strategy 'guess'");
  const std::string evaluate = "evaluate " + Room() + " " + Truth();
  ExpectRefused(evaluate + " --expect 0-1", "requires --relative-poses");
  ExpectRefused(evaluate + " --relative-poses --gt-lines " + Path("file"),
                "excludes");
  ExpectRefused(
      "simulate -o " + Path("out") + " --truth " + folder_.string() + "/./out",
      "name one file");
  // Nothing is written over what is read.
  for (const char* command : {"inspect ", "scales ", "diagnose "}) {
    ExpectRefused(command + Room() + " --json " + Room(), "name one file");
  }
  ExpectRefused("scales " + Room() + " --json " + Path("out") + " --profile " +
                    folder_.string() + "/./out",
                "--json and --profile name one file");
  ExpectRefused("features " + Room() + " --draw " + Room(), "name one file");
  // The other studies have their own strategies and simulations.
  for (const char* study : {"--trust", "--look-alikes"}) {
    for (const char* of_curves : {"--strategies lud", "--seeds 3",
                                  "--tolerance 0.1", "--time-limit 1"}) {
      ExpectRefused("robustness" + Out() + study + " " + of_curves, "excludes");
    }
  }
}

TEST_F(BadInput, OptionsOfOtherKindsOfSimulation) {
  for (const auto& [kind, option] : {std::pair("ring", "--look-outwards"),
                                     {"corridor", "--look-outwards"},
                                     {"room", "--off-line 0.1"},
                                     {"room", "--twin-baseline 0.1"},
                                     {"cloud", "--wall-bulge 0.1"},
                                     {"cloud", "--box-offset 0.1"}}) {
    const std::string name =
        std::string(option).substr(0, std::string(option).find(' '));
    ExpectRefused("simulate" + Out() + "--kind " + kind + " " + option,
                  name + " has no effect with --kind " + kind + ", only with ");
  }
}

TEST_F(BadInput, NumbersAreNamedByTheirOptions) {
  ExpectRefused("simulate" + Out() + "--views 1", "--views: ");
  ExpectRefused("simulate" + Out() + "--points -1", "--points: ");
  ExpectRefused("simulate" + Out() + "--wrong-points 2",
                "--wrong-points: '2' is not a number from 0 to 1");
  ExpectRefused("simulate" + Out() + "--off-line nan",
                "--off-line: 'nan' is not a non-negative number");
  // Before photographs are looked for.
  for (const char* tilt : {"0.5", "17", "nan"}) {
    ExpectRefused(
        "run " + folder_.string() + Out() + "--max-tilt " + tilt,
        "--max-tilt: '" + std::string(tilt) + "' is not a number from 1 to 16");
  }
}

TEST_F(BadInput, AListWithoutPairsOfViews) {
  Write("pairs.txt", "# none\n");
  ExpectRefused("run " + RoomFolder() + "/images --focal 600 --no-cache" +
                    Out() + "--pairs " + Path("pairs.txt"),
                "error: " + Path("pairs.txt") + ": names no pair of views");
}

// Blank photographs have no relative pose, whether or not a pair names them.
TEST_F(BadInput, PhotographsInNoPairAreSaid) {
  std::filesystem::create_directory(Path("images"));
  for (const char* name : {"images/a.pgm", "images/b.pgm", "images/c.pgm"}) {
    Write(name, "P5\n64 48\n255\n" + std::string(64 * 48, 'x'));
  }
  Write("pairs.txt", "a.pgm b.pgm\n");
  ExpectRefused("run " + Path("images") + " --focal 60 --no-cache" + Out() +
                    "--pairs " + Path("pairs.txt"),
                "warning: c.pgm has no relative pose: no pair with it was "
                "matched");
}

// A folder for another number of trials would refuse the right one.
TEST_F(BadInput, NumbersOfTrialsLeaveNoFolder) {
  ExpectRefused("robustness --trust --scenes 0" + Out(), "--scenes");
  ExpectRefused("robustness --look-alikes --pairs -1" + Out(), "--pairs");
}

TEST_F(BadInput, ScenesThatCannotBeRead) {
  const std::string whole = ReadText(Room());
  Write("cut.lowlap", whole.substr(0, whole.size() / 2));
  const std::string gt = " --gt " + Truth();
  for (const std::string& command :
       {"solve" + Out(), "compare" + Out(), "ablate" + Out() + gt,
        "subsets" + Out() + gt, std::string("diagnose "),
        std::string("scales "), std::string("inspect ")}) {
    const std::size_t name = command.find(' ');
    const auto on = [&](const std::string& scene) {
      return command.substr(0, name + 1) + Path(scene) + command.substr(name);
    };
    ExpectRefused(on("cut.lowlap"), "cut.lowlap: byte ");
    ExpectRefused(on("none.lowlap"), "none.lowlap: no such file");
  }
}

// Found before anything is computed.
TEST_F(BadInput, OutputFoldersThatCannotBe) {
  for (const char* folder : {"file", "file/below", "file/"}) {
    for (const std::string& command :
         {"solve " + Room(), "compare " + Room(), "adjust " + Truth(),
          "ablate " + Room() + " --gt " + Truth(),
          "subsets " + Room() + " --drop 1 --gt " + Truth(),
          "run " + folder_.string() + " --focal 500",
          std::string("robustness --quick --scenario noise"),
          std::string("robustness --trust --scenes 1")}) {
      const Outcome outcome = Lowlap(command + " -o " + Path(folder));
      EXPECT_EQ(outcome.exit_code, 1) << command;
      EXPECT_THAT(
          outcome.output,
          HasSubstr("cannot be made a folder: " + Path("file") + " is a file"))
          << command;
      EXPECT_THAT(outcome.output, Not(HasSubstr("adjustment"))) << command;
    }
  }
}

TEST_F(BadInput, TruthThatSaysNothing) {
  const std::string says = "room.lowlap: holds no camera poses";
  const std::string gt = " --gt " + Room();
  ExpectRefused("solve " + Room() + gt + Out(), says);
  ExpectRefused("compare " + Room() + gt + Out(), says);
  ExpectRefused("ablate " + Room() + gt + Out(), says);
  ExpectRefused("subsets --drop 1 " + Room() + gt + Out(), says);
  ExpectRefused("evaluate " + Truth() + gt, says);
  // A folder of true cameras of other images.
  const std::string other = RoomFolder();
  ExpectRefused("evaluate " + Truth() + " " + other,
                "samples/room: no view of the scene has a true pose");
}

TEST_F(BadInput, SolutionsWithoutCameras) {
  ExpectRefused("evaluate " + Room() + " " + Truth(),
                "room.lowlap: fewer than 2 cameras are common");
}

TEST_F(BadInput, ExcludedViewsThatAreNotThere) {
  for (const char* command : {"inspect ", "diagnose ", "scales "}) {
    ExpectRefused(
        command + Room() + " --exclude nobody",
        "room.lowlap: no view has the file name or the id \"nobody\"");
  }
  EXPECT_THAT(Lowlap("inspect " + Room() + " --exclude 0").output,
              HasSubstr("views 4"));
}

TEST_F(BadInput, NothingToAdjust) {
  // OpenMVG's listing of views whose cameras are not known.
  ASSERT_EQ(Lowlap("convert " + Room() + " " + Path("room.json")).exit_code, 0);
  std::string text = ReadText(Path("room.json"));
  const std::string key = "\"id_intrinsic\": ";
  for (std::size_t at = 0; (at = text.find(key, at)) != std::string::npos;) {
    at += key.size();
    text.replace(at, 1, "4294967295");
  }
  const std::size_t list = text.find("\"intrinsics\": [");
  const std::size_t after = text.find("\"extrinsics\"");
  ASSERT_NE(list, std::string::npos);
  ASSERT_NE(after, std::string::npos);
  Write("unknown.json",
        text.substr(0, list) + "\"intrinsics\": [], " + text.substr(after));
  const Outcome solved =
      Lowlap("solve " + Path("unknown.json") + " -o " + Path("solved"));
  EXPECT_EQ(solved.exit_code, 0) << solved.output;
  EXPECT_THAT(solved.output,
              HasSubstr("not adjusted: nothing to adjust: no view has both"));
  ExpectRefused("adjust " + Path("solved/scene.lowlap") + Out(),
                "scene.lowlap: nothing to adjust: no view has both");
}

}  // namespace
}  // namespace lowlap
