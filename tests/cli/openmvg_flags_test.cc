// The flags of openMVG_main_SfM: `solve` takes them in its own sense, or says
// what it does not do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli_fixture.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class OpenMvgFlags : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    const Outcome simulated = Lowlap(
        "simulate --views 5 --points 40 --lines 20 --pairs all --noise 0.5 "
        "--direction-noise 1 -o " +
        Room());
    ASSERT_EQ(simulated.exit_code, 0) << simulated.output;
  }
  std::string Room() const { return Path("room.lowlap"); }
  // What `solve` writes with these flags, and says.
  std::string Solved(const std::string& flags, std::string* output = nullptr) {
    const std::string out = Path("out" + std::to_string(++num_runs_));
    const Outcome outcome =
        Lowlap("solve -i " + Room() + " --output_dir " + out + " " + flags);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    if (output != nullptr) *output = outcome.output;
    return ReadText(out + "/scene.lowlap");
  }
  void ExpectRefused(const std::string& flags, const std::string& says) {
    const Outcome outcome =
        Lowlap("solve -i " + Room() + " -o " + Path("none") + " " + flags);
    EXPECT_NE(outcome.exit_code, 0) << flags;
    EXPECT_THAT(outcome.output, HasSubstr(says)) << flags;
    EXPECT_FALSE(std::filesystem::exists(Path("none"))) << flags;
  }

  int num_runs_ = 0;
};

TEST_F(OpenMvgFlags, MeanWhatLowlapsOwnMean) {
  const std::string adjusted = Solved("");
  const std::string composed = Solved("--no-adjust");
  ASSERT_NE(adjusted, composed);
  EXPECT_EQ(Solved("-s GLOBAL -e ADJUST_ALL -f NONE"), adjusted);
  EXPECT_EQ(Solved("--sfm_engine GLOBAL --refine_extrinsic_config NONE"),
            composed);
  for (const auto& [number, strategy] :
       {std::pair("1", "linf"), std::pair("2", "l2_chordal"),
        std::pair("3", "soft_l1")}) {
    const std::string by_name =
        Solved(std::string("--no-adjust --strategy ") + strategy);
    EXPECT_EQ(Solved(std::string("-e NONE -T ") + number), by_name) << number;
    EXPECT_NE(by_name, composed) << strategy;
  }
  EXPECT_EQ(Solved("-f \"ADJUST_FOCAL_LENGTH|ADJUST_PRINCIPAL_POINT\""),
            Solved("--refine-intrinsics focal,principal-point"));
  const std::string all = Solved("-f ADJUST_ALL");
  EXPECT_EQ(all,
            Solved("--refine-intrinsics focal,principal-point,distortion"));
  EXPECT_NE(all, adjusted);
}

TEST_F(OpenMvgFlags, NameASceneFileOfOpenMvgToWrite) {
  const std::string file = Path("out/solved.bin");
  const Outcome solved =
      Lowlap("solve " + Room() + " --no-adjust --quiet -o " + file);
  ASSERT_EQ(solved.exit_code, 0) << solved.output;
  EXPECT_EQ(FilesIn("out"), 6u);
  ASSERT_EQ(Lowlap("convert " + Path("out/scene.lowlap") + " " +
                   Path("converted.bin"))
                .exit_code,
            0);
  EXPECT_EQ(ReadText(file), ReadText(Path("converted.bin")));
  // A name that is taken by a file of the results is that file.
  ASSERT_EQ(
      Lowlap("solve " + Room() + " --no-adjust -o " + Path("own/sfm_data.json"))
          .exit_code,
      0);
  EXPECT_EQ(FilesIn("own"), 5u);
  EXPECT_EQ(ReadText(Path("own/sfm_data.json")),
            ReadText(Path("out/sfm_data.json")));
  // A folder is a folder, whatever its name.
  std::filesystem::create_directories(Path("folder.bin"));
  ASSERT_EQ(Lowlap("solve " + Room() + " --no-adjust -o " + Path("folder.bin"))
                .exit_code,
            0);
  EXPECT_EQ(FilesIn("folder.bin"), 5u);
}

TEST_F(OpenMvgFlags, AreIgnoredByNameWhereTheySayNothingToLowlap) {
  std::string output;
  EXPECT_EQ(Solved("-e NONE -R 1 -t 2 -r 1 -c 3 -a a.jpg -b b.jpg "
                   "-S STELLAR -G MST_X -g 5",
                   &output),
            Solved("--no-adjust"));
  for (const char* flag :
       {"-R", "-t", "-r", "-c", "-a", "-b", "-S", "-G", "-g"}) {
    EXPECT_THAT(output, HasSubstr(std::string(flag) + " is ignored: "));
  }
  EXPECT_THAT(output, Not(HasSubstr("-e is ignored")));
}

TEST_F(OpenMvgFlags, AreRefusedWhereLowlapDoesNotDoIt) {
  for (const char* engine : {"INCREMENTAL", "INCREMENTALV2", "STELLAR"}) {
    ExpectRefused(std::string("-s ") + engine,
                  std::string("the place of GLOBAL, not of ") + engine);
  }
  ExpectRefused("-P", "-P: lowlap does not use measured positions (GPS)");
  ExpectRefused("-T 4", "methods 1, 2 and 3, not 4");
  ExpectRefused("-T 3 --strategy graph", "excludes");
  ExpectRefused("-f ADJUST_SHAPE", "'ADJUST_SHAPE' names no parts");
  ExpectRefused("-f NONE --refine-intrinsics focal", "excludes");
  ExpectRefused("-f ADJUST_ALL -e NONE", "-f: the bundle adjustment");
  ExpectRefused("--refine-intrinsics focal -e NONE",
                "--refine-intrinsics: the bundle adjustment");
  for (const std::string of_adjustment :
       {"--adjust-features points", "--coplanar-ties both", "--no-directions",
        "--principal-point-stddev 0.001"}) {
    ExpectRefused("-e NONE " + of_adjustment,
                  " has no effect with -e NONE, which leaves the bundle "
                  "adjustment out");
  }
  ExpectRefused("-e NONE --no-directions", "--[no-]directions has no effect");
  ExpectRefused("-e ADJUST_ROTATION", "ADJUST_ROTATION");
}

}  // namespace
}  // namespace lowlap
