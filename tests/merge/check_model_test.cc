#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "geometry/random_geometry.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/geometry/internal/rotation.h"
#include "merge/parts.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Similarity SomeFrame() {
  Similarity frame;
  frame.scale = 3.7;
  frame.rotation = RotationFromAngleAxis(Vec3(0.3, -1.1, 0.8));
  frame.translation = Vec3(5, -2, 11);
  return frame;
}

ModelCheck Check(const SyntheticScene& made, const PartialModel& model) {
  const auto check =
      CheckModel(made.scene, model, SolveOptions(), RunContext());
  EXPECT_THAT(check, testing::IsOk());
  return check ? *check : ModelCheck();
}

class CheckModelTest : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  SyntheticScene made_ = NoisyChain(GetParam());
};

TEST_P(CheckModelTest, BearsOutAModelThatIsRight) {
  PartialModel model = PartOf(made_.true_poses, Range(0, 8));
  model.poses = Moved(model.poses, SomeFrame());
  const ModelCheck check = Check(made_, model);
  EXPECT_TRUE(check.IsWhole());
  EXPECT_THAT(DescribeCheck(model, check, made_.scene),
              ElementsAreArray({HasSubstr("bear out all of it")}));
}

// Every direction that does not cross the camera is right.
TEST_P(CheckModelTest, CutsWhereAPartHasAnotherScale) {
  const PartialModel model =
      Glued(PartOf(made_.true_poses, Range(0, 8)), 5, 1.6, Mat3::Identity());
  const ModelCheck check = Check(made_, model);
  ASSERT_THAT(check.pieces, SizeIs(2));
  EXPECT_THAT(check.pieces[0].views, ElementsAreArray(Range(0, 4)));
  EXPECT_THAT(check.pieces[1].views, ElementsAreArray(Range(4, 8)));
  EXPECT_THAT(check.unconfirmed, IsEmpty());
  EXPECT_THAT(DescribeCheck(model, check, made_.scene),
              Contains(AllOf(HasSubstr("which meet in 000004.png, are not one"),
                             HasSubstr("1.6"), HasSubstr("too large"))));
}

TEST_P(CheckModelTest, CutsWhereAPartIsTurned) {
  const PartialModel model =
      Glued(PartOf(made_.true_poses, Range(0, 8)), 5, 1,
            RotationFromAngleAxis(RadFromDeg(20) * Vec3::UnitY()));
  const ModelCheck check = Check(made_, model);
  ASSERT_THAT(check.pieces, SizeIs(2));
  EXPECT_THAT(check.pieces[0].views, ElementsAreArray(Range(0, 4)));
  EXPECT_THAT(check.pieces[1].views, ElementsAreArray(Range(5, 8)));
  EXPECT_THAT(DescribeCheck(model, check, made_.scene),
              Contains(AllOf(HasSubstr("are not one"),
                             HasSubstr("3 of 3 relative poses between them"))));
}

TEST_P(CheckModelTest, NamesACameraThatIsElsewhere) {
  PartialModel model = PartOf(made_.true_poses, Range(0, 8));
  model.poses.at(8).center += Vec3(1, 0.5, -1);
  const ModelCheck check = Check(made_, model);
  ASSERT_THAT(check.pieces, SizeIs(1));
  EXPECT_THAT(check.unconfirmed, ElementsAreArray(Range(8, 8)));
}

// All residuals are as large: that does not excuse any.
TEST_P(CheckModelTest, DoesNotBearOutWhatIsWrongThroughout) {
  const PartialModel right = PartOf(made_.true_poses, Range(0, 8));
  PartialModel mirrored = right, transposed = right, turned = right;
  for (auto& entry : mirrored.poses) entry.second.center *= -1;
  for (auto& entry : transposed.poses) {
    entry.second.rotation.transposeInPlace();
  }
  Random random(GetParam());
  for (auto& entry : turned.poses) {
    const Vec3 axis = testing::RandomVector(random).normalized();
    entry.second.rotation =
        RotationFromAngleAxis(RadFromDeg(40) * axis) * entry.second.rotation;
  }
  for (const PartialModel& model : {mirrored, transposed, turned}) {
    const ModelCheck check = Check(made_, model);
    EXPECT_THAT(check.pieces, IsEmpty());
    EXPECT_LT(
        std::count_if(check.pairs.begin(), check.pairs.end(),
                      [](const PairAgreement& pair) { return pair.Agrees(); }),
        static_cast<std::ptrdiff_t>(check.pairs.size()) / 4);
  }
}

TEST_P(CheckModelTest, ACameraFarAwayTakesNothingFromTheOthers) {
  PartialModel model = PartOf(made_.true_poses, Range(0, 8));
  model.poses.at(8).center = Vec3(1e11, 0, 0);
  const ModelCheck check = Check(made_, model);
  ASSERT_THAT(check.pieces, SizeIs(1));
  EXPECT_THAT(check.unconfirmed, ElementsAreArray(Range(8, 8)));
}

INSTANTIATE_TEST_SUITE_P(Seeds, CheckModelTest, ::testing::Values(0, 1, 2));

