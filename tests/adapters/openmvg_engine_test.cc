// The translation step inside OpenMVG gives what the files give.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <unordered_map>

#include "adapters/openmvg_host.h"
#include "adapters/temporary_folder.h"
#include "cli/cli_fixture.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/data_folder.h"
#include "support/matchers.h"
#include "third_party_adapters/openmvg/engine/host_types.h"

namespace lowlap::openmvg {
namespace {

using Rotations = LowlapGlobalEngine::Rotations;
using lowlap::testing::IsError;
using lowlap::testing::IsOk;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Seven views of the bundled courtyard, as the files of an OpenMVG project.
class OpenMvgEngine : public ::testing::Test {
 protected:
  static std::string Number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%g", value);
    return text;
  }

  OpenMvgEngine() {
    constexpr std::uint32_t kViews = 7;
    Scene scene = *ReadScene(SourceFolder() +
                             "/sfm_data/samples/castle-p19/scene.lowlap");
    std::vector<ViewId> others;
    for (const auto& [id, view] : scene.views) {
      if (id.value() >= kViews) others.push_back(id);
    }
    scene = WithoutViews(scene, others);
    listing_ = folder_.Path("sfm_data.json");
    EXPECT_THAT(WriteScene(scene, listing_, "openmvg-json"), IsOk());
    for (const auto& [id, view] : scene.views) {
      std::string text;
      for (const Vec2& point : scene.features.at(id).points_px) {
        text += Number(point.x()) + " " + Number(point.y()) + " 1 0\n";
      }
      folder_.Write("matches/" + view.filename.substr(0, 4) + ".feat", text);
    }
    std::string text;
    for (const auto& [pair, pose] : scene.relative_poses) {
      text += std::to_string(pair.first.value()) + " " +
              std::to_string(pair.second.value()) + "\n" +
              std::to_string(pose.point_inliers.size()) + "\n";
      for (const FeatureMatch& match : pose.point_inliers) {
        text += std::to_string(match.first) + " " +
                std::to_string(match.second) + "\n";
      }
    }
    folder_.Write("matches/matches.e.txt", text);
    auto host = LoadHost(listing_, folder_.Path("matches"), "matches.e.txt");
    EXPECT_THAT(host, IsOk());
    if (host) host_ = std::move(*host);
  }

  std::map<PoseId, Pose> SolvedByCommand(const std::string& flags) const {
    const std::string out = folder_.Path("out");
    const Outcome outcome = Lowlap("solve -s GLOBAL -i " + listing_ + " -m " +
                                   folder_.Path("matches") +
                                   " -M matches.e.txt -o " + out + " " + flags);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    const auto scene = ReadScene(out + "/scene.lowlap");
    EXPECT_THAT(scene, IsOk());
    return scene ? PosesOfHost(scene->poses) : std::map<PoseId, Pose>();
  }

  TranslationStepInput Input() const {
    return FromHost(host_.scene, host_.features, host_.matches);
  }

