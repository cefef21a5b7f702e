// OpenMVG's own solutions of the Strecha scenes: every file form is read, and
// the evaluation gives the figures that are published with them.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "adapters/temporary_folder.h"
#include "lowlap/evaluation/pose_errors.h"
#include "support/data_folder.h"
#include "third_party_adapters/openmvg/internal/import.h"
#include "third_party_adapters/scene_formats.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

class OpenMvgData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (DataFolder().empty()) GTEST_SKIP() << "skipped: no data";
  }
  static std::string Path(const std::string& name) {
    return DataFolder() + "/" + name;
  }
  static Scene Read(const std::string& name) {
    Result<Scene> scene = ReadScene(Path(name));
    EXPECT_TRUE(scene.has_value()) << scene.error().ToString();
    return scene ? std::move(*scene) : Scene();
  }
};

TEST_F(OpenMvgData, EvaluationGivesThePublishedErrors) {
  struct Case {
    const char* solution;
    const char* truth;
    int num_views;
    double mean_mm;
  };
  for (const Case& expected :
       {Case{"fountain-P11/global/sfm_data_poses.json", "fountain-P11", 11,
             2.60},
        Case{"fountain-P11/global/sfm_data.bin", "fountain-P11", 11, 2.60},
        Case{"Herz-Jesus-P8/global/sfm_data.bin", "Herz-Jesus-P8", 8, 3.59},
        Case{"castle-P19/global/sfm_data.bin", "castle-P19", 19, 29.83},
        Case{"castle-P19_without_3_9_14/global_poses.json", "castle-P19", 16,
             812.06}}) {
    SCOPED_TRACE(expected.solution);
    const Scene scene = Read(std::string("openmvg/") + expected.solution);
    const auto by_name = strecha::ReadGroundTruth(
        Path(std::string("strecha/") + expected.truth));
    ASSERT_TRUE(by_name.has_value()) << by_name.error().ToString();
    const Result<GroundTruth> truth = GroundTruthByName(scene, *by_name);
    ASSERT_TRUE(truth.has_value()) << truth.error().ToString();
    const PoseEvaluation evaluation = EvaluatePoses(scene, *truth);
    EXPECT_EQ(evaluation.scope, EvaluationScope::kFull);
    EXPECT_EQ(evaluation.num_total, expected.num_views);
    EXPECT_EQ(evaluation.num_solved, expected.num_views);
    EXPECT_NEAR(1000 * evaluation.position.mean, expected.mean_mm, 0.005);
    std::cout << expected.solution << ": position mean "
              << 1000 * evaluation.position.mean << " mm, rotation mean "
              << evaluation.rotation_deg.mean << " deg, frame "
              << evaluation.frame_disagreement_deg << " deg\n";
  }
}

TEST_F(OpenMvgData, TheThreeFormsOfOneSolutionAreOneScene) {
  const Scene bin = Read("openmvg/Herz-Jesus-P8/global/sfm_data.bin");
  EXPECT_EQ(bin.views.size(), 8u);
  EXPECT_EQ(bin.poses.size(), 8u);
  EXPECT_EQ(bin.structure.size(), 12766u);
  EXPECT_TRUE(bin == Read("openmvg/Herz-Jesus-P8/global/sfm_data_all.json"));
  EXPECT_TRUE(bin == Read("openmvg/Herz-Jesus-P8/global/sfm_data_all.xml"));

  const TemporaryFolder folder;
  for (const char* name : {"a.bin", "a.xml", "a.json", "a.lowlap"}) {
    const auto notes = WriteScene(bin, folder.Path(name));
    ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
    EXPECT_TRUE(notes->empty());
    EXPECT_TRUE(*ReadScene(folder.Path(name)) == bin) << name;
  }
  // All sizes are those of OpenMVG's file: only the order differs.
  EXPECT_EQ(std::filesystem::file_size(folder.Path("a.bin")),
            std::filesystem::file_size(
                Path("openmvg/Herz-Jesus-P8/global/sfm_data.bin")));
  EXPECT_EQ(std::filesystem::file_size(folder.Path("a.xml")),
            std::filesystem::file_size(
                Path("openmvg/Herz-Jesus-P8/global/sfm_data_all.xml")));
}

TEST_F(OpenMvgData, ProjectsAreImported) {
  const auto project =
      openmvg::ImportProject(Path("openmvg/fountain-P11/matches/sfm_data.json"),
                             Path("openmvg/fountain-P11/matches"));
  ASSERT_TRUE(project.has_value()) << project.error().ToString();
  EXPECT_EQ(project->scene.views.size(), 11u);
  EXPECT_EQ(project->scene.features.at(0).points_px.size(), 25200u);
  EXPECT_EQ(project->scene.features.at(0).points_px[0],
            Vec2(1681.75, 0.390289));
  EXPECT_EQ(project->matches.size(), 45u);
  EXPECT_EQ(project->num_dropped_pairs, 0);
  EXPECT_EQ(std::filesystem::path(project->match_file).filename(),
            "matches.e.bin");

  const auto subset = openmvg::ImportProject(
      Path("openmvg/castle-P19_without_3_9_14/sfm_data.json"),
      Path("openmvg/castle-P19/matches"));
  ASSERT_TRUE(subset.has_value()) << subset.error().ToString();
  EXPECT_EQ(subset->scene.views.size(), 16u);
  EXPECT_GT(subset->num_dropped_pairs, 0);
  for (const auto& [pair, matches] : subset->matches) {
    for (const ViewId view : {pair.first, pair.second}) {
      EXPECT_TRUE(view != 3 && view != 9 && view != 14);
    }
  }
}

}  // namespace
}  // namespace lowlap
