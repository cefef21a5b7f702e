// Runs the installed command as a user would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "lowlap/io/scene_binary.h"
#include "lowlap/io/scene_json.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Outcome {
  int exit_code = -1;
  std::string output;  // standard output and error
};

Outcome Lowlap(const std::string& arguments) {
  Outcome outcome;
  const std::string line =
      std::string(LOWLAP_COMMAND) + " " + arguments + " 2>&1";
  FILE* pipe = ::popen(line.c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n;
       (n = std::fread(buffer.data(), 1, buffer.size(), pipe));) {
    outcome.output.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

std::string ReadText(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / (std::string("lowlap_cli_") + info->name() +
                                     "_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const {
    return (folder_ / name).string();
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name), std::ios::binary) << text;
  }
  std::size_t FilesIn(const std::string& name) const {
    if (!fs::exists(Path(name))) return 0;
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(Path(name)), {}));
  }

  fs::path folder_;
};

TEST_F(Cli, HelpNamesEveryCommand) {
  const Outcome help = Lowlap("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"run", "solve", "scales", "adjust", "evaluate",
                              "inspect", "convert", "validate", "simulate"}) {
    EXPECT_THAT(help.output, HasSubstr(command));
    const Outcome own = Lowlap(std::string(command) + " --help");
    EXPECT_EQ(own.exit_code, 0) << command;
    EXPECT_THAT(own.output, HasSubstr("Usage")) << command;
  }
}

TEST_F(Cli, NoCommandIsAnError) { EXPECT_NE(Lowlap("").exit_code, 0); }

TEST_F(Cli, SimulateSolveAndTheFilesThatComeOut) {
  ASSERT_EQ(
      Lowlap("simulate --kind room --views 8 --pairs window:2 --noise 0.3 "
             "--seed 3 -o " +
             Path("room.lowlap"))
          .exit_code,
      0);
  const Outcome solved =
      Lowlap("solve " + Path("room.lowlap") + " -o " + Path("out"));
  ASSERT_EQ(solved.exit_code, 0) << solved.output;
  EXPECT_THAT(solved.output, HasSubstr("cameras placed: 8/8"));
  for (const char* name : {"sfm_data.json", "scene.lowlap", "summary.json",
                           "cloud.ply", "report.html"}) {
    EXPECT_TRUE(fs::exists(Path("out") + "/" + name)) << name;
  }
  EXPECT_EQ(FilesIn("out"), 5u);
  const auto text = ReadSceneJson(Path("out/sfm_data.json"));
  const auto binary = ReadSceneBinary(Path("out/scene.lowlap"));
  ASSERT_TRUE(text) << text.error().ToString();
  ASSERT_TRUE(binary) << binary.error().ToString();
  EXPECT_TRUE(*text == *binary);
  EXPECT_EQ(text->poses.size(), 8u);

  EXPECT_EQ(Lowlap("validate " + Path("out/scene.lowlap")).exit_code, 0);
  const Outcome scales = Lowlap("scales " + Path("room.lowlap") + " --json " +
                                Path("scales.json"));
  EXPECT_EQ(scales.exit_code, 0);
  EXPECT_THAT(scales.output, HasSubstr("0-1-2"));
  EXPECT_THAT(ReadText(Path("scales.json")), HasSubstr("\"log_ratio\""));
  EXPECT_EQ(
      Lowlap("adjust " + Path("out/scene.lowlap") + " -o " + Path("adjusted"))
          .exit_code,
      0);
  const Outcome inspected = Lowlap("inspect " + Path("room.lowlap"));
  EXPECT_EQ(inspected.exit_code, 0);
  EXPECT_THAT(inspected.output, HasSubstr("views 8"));
}

TEST_F(Cli, ThreadsDoNotChangeTheUnadjustedResult) {
  ASSERT_EQ(Lowlap("simulate --views 6 --noise 1 -o " + Path("room.lowlap"))
                .exit_code,
            0);
  for (const char* threads : {"1", "2"}) {
    ASSERT_EQ(
        Lowlap("solve " + Path("room.lowlap") + " --no-adjust --threads " +
               threads + " -o " + Path(std::string("out") + threads))
            .exit_code,
        0);
  }
  EXPECT_EQ(ReadText(Path("out1/scene.lowlap")),
            ReadText(Path("out2/scene.lowlap")));
}

