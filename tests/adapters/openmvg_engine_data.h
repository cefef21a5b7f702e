#pragma once

#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

#include "adapters/openmvg_host.h"
#include "adapters/temporary_folder.h"
#include "cli/cli_fixture.h"
#include "support/data_folder.h"
#include "support/matchers.h"

namespace lowlap {

/// The engine and the command on OpenMVG's own projects, below DataFolder().
class OpenMvgEngineData : public ::testing::Test {
 protected:
  struct Project {
    const char* listing;
    const char* matches;
    std::size_t num_views;
  };
  static std::vector<Project> AllProjects() {
    return {
        {"fountain-P11/matches/sfm_data.json", "fountain-P11/matches", 11},
        {"Herz-Jesus-P8/matches/sfm_data.json", "Herz-Jesus-P8/matches", 8},
        {"castle-P19/matches/sfm_data.json", "castle-P19/matches", 19},
        {"castle-P19_without_3_9_14/sfm_data.json", "castle-P19/matches", 16}};
  }

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
    EXPECT_THAT(scene, testing::IsOk());
    return scene ? *scene : Scene();
  }

  /// The same poses from the engine and from the command, to the byte.
  void ExpectPosesOfTheFiles(const Project& project, bool adjust) const {
    SCOPED_TRACE(project.listing);
    const std::string listing = Path(std::string("openmvg/") + project.listing);
    const std::string matches = Path(std::string("openmvg/") + project.matches);
    auto host = LoadHost(listing, matches, "matches.e.bin");
    ASSERT_THAT(host, testing::IsOk());
    openmvg::TranslationStepOptions options;
    options.solve.adjust = adjust;
    const auto poses =
        PosesOfEngine(&*host, LowlapGlobalEngine::Rotations::kLowlap, options);
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

  const TemporaryFolder folder_;
};

}  // namespace lowlap
