// What commands on a solved or measured scene do with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli_fixture.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/io/internal/scene_binary.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class SceneFlags : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    ASSERT_EQ(Lowlap("simulate --views 5 --points 40 --lines 20 --noise 0.5 "
                     "-o " +
                     Room() + " --truth " + Truth())
                  .exit_code,
              0);
  }
  std::string Room() const { return Path("room.lowlap"); }
  std::string Truth() const { return Path("truth.lowlap"); }
};

TEST_F(SceneFlags, TheSceneMayFollowRefineIntrinsics) {
  const auto solved = [&](const std::string& arguments) {
    fs::remove_all(Path("out"));
    const Outcome outcome = Lowlap(arguments + " -o " + Path("out"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return ReadText(Path("out/scene.lowlap"));
  };
  EXPECT_EQ(
      solved("solve --refine-intrinsics " + Room()),
      solved("solve " + Room() + " --refine-intrinsics focal,distortion"));
  EXPECT_EQ(
      solved("adjust --refine-intrinsics " + Truth()),
      solved("adjust " + Truth() + " --refine-intrinsics focal,distortion"));
  EXPECT_EQ(solved("solve --refine-intrinsics focal " + Room()),
            solved("solve " + Room() + " --refine-intrinsics=focal"));
  const Outcome wrong = Lowlap("solve --refine-intrinsics shape " + Room() +
                               " -o " + Path("wrong"));
  EXPECT_NE(wrong.exit_code, 0);
  EXPECT_THAT(wrong.output, HasSubstr("no part 'shape'"));
}

// Its relative poses are those of the calibration as it was given.
TEST_F(SceneFlags, MeasurementsOfASolvedSceneAreUsedWithTheirCalibration) {
  ASSERT_EQ(Lowlap("solve --refine-intrinsics all " + Room() + " -o " +
                   Path("refined"))
                .exit_code,
            0);
  const auto ratios = [&](const std::string& scene) {
    const Outcome outcome =
        Lowlap("scales " + scene + " --profile " + Path("ratios.csv"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return ReadText(Path("ratios.csv"));
  };
  EXPECT_EQ(ratios(Path("refined/scene.lowlap")), ratios(Room()));
}

TEST_F(SceneFlags, SolveWritesNothingOverItsInput) {
  fs::create_directory(Path("matches"));
  const std::string listing = Path("matches/sfm_data.json");
  ASSERT_EQ(Lowlap("convert " + Room() + " " + listing).exit_code, 0);
  ASSERT_EQ(Lowlap("convert " + Room() + " " + Path("room.json")).exit_code, 0);
  const std::string text = ReadText(listing);
  for (const std::string& arguments :
       {"-i " + listing + " -o " + Path("matches"),
        "-i " + listing + " -m " + Path("matches") + " -o " + Path("matches"),
        // The listing that is there is not the one that is read.
        "-i " + Path("room.json") + " -m " + Path("matches") + " -o " +
            Path("matches/."),
        "-i " + Path("room.json") + " -o " + Path("room.json")}) {
    const Outcome outcome = Lowlap("solve " + arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr("name one file")) << arguments;
    EXPECT_EQ(FilesIn("matches"), 1u) << arguments;
    EXPECT_EQ(ReadText(listing), text) << arguments;
  }
}

TEST_F(SceneFlags, AdjustAndMergeWriteNothingOverTheirInput) {
  const std::string scene = Path("scene.lowlap"), folder = Path("");
  ASSERT_EQ(Lowlap("convert " + Truth() + " " + scene).exit_code, 0);
  const std::string text = ReadText(scene);
  for (const std::string& arguments :
       {"adjust " + scene,
        "merge " + scene + " " + scene + " --scene " + Room(),
        "merge " + Truth() + " " + Truth() + " --scene " + scene}) {
    const Outcome outcome = Lowlap(arguments + " -o " + folder);
    EXPECT_EQ(outcome.exit_code, 1) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr("name one file")) << arguments;
    EXPECT_EQ(ReadText(scene), text) << arguments;
  }
}

TEST_F(SceneFlags, TiesThatAreAskedForAndIgnoredGetAWarning) {
  const std::string points = " --adjust-features points",
                    directions = " --directions",
                    ties = " --coplanar-ties pairs",
                    no_coplanar = " --adjust-features points,lines";
  const std::vector<std::array<std::string, 3>> cases = {
      {points, ties, "--coplanar-ties is ignored: coplanar is not among"},
      {no_coplanar, " --coplanar-ties both",
       "--coplanar-ties is ignored: coplanar is not among"},
      {points, directions, "--directions is ignored: the adjustment has no"},
      {ties, directions, "--directions is ignored: --coplanar-ties pairs"},
      {" --refine-intrinsics focal", directions,
       "--directions is ignored: intrinsics move"},
      {" --principal-point-stddev 0.001", directions,
       "--directions is ignored: intrinsics move"}};
  for (const std::string& command :
       {"solve " + Room(), "adjust " + Truth(),
        "compare " + Room() + " --strategies graph"}) {
    const auto said = [&](const std::string& flags) {
      const Outcome outcome = Lowlap(command + " -q -o " + Path("out") + flags);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
      return outcome.output;
    };
    for (const auto& [with, asked, warning] : cases) {
      if (command[0] == 'c' && with == " --refine-intrinsics focal") continue;
      EXPECT_THAT(said(with + asked), HasSubstr("warning: " + warning));
      EXPECT_THAT(said(with), Not(HasSubstr("is ignored")));
    }
    EXPECT_THAT(said(directions), Not(HasSubstr("is ignored")));
    EXPECT_THAT(said(ties), Not(HasSubstr("is ignored")));
    EXPECT_THAT(said(no_coplanar + ties), Not(HasSubstr("is ignored")));
  }
}

TEST_F(SceneFlags, FocalLengthsThatNoLensHasGetAWarning) {
  const std::string words = "not in millimetres";
  for (const auto& [command, path] :
       {std::pair<std::string, std::string>("solve --no-adjust", Room()),
        {"adjust", Truth()}}) {
    EXPECT_THAT(Lowlap(command + " " + path + " -q -o " + Path("out")).output,
                Not(HasSubstr(words)));
    auto scene = ReadSceneBinary(path);
    ASSERT_TRUE(scene);
    for (auto& [id, intrinsic] : scene->intrinsics) {
      intrinsic.fx_px = intrinsic.fy_px = 4.5;
    }
    ASSERT_TRUE(WriteFileAtomically(path, FormatSceneBinary(*scene).value()));
    EXPECT_THAT(Lowlap(command + " " + path + " -q -o " + Path("out")).output,
                HasSubstr(words))
        << command;
  }
}

TEST_F(SceneFlags, TheSummaryOfAdjustHasNoGrades) {
  const auto summary_of = [&](const std::string& command) {
    const Outcome outcome = Lowlap(command + " -o " + Path("out"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return nlohmann::json::parse(ReadText(Path("out/summary.json")))["solve"];
  };
  const auto solved = summary_of("solve " + Room());
  EXPECT_TRUE(solved["poses"].contains("grades"));
  EXPECT_TRUE(solved.contains("structure"));
  const auto adjusted = summary_of("adjust " + Truth());
  EXPECT_EQ(adjusted["poses"]["placed"], 5);
  EXPECT_FALSE(adjusted["poses"].contains("grades"));
  EXPECT_FALSE(adjusted["poses"].contains("doubtful"));
  EXPECT_FALSE(adjusted.contains("structure"));
  const auto points = summary_of("adjust " + Truth() +
                                 " --adjust-features points --retriangulate");
  EXPECT_TRUE(points.contains("structure"));
  EXPECT_TRUE(points["adjustment"]["coplanar"]["final_rmse_px"].is_null());
}

}  // namespace
}  // namespace lowlap
