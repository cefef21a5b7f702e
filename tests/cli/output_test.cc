// Where results go: pipes, devices, links, and sets of files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "cli_fixture.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

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

TEST_F(Output, WhatAKilledRunLeftGoesWithTheNextOne) {
  Write("b.json.tmp0", "half a scene");
  EXPECT_EQ(
      Lowlap("convert " + Path("room.lowlap") + " " + Path("b.json")).exit_code,
      0);
  EXPECT_EQ(ReadText(Path("b.json")), ReadText(Path("room.json")));
  EXPECT_FALSE(fs::exists(Path("b.json.tmp0")));
}

}  // namespace
}  // namespace lowlap
