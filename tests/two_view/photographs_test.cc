#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "tests/support/data_folder.h"
#include "tests/support/matchers.h"
#include "third_party_adapters/openmvg/internal/import.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

using testing::IsOk;

struct PairErrors {
  std::vector<double> rotation_deg;
  std::vector<double> direction_deg;
};

double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(
      values.size() - 1,
      static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// Poses of the pairs of neighbours from OpenMVG's putative matches, against
/// the ground truth.
PairErrors MeasureNeighbours(const std::string& data, const std::string& name) {
  PairErrors errors;
  const std::string matches_dir = data + "/openmvg/" + name + "/matches";
  openmvg::ImportOptions options;
  options.match_file = "matches.putative.bin";
  const auto project = openmvg::ImportProject(matches_dir + "/sfm_data.json",
                                              matches_dir, options);
  EXPECT_THAT(project, IsOk());
  const auto truth = strecha::ReadCameras(data + "/strecha/" + name);
  EXPECT_THAT(truth, IsOk());
  if (!project || !truth) return errors;
  const auto camera = [&](ViewId view) -> const strecha::Camera& {
    return truth->at(project->scene.views.at(view).filename);
  };
  for (const auto& [views, matches] : project->matches) {
    if (views.second != views.first.value() + 1) continue;
    // OpenMVG's listing has one focal length; the true cameras have two.
    const NormalizedFeatures features1 = NormalizeFeatures(
        project->scene.features.at(views.first), camera(views.first).intrinsic);
    const NormalizedFeatures features2 =
        NormalizeFeatures(project->scene.features.at(views.second),
                          camera(views.second).intrinsic);
    TwoViewInput input;
    input.views = views;
    input.features1 = &features1;
    input.features2 = &features2;
    input.point_matches = matches;
    input.image_size1_px = input.image_size2_px = Vec2(3072, 2048);
    const auto result = EstimateRelativePose(input, {}, views.first.value());
    EXPECT_THAT(result, IsOk());
    if (!result) continue;
    EXPECT_TRUE(result->HasDirection());
    const RigidTransform true_pose =
        camera(views.second).pose.CamFromWorld() *
        camera(views.first).pose.CamFromWorld().Inverse();
    errors.rotation_deg.push_back(DegFromRad(
        RotationAngleBetween(result->pose.rotation, true_pose.rotation)));
    errors.direction_deg.push_back(DegFromRad(
        AngleBetween(result->pose.direction, true_pose.translation)));
  }
  return errors;
}

struct Expectation {
  const char* name;
  std::size_t num_pairs;
  double median_rotation_deg, worst_rotation_deg;
  double median_direction_deg, worst_direction_deg;
};

class PhotographsTest : public ::testing::TestWithParam<Expectation> {};

/// The ground truth itself is good to a few hundredths of a degree.
TEST_P(PhotographsTest, NeighboursArePosedAsWellAsTheGroundTruthTells) {
  const std::string data = DataFolder();
  if (data.empty()) GTEST_SKIP() << "skipped: no data";
  const Expectation& expected = GetParam();
  const PairErrors errors = MeasureNeighbours(data, expected.name);
  ASSERT_EQ(errors.rotation_deg.size(), expected.num_pairs);
  std::printf(
      "%s: rotation median %.3f worst %.3f, direction median %.3f "
      "worst %.3f degrees\n",
      expected.name, Quantile(errors.rotation_deg, 0.5),
      Quantile(errors.rotation_deg, 1), Quantile(errors.direction_deg, 0.5),
      Quantile(errors.direction_deg, 1));
  EXPECT_LT(Quantile(errors.rotation_deg, 0.5), expected.median_rotation_deg);
  EXPECT_LT(Quantile(errors.rotation_deg, 1), expected.worst_rotation_deg);
  EXPECT_LT(Quantile(errors.direction_deg, 0.5), expected.median_direction_deg);
  EXPECT_LT(Quantile(errors.direction_deg, 1), expected.worst_direction_deg);
}

INSTANTIATE_TEST_SUITE_P(
    Strecha, PhotographsTest,
    ::testing::Values(Expectation{"fountain-P11", 10, 0.03, 0.06, 0.12, 0.2},
                      Expectation{"Herz-Jesus-P8", 7, 0.04, 0.06, 0.14, 0.25},
                      Expectation{"castle-P19", 18, 0.10, 0.25, 0.25, 0.7}),
    [](const auto& test) {
      std::string name = test.param.name;
      name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
      return name;
    });

}  // namespace
}  // namespace lowlap