  const TemporaryFolder folder_;
  std::string listing_;
  Host host_;
};

TEST_F(OpenMvgEngine, GivesThePosesOfTheFilesToTheByte) {
  const auto poses = PosesOfEngine(&host_, Rotations::kLowlap);
  EXPECT_EQ(poses.size(), 7u);
  EXPECT_EQ(poses, SolvedByCommand("--no-adjust"));

  TranslationStepOptions options;
  options.solve.adjust = true;
  const auto adjusted = PosesOfEngine(&host_, Rotations::kLowlap, options);
  EXPECT_EQ(adjusted, SolvedByCommand(""));
  EXPECT_NE(adjusted, poses);
}

// OpenMVG's tables are hash tables, too, if it is built so.
TEST_F(OpenMvgEngine, ReadsTablesInAnyOrder) {
  struct {
    std::unordered_map<openMVG::IndexT, std::shared_ptr<openMVG::sfm::View>>
        views;
    std::unordered_map<openMVG::IndexT,
                       std::shared_ptr<openMVG::cameras::IntrinsicBase>>
        intrinsics;
    std::string s_root_path;
  } scene;
  struct {
    std::unordered_map<openMVG::IndexT, openMVG::features::PointFeatures>
        feats_per_view;
  } features;
  scene.s_root_path = host_.scene.s_root_path;
  scene.views.insert(host_.scene.views.begin(), host_.scene.views.end());
  scene.intrinsics.insert(host_.scene.intrinsics.begin(),
                          host_.scene.intrinsics.end());
  features.feats_per_view.insert(host_.features.feats_per_view.begin(),
                                 host_.features.feats_per_view.end());
  const auto input = FromHost(scene, features, host_.matches);
  EXPECT_TRUE(input.scene == Input().scene);
  EXPECT_EQ(input.matches, Input().matches);
  EXPECT_EQ(input.scene.views.size(), 7u);
}

TEST_F(OpenMvgEngine, KeepsTheRotationsOfTheHostAndNamesWhatItCannotPlace) {
  const auto averaged = RunTranslationStep(Input());
  ASSERT_THAT(averaged, IsOk());
  EXPECT_THAT(averaged->unplaced, IsEmpty());
  // In a frame of the host's own.
  const Mat3 turn = RotationFromAngleAxis({0.1, -0.4, 0.2});
  openMVG::Hash_Map<openMVG::IndexT, openMVG::Mat3> rotations;
  for (const auto& [id, pose] : averaged->poses) {
    rotations[id.value()] = pose.rotation * turn;
  }
  rotations.erase(6);
  TranslationStepInput input = Input();
  AddRotations(rotations, &input);
  const auto kept = RunTranslationStep(std::move(input));
  ASSERT_THAT(kept, IsOk());
  ASSERT_EQ(kept->poses.size(), 6u);
  // The frame is turned, and view 6 has no part in the mean length.
  const double scale =
      kept->poses.at(5).center.norm() / averaged->poses.at(5).center.norm();
  for (const auto& [id, pose] : kept->poses) {
    EXPECT_EQ(pose.rotation, rotations.at(id.value()));
    const Vec3 expected =
        scale * turn.transpose() * averaged->poses.at(id).center;
    EXPECT_THAT(pose.center, lowlap::testing::VectorNear(expected, 0.02)) << id;
  }
  EXPECT_THAT(kept->unplaced, ElementsAre(ViewId(6)));
  EXPECT_THAT(kept->warnings, Contains(HasSubstr("0006.jpg")));
  for (const auto& [pair, matches] : kept->inliers) {
    EXPECT_NE(pair.second, ViewId(6));
    EXPECT_FALSE(matches.empty());
  }
}

// What cannot be adjusted is a result too, whoever found the rotations.
TEST_F(OpenMvgEngine, FinishesTheRotationsOfTheHostAsItsOwn) {
  TranslationStepInput input = Input();
  TranslationStepOptions options;
  options.use_photographs = false;
  const auto averaged = RunTranslationStep(input, options);
  ASSERT_THAT(averaged, IsOk());
  for (const auto& [id, pose] : averaged->poses) {
    input.rotations[id] = pose.rotation;
  }
  const auto composed = RunTranslationStep(input, options);
  ASSERT_THAT(composed, IsOk());
  options.solve.adjust = true;
  const auto adjusted = RunTranslationStep(input, options);
  ASSERT_THAT(adjusted, IsOk());
  EXPECT_NE(adjusted->poses, composed->poses);
  // There are no lines.
  options.solve.adjustment.use_points = false;
  const auto without_features = RunTranslationStep(input, options);
  ASSERT_THAT(without_features, IsOk());
  EXPECT_EQ(without_features->poses, composed->poses);
}

TEST_F(OpenMvgEngine, UsesThePairsOfTheRelativeRotationsAlone) {
  openMVG::rotation_averaging::RelativeRotations rotations;
  for (const auto& [pair, matches] : host_.matches.pairWise_matches_) {
    // The other way round, too.
    if (pair.second < 5) rotations.emplace_back(pair.second, pair.first);
  }
  TranslationStepInput input = Input();
  KeepPairsOf(rotations, &input);
  const auto result = RunTranslationStep(std::move(input));
  ASSERT_THAT(result, IsOk());
  EXPECT_THAT(result->unplaced, ElementsAre(ViewId(5), ViewId(6)));
}

TEST(OpenMvgEngineInput, TakesRelativePosesThatAreKnown) {
  SyntheticOptions options;
  options.num_views = 4;
  options.pairs = "chain";
  options.trifocal_point_share = 0.5;
  const SyntheticScene chain = *Simulate(options);
  TranslationStepInput input;
  input.scene.views = chain.scene.views;
  input.scene.intrinsics = chain.scene.intrinsics;
  for (const auto& [id, features] : chain.scene.features) {
    input.scene.features[id].points_px = features.points_px;
  }
  // Turned against what the matches say, so that it shows who is believed.
  const Mat3 turn = RotationFromAngleAxis({0, 1e-4, 0});
  openMVG::Hash_Map<openMVG::Pair, openMVG::geometry::Pose3> known;
  for (const auto& [pair, pose] : chain.scene.relative_poses) {
    input.matches[pair] = pose.point_inliers;
    RigidTransform transform{turn * pose.rotation, 3 * pose.direction};
    std::pair<openMVG::IndexT, openMVG::IndexT> ids{pair.first.value(),
                                                    pair.second.value()};
    if (ids.first == 1) {
      transform = transform.Inverse();
      std::swap(ids.first, ids.second);
    }
    known[ids] = {transform.rotation, transform.Center()};
  }
  AddRelativePoses(known, &input);
  ASSERT_EQ(input.relative_poses.size(), 3u);
  const auto result = RunTranslationStep(std::move(input));
  ASSERT_THAT(result, IsOk());
  ASSERT_EQ(result->poses.size(), 4u);
  for (const auto& [pair, pose] : chain.scene.relative_poses) {
    const Pose& first = result->poses.at(pair.first.value());
    const Pose& second = result->poses.at(pair.second.value());
    EXPECT_LT(RotationAngleBetween(second.rotation * first.rotation.transpose(),
                                   turn * pose.rotation),
              1e-6);
    EXPECT_LT(AngleBetween(second.rotation * (first.center - second.center),
                           pose.direction),
              1e-6);
    EXPECT_EQ(result->inliers.at(pair), pose.point_inliers);
  }
}

TEST_F(OpenMvgEngine, SaysWhatIsWrong) {
  const auto error = [](const TranslationStepInput& input) {
    return RunTranslationStep(input);
  };
  TranslationStepInput input = Input();
  input.matches.begin()->second.front().second = 1000000;
  EXPECT_THAT(error(input), IsError(ErrorCode::kInvalidScene,
                                    "pair 0-1: a feature does not exist"));
  input = Input();
  input.matches[{2, 9}] = {};
  EXPECT_THAT(error(input), IsError(ErrorCode::kInvalidScene, "pair 2-9"));
  input = Input();
  input.rotations[3] = 2 * Mat3::Identity();
  EXPECT_THAT(error(input),
              IsError(ErrorCode::kInvalidScene, "rotation of pose 3 is none"));
  input = Input();
  input.relative_poses[{0, 1}] = {};
  EXPECT_THAT(error(input),
              IsError(ErrorCode::kInvalidScene, "poses 0 and 1 has no"));
  input = Input();
  input.pairs.emplace();
  EXPECT_THAT(error(input), IsError(ErrorCode::kInsufficientData, ""));
  input = Input();
  input.scene.intrinsics.begin()->second.fx_px = -1;
  EXPECT_THAT(error(input), IsError(ErrorCode::kInvalidScene, ""));

  RunContext stopped;
  stopped.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  EXPECT_THAT(RunTranslationStep(Input(), {}, stopped),
              IsError(ErrorCode::kCancelled, ""));
}

TEST(OpenMvgEngineInput, KnowsTheCameraModelsByNumber) {
  struct Case {
    int number;
    const char* name;
  };
  for (const Case& model :
       {Case{1, "pinhole"}, Case{2, "pinhole_radial_k1"},
        Case{3, "pinhole_radial_k3"}, Case{4, "pinhole_brown_t2"},
        Case{5, "fisheye"}, Case{7, "spherical"}}) {
    const CameraModel expected = *CameraModelFromName(model.name);
    std::vector<double> parameters;
    if (expected != CameraModel::kSpherical) parameters = {900, 401, 299};
    for (int n = 0; n < DistortionCount(expected); ++n) {
      parameters.push_back(0.01 * (n + 1));
    }
    const auto intrinsic =
        IntrinsicFromHost(model.number, 800, 600, parameters);
    ASSERT_THAT(intrinsic, IsOk());
    EXPECT_EQ(intrinsic->model, expected);
    EXPECT_THAT(intrinsic->Validate(), IsOk());
    EXPECT_EQ(intrinsic->width_px, 800);
    if (expected == CameraModel::kSpherical) continue;
    EXPECT_EQ(intrinsic->fx_px, 900);
    EXPECT_EQ(intrinsic->fy_px, 900);
    EXPECT_EQ(intrinsic->principal_point_px, Vec2(401, 299));
    if (intrinsic->HasDistortion()) {
      EXPECT_EQ(intrinsic->distortion.front(), 0.01);
    }
    parameters.push_back(0);
    EXPECT_THAT(IntrinsicFromHost(model.number, 800, 600, parameters),
                IsError(ErrorCode::kInvalidScene, "parameters"));
  }
  EXPECT_THAT(IntrinsicFromHost(6, 800, 600, {}),
              IsError(ErrorCode::kUnsupported, "no camera model 6"));
}

// OpenMVG writes six digits, reads them into single precision, and both stand
// for one number.
TEST(OpenMvgEngineInput, FindsThePositionsOfTheFeatureFiles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> magnitude(-8, 5);
  for (int n = 0; n < 10000; ++n) {
    char text[32];
    std::snprintf(text, sizeof(text), "%g", std::exp2(4 * magnitude(random)));
    EXPECT_EQ(PositionFromHost(std::strtof(text, nullptr)),
              std::strtod(text, nullptr))
        << text;
  }
  EXPECT_EQ(PositionFromHost(-0.1f), -0.1);
}

TEST(OpenMvgEngineInput, TurnsPairsAndDropsThoseOfUnknownViews) {
  TranslationStepInput input;
  input.scene.views[2];
  input.scene.views[5];
  AddMatches(5, 2, {{7, 8}}, &input);
  AddMatches(2, 6, {{1, 1}}, &input);
  ASSERT_EQ(input.matches.size(), 1u);
  EXPECT_THAT(input.matches.at({2, 5}), ElementsAre(FeatureMatch{8, 7}));
  const View view = ViewFromHost("a/b/c.jpg", 1, 2, 30, 40);
  EXPECT_EQ(view.local_path, "a/b");
  EXPECT_EQ(view.filename, "c.jpg");
}

}  // namespace
}  // namespace lowlap::openmvg
