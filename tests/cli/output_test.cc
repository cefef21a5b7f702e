// Where results go: pipes, devices, links, and sets of files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <utility>

#include "adapters/colmap_database.h"
#include "cli_fixture.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Output : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    ASSERT_EQ(Lowlap("simulate --views 4 --points 20 --lines 20 -o " +
                     Path("room.lowlap"))
                  .exit_code,
              0);
    ASSERT_EQ(Lowlap("convert " + Path("room.lowlap") + " " + Path("room.json"))
                  .exit_code,
              0);
  }
  // The status, to be compared before and after.
  static ino_t Inode(const std::string& path) {
    struct stat status {};
    return ::lstat(path.c_str(), &status) == 0 ? status.st_ino : 0;
  }
};

TEST_F(Output, StandardOutputIsAPipeOrAFile) {
  const std::string json = ReadText(Path("room.json"));
  const std::string convert =
      "convert " + Path("room.lowlap") + " /dev/stdout --to json";
  const ino_t device = Inode("/dev/stdout");
  EXPECT_EQ(Lowlap(convert).output, json);
  Write("redirected", "");
  EXPECT_EQ(Lowlap(convert + " > " + Path("redirected")).exit_code, 0);
  EXPECT_EQ(ReadText(Path("redirected")), json);
  Write("appended", "before\n");
  EXPECT_EQ(Lowlap(convert + " >> " + Path("appended")).exit_code, 0);
  EXPECT_EQ(ReadText(Path("appended")), "before\n" + json);
  EXPECT_EQ(Inode("/dev/stdout"), device);
}