// Nothing contradicts the model, but nothing that was measured has to do with
// the scale across view 4 either.
TEST(CheckModel, CutsWhereNothingTiesScales) {
  SyntheticScene made = NoisyChain(0);
  auto& pairs = made.scene.relative_poses;
  for (auto pair = pairs.begin(); pair != pairs.end();) {
    const bool across = pair->first.first < 4 && pair->first.second > 4;
    pair = across ? pairs.erase(pair) : std::next(pair);
  }
  made.scene.features.clear();
  for (auto& entry : pairs) {
    entry.second.point_inliers.clear();
    entry.second.line_inliers.clear();
  }
  const PartialModel model = PartOf(made.true_poses, Range(0, 8));
  const ModelCheck check = Check(made, model);
  for (const RigidPiece& piece : check.pieces) {
    EXPECT_TRUE(piece.views.back() <= 4 || piece.views.front() >= 4);
  }
  EXPECT_THAT(DescribeCheck(model, check, made.scene),
              Contains(HasSubstr("which meet in 000004.png, are not one: "
                                 "nothing that was measured ties")));
}

TEST(CheckModel, WithoutMeasurementsNothingIsBorneOut) {
  SyntheticScene made = NoisyChain(0);
  made.scene.relative_poses.clear();
  const ModelCheck check = Check(made, PartOf(made.true_poses, Range(0, 8)));
  EXPECT_THAT(check.pieces, IsEmpty());
  EXPECT_THAT(check.unconfirmed, SizeIs(9));
}

TEST(MatchModel, FindsViewsByImageName) {
  const SyntheticScene made = NoisyChain(0);
  Scene model;
  for (const std::uint32_t view : {2, 5}) {
    const std::uint32_t id = 70 - view;  // the model numbers them by itself
    model.views[id] = made.scene.views.at(view);
    model.views[id].local_path = "undistorted/images";
    model.views[id].pose_id = id;
    model.poses[id].center = Vec3(view, 0, 0);
  }
  model.views[90] = model.views.begin()->second;
  model.views[90].filename = "of another room.png";
  model.views[90].pose_id = 90;
  model.poses[90] = {};
  std::vector<std::string> warnings;
  RunContext context;
  context.log = [&](LogLevel, const std::string& text) {
    warnings.push_back(text);
  };
  const auto matched = MatchModel(made.scene, model, "model.json", context);
  ASSERT_THAT(matched, testing::IsOk());
  EXPECT_THAT(warnings, ElementsAre("model.json: 1 of its cameras are no "
                                    "images of the measured scene"));
  ASSERT_THAT(matched->poses, SizeIs(2));
  EXPECT_EQ(matched->poses.at(2).center.x(), 2);
  EXPECT_EQ(matched->poses.at(5).center.x(), 5);
  // Notes in a summary hold the name.
  const auto latin = MatchModel(made.scene, model, "mod\xe9le.json", {});
  ASSERT_THAT(latin, testing::IsOk());
  EXPECT_TRUE(IsUtf8(latin->name));
}

TEST(MatchModel, FoldersTellImagesOfOneNameApart) {
  Scene measured, model;
  const auto add = [](const char* folder, int number, Scene* scene) {
    const auto id = static_cast<std::uint32_t>(scene->views.size());
    View& view = scene->views[id];
    view.local_path = folder;
    view.filename = std::to_string(number) + ".png";
    return id;
  };
  for (int n = 0; n < 6; ++n) {
    add(n < 3 ? "left" : "right", n, &measured);
    const std::uint32_t id = add("left", n, &model);
    model.views.at(id).pose_id = id;
    model.poses[id].center.x() = n;
  }
  int num_warnings = 0;
  RunContext context;
  context.log = [&](LogLevel, const std::string&) { ++num_warnings; };
  const auto matched = MatchModel(measured, model, "model.json", context);
  ASSERT_THAT(matched, testing::IsOk());
  EXPECT_THAT(matched->poses, SizeIs(3));
  EXPECT_EQ(matched->poses.count(3), 0u);
  EXPECT_EQ(num_warnings, 1);
}

TEST(MatchModel, SaysWhatIsWrong) {
  const SyntheticScene made = NoisyChain(0);
  Scene model = made.scene;
  EXPECT_THAT(MatchModel(made.scene, model, "model.json", {}),
              testing::IsError(ErrorCode::kInsufficientData,
                               "model.json: holds no camera that is placed"));
  model.poses = TrueSolution(made).poses;
  for (auto& entry : model.views) entry.second.filename += ".other.png";
  EXPECT_THAT(MatchModel(made.scene, model, "model.json", {}),
              testing::IsError(ErrorCode::kInsufficientData,
                               "is an image of the measured scene"));
  // No folder is one of the measured scene, and the names alone do not tell.
  for (auto& [id, view] : model.views) {
    view.local_path = "camera" + std::to_string(id.value());
    view.filename = "one.png";
  }
  EXPECT_THAT(MatchModel(made.scene, model, "model.json", {}),
              testing::IsError(ErrorCode::kInvalidScene,
                               "model.json: two cameras are called 'one.png'"));
  for (auto& entry : model.views) entry.second.local_path.clear();
  EXPECT_THAT(MatchModel(made.scene, model, "model.json", {}),
              testing::IsError(ErrorCode::kInvalidScene, "one.png"));
  // As formats without names give it.
  for (auto& entry : model.views) entry.second.filename.clear();
  EXPECT_THAT(MatchModel(made.scene, model, "model.kitti", {}),
              testing::IsError(ErrorCode::kInvalidScene,
                               "model.kitti: its cameras have no file names"));
}

}  // namespace
}  // namespace lowlap