TEST_F(Cli, ConvertKeepsEverything) {
  ASSERT_EQ(Lowlap("simulate --views 4 -o " + Path("a.lowlap")).exit_code, 0);
  ASSERT_EQ(
      Lowlap("convert " + Path("a.lowlap") + " " + Path("b.json")).exit_code,
      0);
  ASSERT_EQ(
      Lowlap("convert " + Path("b.json") + " " + Path("c.lowlap")).exit_code,
      0);
  EXPECT_EQ(ReadText(Path("a.lowlap")), ReadText(Path("c.lowlap")));
}

TEST_F(Cli, BadInputNamesFileAndCauseAndWritesNothing) {
  Write("broken.json", "{\"sfm_data_version\": \"0.3\", ");
  Write("K.txt", "1 2 3");
  struct Case {
    std::string arguments;
    std::string says;
  };
  const Case cases[] = {
      {"solve " + Path("missing.lowlap"), "missing.lowlap"},
      {"solve " + Path("broken.json"), "broken.json"},
      {"run " + Path("nowhere") + " --focal 1000", "nowhere"},
      {"run " + folder_.string() + " --intrinsics " + Path("K.txt"), "K.txt"},
      {"run " + folder_.string() + " --focal 1000", "at least two images"},
      {"adjust " + Path("broken.json"), "broken.json"},
  };
  for (const Case& each : cases) {
    const Outcome outcome = Lowlap(each.arguments + " -o " + Path("out"));
    EXPECT_NE(outcome.exit_code, 0) << each.arguments;
    EXPECT_THAT(outcome.output, HasSubstr("error: ")) << each.arguments;
    EXPECT_THAT(outcome.output, HasSubstr(each.says)) << each.arguments;
    EXPECT_EQ(FilesIn("out"), 0u) << each.arguments;
  }
  EXPECT_NE(Lowlap("validate " + Path("broken.json")).exit_code, 0);
  EXPECT_NE(Lowlap("convert " + Path("broken.json") + " " + Path("x.lowlap"))
                .exit_code,
            0);
  EXPECT_FALSE(fs::exists(Path("x.lowlap")));
  EXPECT_NE(Lowlap("simulate --kind pyramid -o " + Path("x.lowlap")).exit_code,
            0);
  EXPECT_NE(Lowlap("simulate --views 0 -o " + Path("x.lowlap")).exit_code, 0);
  EXPECT_FALSE(fs::exists(Path("x.lowlap")));
}

TEST_F(Cli, UnknownFeaturesAndFlagsAreRefused) {
  ASSERT_EQ(Lowlap("simulate --views 4 -o " + Path("a.lowlap")).exit_code, 0);
  const std::string solve =
      "solve " + Path("a.lowlap") + " -o " + Path("out") + " ";
  EXPECT_THAT(Lowlap(solve + "--features circles").output,
              HasSubstr("points, lines, coplanar"));
  EXPECT_NE(Lowlap(solve + "--features circles").exit_code, 0);
  EXPECT_NE(Lowlap(solve + "--strategy magic").exit_code, 0);
  EXPECT_NE(Lowlap(solve + "--threads -2").exit_code, 0);
  EXPECT_NE(Lowlap(solve + "--exclude nobody").exit_code, 0);
  EXPECT_EQ(FilesIn("out"), 0u);
}

TEST_F(Cli, ExcludedViewsAreLeftOut) {
  ASSERT_EQ(Lowlap("simulate --views 8 --pairs window:3 -o " + Path("a.lowlap"))
                .exit_code,
            0);
  const Outcome solved =
      Lowlap("solve " + Path("a.lowlap") + " --exclude 2,5 -o " + Path("out"));
  ASSERT_EQ(solved.exit_code, 0) << solved.output;
  EXPECT_THAT(solved.output, HasSubstr("cameras placed: 6/6"));
}

}  // namespace
}  // namespace lowlap
