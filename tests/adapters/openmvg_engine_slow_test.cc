// The engine on OpenMVG's own projects.
#include <gtest/gtest.h>

#include <iostream>

#include "adapters/openmvg_host.h"
#include "adapters/temporary_folder.h"
#include "cli/cli_fixture.h"
#include "support/data_folder.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using Rotations = LowlapGlobalEngine::Rotations;
using testing::IsOk;

class OpenMvgEngineData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (DataFolder().empty()) GTEST_SKIP() << "skipped: no data";
  }
  static std::string Path(const std::string& name) {
    return DataFolder() + "/" + name;
  }
  Scene SolvedByCommand(const std::string& arguments) const {
    const Outcome outcome =
        Lowlap("solve " + arguments + " -o " + folder_.Path("out"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    const auto scene = ReadScene(folder_.Path("out/scene.lowlap"));
    EXPECT_THAT(scene, IsOk());
    return scene ? *scene : Scene();
  }

  const TemporaryFolder folder_;
};

TEST_F(OpenMvgEngineData, GivesThePosesOfTheFilesToTheByte) {
  struct Case {
    const char* listing;
    const char* matches;
    std::size_t num_views;
    bool also_adjusted;
  };
  for (const Case& project : {Case{"fountain-P11/matches/sfm_data.json",
                                   "fountain-P11/matches", 11, false},
                              Case{"Herz-Jesus-P8/matches/sfm_data.json",
                                   "Herz-Jesus-P8/matches", 8, true},
                              Case{"castle-P19/matches/sfm_data.json",
                                   "castle-P19/matches", 19, false},
                              Case{"castle-P19_without_3_9_14/sfm_data.json",
                                   "castle-P19/matches", 16, false}}) {
    SCOPED_TRACE(project.listing);
    const std::string listing = Path(std::string("openmvg/") + project.listing);
    const std::string matches = Path(std::string("openmvg/") + project.matches);
    auto host = LoadHost(listing, matches, "matches.e.bin");
    ASSERT_THAT(host, IsOk());
    for (const bool adjust : {false, true}) {
      if (adjust && !project.also_adjusted) continue;
      openmvg::TranslationStepOptions options;
      options.solve.adjust = adjust;
      const auto poses = PosesOfEngine(&*host, Rotations::kLowlap, options);
      const Scene solved =
          SolvedByCommand("-i " + listing + " -m " + matches +
                          " -M matches.e.bin" + (adjust ? "" : " --no-adjust"));
      EXPECT_EQ(poses, PosesOfHost(solved.poses));
      std::cout << project.listing << (adjust ? ", adjusted: " : ": ")
                << poses.size() << " of " << host->scene.views.size()
                << " views placed\n";
      EXPECT_EQ(host->scene.views.size(), project.num_views);
      EXPECT_FALSE(poses.empty());
    }
  }
}

TEST_F(OpenMvgEngineData, UsesTheLinesOfThePhotographs) {
  const std::string matches = Path("openmvg/Herz-Jesus-P8/matches");
  const std::string listing = matches + "/sfm_data.json";
  auto host = LoadHost(listing, matches, "matches.e.bin");
  ASSERT_THAT(host, IsOk());
  const auto points = PosesOfEngine(&*host, Rotations::kLowlap);
  host->scene.s_root_path = Path("strecha/Herz-Jesus-P8/images");
  const auto lines = PosesOfEngine(&*host, Rotations::kLowlap);
  const Scene scene = SolvedByCommand("--images " + host->scene.s_root_path +
                                      " --no-adjust -i " + listing + " -m " +
                                      matches + " -M matches.e.bin");
  EXPECT_EQ(lines, scene.poses);
  EXPECT_EQ(lines.size(), 8u);
  EXPECT_NE(lines, points);
  EXPECT_FALSE(scene.line_tracks.empty());

  openmvg::TranslationStepOptions options;
  options.use_photographs = false;
  EXPECT_EQ(PosesOfEngine(&*host, Rotations::kLowlap, options), points);
}

}  // namespace
}  // namespace lowlap
