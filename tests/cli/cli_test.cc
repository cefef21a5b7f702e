// Runs the installed command as a user would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli_fixture.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/io/internal/scene_binary.h"
#include "support/data_folder.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

std::string RoomImages() { return RoomFolder() + "/images"; }

TEST_F(Cli, HelpNamesEveryCommand) {
  const Outcome help = Lowlap("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command :
       {"run", "solve", "compare", "ablate", "scales", "adjust", "evaluate",
        "features", "inspect", "diagnose", "subsets", "convert", "validate",
        "simulate", "robustness"}) {
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

TEST_F(Cli, DirectionsHoldTheAdjustmentUnlessToldNotTo) {
  const std::string room = Path("room.lowlap"), solved = Path("solved");
  ASSERT_EQ(Lowlap("simulate --views 6 --noise 0.3 -o " + room).exit_code, 0);
  ASSERT_EQ(Lowlap("solve " + room + " -o " + solved).exit_code, 0);
  for (const std::string& command :
       {"solve " + room, "adjust " + solved + "/scene.lowlap"}) {
    const auto summary_of = [&](const std::string& flags) {
      const Outcome outcome = Lowlap(command + flags + " -o " + Path("out"));
      EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
      return ReadText(Path("out/summary.json"));
    };
    const auto without = HasSubstr("\"directions\": 0");
    EXPECT_THAT(summary_of(""), Not(without));
    EXPECT_THAT(summary_of(" --directions"), Not(without));
    EXPECT_THAT(summary_of(" --no-directions"), without);
    EXPECT_THAT(summary_of(" --directions --coplanar-ties pairs"), without);
  }
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
      {"run " + RoomImages(), "0000.jpg: holds no focal length in EXIF data"},
      {"run " + RoomImages() + " --focal 9 --refine-intrinsics shape",
       "focal, aspect, principal-point"},
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

TEST_F(Cli, FeaturesAreCountedAndDrawn) {
  std::string image;
  for (const auto& entry : fs::directory_iterator(RoomImages())) {
    if (entry.path().extension() == ".jpg") image = entry.path().string();
  }
  const Outcome both = Lowlap("features " + image + " --draw " + Path("o.png"));
  ASSERT_EQ(both.exit_code, 0) << both.output;
  EXPECT_THAT(both.output, HasSubstr("points: "));
  EXPECT_THAT(both.output, HasSubstr("segments: "));
  EXPECT_EQ(ReadText(Path("o.png")).substr(1, 3), "PNG");
  const Outcome lines = Lowlap("features --lines " + image);
  EXPECT_THAT(lines.output, Not(HasSubstr("points: ")));
  EXPECT_THAT(Lowlap("features none.jpg").output, HasSubstr("none.jpg"));
}

TEST_F(Cli, LineMatchesAreJudgedByTrueEdges) {
  ASSERT_EQ(Lowlap("simulate --kind room --views 4 -o " + Path("room.lowlap") +
                   " --truth " + Path("truth.lowlap"))
                .exit_code,
            0);
  const std::string evaluate =
      "evaluate " + Path("room.lowlap") + " --gt " + Path("truth.lowlap");
  Write("edges.json", R"({"edges": [{"p0": [0,0]}]})");
  const Outcome bad = Lowlap(evaluate + " --gt-lines " + Path("edges.json"));
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.output, HasSubstr("edges.json: edge 0: array index"));
  Write("scene.json", "{}");
  EXPECT_THAT(Lowlap(evaluate + " --gt-lines " + Path("scene.json")).output,
              HasSubstr("scene.json: key 'edges' not found"));
  EXPECT_NE(Lowlap(evaluate + " --line-pairs all").exit_code, 0);
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

// Starts a run on photographs and sends a signal while it reads the cache entry
// `entry`: a pipe stands there, which the run opens and waits for. The output
// ends with "exit CODE".
Outcome SignalledRun(const std::string& arguments, const std::string& entry,
                     const std::string& signal) {
  const std::string pid = entry + ".pid";
  const std::string script =
      "mkfifo " + entry + "; { sh -c \"echo \\$\\$ > " + pid +
      "; exec env --default-signal=INT " + std::string(LOWLAP_COMMAND) +
      " run " + arguments + "\"; echo exit $?; [ -p " + entry + " ] && : < " +
      entry + "; } & exec 3> " + entry + "; rm " + entry + "; kill -" + signal +
      " $(cat " + pid + "); exec 3>&-; wait; rm " + pid;
  Outcome outcome;
  FILE* pipe = ::popen(("bash -c '" + script + "' 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n;
       (n = std::fread(buffer.data(), 1, buffer.size(), pipe));) {
    outcome.output.append(buffer.data(), n);
  }
  outcome.exit_code = ::pclose(pipe);
  return outcome;
}

// Names of the entries of a cache that begin so.
std::vector<std::string> EntriesOf(const std::string& cache,
                                   const std::string& kind) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(cache)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(kind, 0) == 0) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST_F(Cli, AnInterruptedOrKilledRunGoesOnFromItsCache) {
  const std::string run = RoomImages() + " --intrinsics " + RoomImages() +
                          "/K.txt --pairs chain --max-tilt 1 --threads 1 -o ";
  const Outcome whole =
      Lowlap("run " + run + Path("whole") + " --cache " + Path("cache"));
  ASSERT_EQ(whole.exit_code, 0) << whole.output;
  EXPECT_EQ(FilesIn("whole"), 5u);
  EXPECT_THAT(whole.output, HasSubstr("peak memory"));
  EXPECT_THAT(whole.output,
              HasSubstr("features, matching and relative poses together"));

  // As if an earlier run had been stopped after two photographs.
  const std::vector<std::string> features =
      EntriesOf(Path("cache"), "features");
  const std::vector<std::string> matches = EntriesOf(Path("cache"), "matches");
  ASSERT_EQ(features.size(), 11u);
  ASSERT_FALSE(matches.empty());
  const std::string cache = Path("out/cache/");
  fs::create_directories(cache);
  for (const std::size_t n : {0u, 1u}) {
    fs::copy_file(Path("cache/") + features[n], cache + features[n]);
  }
  const Outcome interrupted =
      SignalledRun(run + Path("out"), cache + features[2], "INT");
  EXPECT_THAT(interrupted.output, HasSubstr("exit 130")) << interrupted.output;
  EXPECT_THAT(interrupted.output,
              HasSubstr("error: interrupted during features"));
  EXPECT_THAT(interrupted.output, HasSubstr("the same command goes on"));
  EXPECT_EQ(FilesIn("out"), 1u);  // the cache

  const Outcome killed =
      SignalledRun(run + Path("out"), cache + matches[0], "KILL");
  EXPECT_THAT(killed.output, HasSubstr("exit 137")) << killed.output;
  EXPECT_THAT(killed.output, HasSubstr("features: 2 of 11 from the cache"));
  EXPECT_EQ(FilesIn("out"), 1u);

  const Outcome resumed = Lowlap("run " + run + Path("out"));
  ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
  EXPECT_THAT(resumed.output, HasSubstr("features: 11 of 11 from the cache"));
  EXPECT_EQ(ReadText(Path("out/scene.lowlap")),
            ReadText(Path("whole/scene.lowlap")));
}

TEST_F(Cli, IntrinsicsOfASceneFileAndRefinement) {
  ASSERT_EQ(Lowlap("simulate --kind room --views 8 --pairs window:2 --noise "
                   "0.3 --seed 3 -o " +
                   Path("room.lowlap"))
                .exit_code,
            0);
  auto scene = ReadSceneBinary(Path("room.lowlap"));
  ASSERT_TRUE(scene);
  for (auto& [id, intrinsic] : scene->intrinsics) {
    intrinsic.fx_px *= 1.02;
    intrinsic.fy_px *= 1.02;
  }
  ASSERT_TRUE(WriteFileAtomically(Path("wrong.lowlap"),
                                  FormatSceneBinary(*scene).value()));
  // A calibration is held, and what the images say of it is said: in the
  // console, the summary and the report.
  const Outcome fixed =
      Lowlap("solve " + Path("wrong.lowlap") + " -o " + Path("fixed"));
  ASSERT_EQ(fixed.exit_code, 0) << fixed.output;
  EXPECT_TRUE(ReadSceneBinary(Path("fixed/scene.lowlap"))->intrinsics ==
              scene->intrinsics);
  const std::string words = "prefer another calibration of intrinsic 0";
  EXPECT_THAT(fixed.output, HasSubstr(words));
  EXPECT_THAT(fixed.output, HasSubstr("--refine-intrinsics focal"));
  EXPECT_THAT(ReadText(Path("fixed/report.html")), HasSubstr(words));
  EXPECT_THAT(ReadText(Path("fixed/summary.json")),
              HasSubstr("\"parts\": \"focal"));
  const Outcome right =
      Lowlap("solve " + Path("room.lowlap") + " -o " + Path("right"));
  EXPECT_THAT(right.output, Not(HasSubstr("another calibration")));
  EXPECT_THAT(ReadText(Path("right/summary.json")),
              HasSubstr("\"calibration_preferences\": []"));
  const Outcome refined =
      Lowlap("solve " + Path("wrong.lowlap") + " -o " + Path("refined") +
             " --refine-intrinsics focal");
  ASSERT_EQ(refined.exit_code, 0) << refined.output;
  EXPECT_THAT(refined.output,
              HasSubstr("focal refined, aspect,principal-point,distortion "
                        "held"));
  EXPECT_THAT(refined.output, HasSubstr("intrinsic 0 (pinhole); focal"));
  // The next adjustment starts from the calibration as it was given.
  const Outcome again =
      Lowlap("adjust " + Path("refined/scene.lowlap") + " -o " + Path("again"));
  ASSERT_EQ(again.exit_code, 0) << again.output;
  EXPECT_TRUE(ReadSceneBinary(Path("again/scene.lowlap"))->intrinsics ==
              scene->intrinsics);
  const Outcome adjusted =
      Lowlap("adjust " + Path("fixed/scene.lowlap") + " -o " +
             Path("adjusted") + " --refine-intrinsics");
  ASSERT_EQ(adjusted.exit_code, 0) << adjusted.output;
  EXPECT_THAT(adjusted.output, HasSubstr("pinhole_radial_k1"));

  // The listing of another scene does not know these photographs, but its only
  // intrinsic would do, if it were for images of this size.
  const Outcome misfit = Lowlap("run " + RoomImages() + " --intrinsics " +
                                Path("wrong.lowlap") + " -o " + Path("run"));
  EXPECT_EQ(misfit.exit_code, 1);
  EXPECT_THAT(misfit.output, HasSubstr("pixels"));
}

TEST_F(Cli, AWrongFocalLengthIsFoundAndTheRelativePosesWithIt) {
  // The room's true focal length is 997.5.
  const Outcome outcome = Lowlap("run " + RoomImages() +
                                 " --focal 1030 --pairs chain --max-tilt 1"
                                 " --refine-intrinsics focal -o " +
                                 Path("out"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("relative poses once more"));
  const auto scene = ReadSceneBinary(Path("out/scene.lowlap"));
  ASSERT_TRUE(scene);
  EXPECT_NEAR(scene->intrinsics.at(0).fx_px, 997.5, 10);
  EXPECT_EQ(scene->intrinsics.at(0).model, CameraModel::kPinhole);
}

TEST_F(Cli, AStudyOfTrustIsWrittenAndNotRepeated) {
  const std::string study =
      "robustness --trust --scenes 1 --seed 3 -o " + Path("trust");
  const Outcome first = Lowlap(study);
  ASSERT_EQ(first.exit_code, 0) << first.output;
  EXPECT_THAT(first.output, HasSubstr("wrong_directions"));
  EXPECT_EQ(FilesIn("trust"), 4u);
  const std::string cameras = ReadText(Path("trust/cameras.csv"));
  EXPECT_THAT(cameras, HasSubstr("mixed,3,"));
  const Outcome again = Lowlap(study);
  EXPECT_THAT(again.output, HasSubstr("6 trials are in trials.jsonl already"));
  EXPECT_EQ(ReadText(Path("trust/cameras.csv")), cameras);
  EXPECT_NE(Lowlap(study + " --quick").exit_code, 0);
}

}  // namespace
}  // namespace lowlap