TEST_F(Output, DevicesStayAndTellTheirReason) {
  const std::string convert = "convert " + Path("room.lowlap") + " ";
  EXPECT_EQ(Lowlap(convert + "/dev/null --to json").exit_code, 0);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const Outcome full = Lowlap(convert + "/dev/full --to json");
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.output, HasSubstr("No space left on device"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Output, LinksStayAndTheirFilesAreWritten) {
  fs::create_directory(Path("store"));
  Write("store/scene.json", "old");
  fs::create_symlink("store/scene.json", Path("link.json"));
  EXPECT_EQ(Lowlap("convert " + Path("room.lowlap") + " " + Path("link.json"))
                .exit_code,
            0);
  EXPECT_TRUE(fs::is_symlink(Path("link.json")));
  EXPECT_EQ(ReadText(Path("store/scene.json")), ReadText(Path("room.json")));
  EXPECT_EQ(FilesIn("store"), 1u);
}

TEST_F(Output, ABlockedFileKeepsTheWholeSetAway) {
  for (const char* name : {"summary.json", "scene.lowlap"}) {
    const std::string out = std::string("out_") + name;
    fs::create_directories(Path(out) + "/" + name + "/in the way");
    const Outcome solved =
        Lowlap("solve " + Path("room.lowlap") + " --no-adjust -o " + Path(out));
    EXPECT_EQ(solved.exit_code, 1);
    EXPECT_THAT(solved.output, HasSubstr(name));
    EXPECT_THAT(solved.output, HasSubstr("Is a directory"));
    EXPECT_EQ(FilesIn(out), 1u);
  }
  fs::create_directory(Path("truth.json"));
  EXPECT_EQ(Lowlap("simulate --views 4 -o " + Path("a.json") + " --truth " +
                   Path("truth.json"))
                .exit_code,
            1);
  EXPECT_FALSE(fs::exists(Path("a.json")));
  EXPECT_EQ(Lowlap("scales " + Path("room.lowlap") + " --json " +
                   Path("a.json") + " --profile " + Path("truth.json"))
                .exit_code,
            1);
  EXPECT_FALSE(fs::exists(Path("a.json")));
}

TEST_F(Output, AFormatThatCannotHoldTheSceneCostsNoOtherResult) {
  ASSERT_EQ(Lowlap("simulate --views 4 --pairs cycle -o " + Path("a.lowlap"))
                .exit_code,
            0);
  fs::create_directory(Path("out"));
  // Of no images.
  ColmapDatabase(Path("out/none.db"), ColmapDatabase::Version::k3_8);
  const Outcome solved = Lowlap("solve " + Path("a.lowlap") +
                                " --no-adjust -o " + Path("out/none.db"));
  EXPECT_EQ(solved.exit_code, 1);
  EXPECT_THAT(solved.output, HasSubstr(Path("out/none.db")));
  EXPECT_THAT(solved.output, HasSubstr("cameras placed: 4/4"));
  EXPECT_EQ(FilesIn("out"), 6u);
}

TEST_F(Output, WhatCannotBeWrittenIntoIsSaidBeforeTheWork) {
  Write("text.db", "no database");
  for (const auto& [file, what] : {std::pair("none.db", "no such database"),
                                   {"text.db", "not an SQLite database"}}) {
    for (const std::string& command :
         {"solve " + Path("room.lowlap") + " -o ",
          // Not read, either.
          "convert " + Path("no.lowlap") + " ",
          std::string("simulate --views 4 -o "),
          "simulate --views 4 -o " + Path("a.json") + " --truth "}) {
      const Outcome refused = Lowlap(command + Path(file));
      EXPECT_EQ(refused.exit_code, 1) << command;
      EXPECT_THAT(refused.output,
                  StartsWith("error: " + Path(file) + ": " + std::string(what)))
          << command;
    }
  }
  EXPECT_FALSE(fs::exists(Path("scene.lowlap")));
  EXPECT_FALSE(fs::exists(Path("a.json")));
}

TEST_F(Output, WhatAKilledRunLeftGoesWithTheNextOne) {
  Write("b.json.tmp0", "half a scene");
  EXPECT_EQ(
      Lowlap("convert " + Path("room.lowlap") + " " + Path("b.json")).exit_code,
      0);
  EXPECT_EQ(ReadText(Path("b.json")), ReadText(Path("room.json")));
  EXPECT_FALSE(fs::exists(Path("b.json.tmp0")));
}

TEST_F(Output, TheSameInputGivesTheSameBytes) {
  for (const char* out : {"first", "second"}) {
    ASSERT_EQ(
        Lowlap("solve " + Path("room.lowlap") + " --threads 1 -o " + Path(out))
            .exit_code,
        0);
  }
  for (const char* name :
       {"report.html", "sfm_data.json", "scene.lowlap", "cloud.ply"}) {
    EXPECT_EQ(ReadText(Path("first/") + name), ReadText(Path("second/") + name))
        << name;
  }
}

TEST_F(Output, StrictIsForWhatIsNotBeyondDoubt) {
  const std::string solve = "solve " + Path("firm.lowlap") +
                            " --strict --no-adjust -o " + Path("out");
  ASSERT_EQ(Lowlap("simulate --views 6 --pairs window:3 --noise 0.3 -o " +
                   Path("firm.lowlap"))
                .exit_code,
            0);
  const Outcome firm = Lowlap(solve);
  EXPECT_EQ(firm.exit_code, 0) << firm.output;
  // Without its middle, a chain falls apart.
  ASSERT_EQ(
      Lowlap("simulate --views 7 --pairs chain -o " + Path("chain.lowlap"))
          .exit_code,
      0);
  const std::string chain = "solve " + Path("chain.lowlap") +
                            " --exclude 2 --no-adjust -o " + Path("parts");
  EXPECT_EQ(Lowlap(chain).exit_code, 0);
  const Outcome parts = Lowlap(chain + " --strict");
  EXPECT_EQ(parts.exit_code, 2) << parts.output;
  EXPECT_THAT(parts.output, HasSubstr("cameras placed: 4/6"));
  EXPECT_EQ(FilesIn("parts"), 5u);
}

TEST_F(Output, ListsLeaveTheNextArgumentAlone) {
  for (const std::string list :
       {"inspect --exclude 0 ", "scales --features points,lines "}) {
    const Outcome outcome = Lowlap(list + Path("room.lowlap"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  }
}

TEST_F(Output, QuietLeavesWarnings) {
  for (const std::string& command :
       {"convert " + Path("room.lowlap") + " " + Path("room.ply"),
        "simulate --views 4 --points 20 --lines 20 -o " + Path("room.bin")}) {
    const Outcome quiet = Lowlap(command + " -q");
    EXPECT_EQ(quiet.exit_code, 0) << quiet.output;
    EXPECT_THAT(quiet.output, HasSubstr("cannot hold")) << command;
  }
}

// Directions alone do not say how long the steps of a chain are.
TEST_F(Output, ASolutionWithoutCamerasIsAFailure) {
  ASSERT_EQ(
      Lowlap("simulate --views 4 --pairs chain --points 20 --lines 20 -o " +
             Path("chain.lowlap"))
          .exit_code,
      0);
  const Outcome solved = Lowlap("solve " + Path("chain.lowlap") +
                                " --strategy lud -o " + Path("out"));
  EXPECT_EQ(solved.exit_code, 1);
  EXPECT_THAT(solved.output, HasSubstr("chain.lowlap: no camera is placed"));
  EXPECT_TRUE(fs::exists(Path("out/report.html")));
}

}  // namespace
}  // namespace lowlap
