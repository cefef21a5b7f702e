// The engine on OpenMVG's own projects.
#include "adapters/openmvg_engine_data.h"

namespace lowlap {
namespace {

using Rotations = LowlapGlobalEngine::Rotations;
using testing::IsOk;

TEST_F(OpenMvgEngineData, GivesThePosesOfTheFilesToTheByte) {
  for (const Project& project : AllProjects()) {
    ExpectPosesOfTheFiles(project, false);
  }
}

TEST_F(OpenMvgEngineData, GivesTheAdjustedPosesOfTheFilesToTheByte) {
  ExpectPosesOfTheFiles(AllProjects()[1], true);
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
