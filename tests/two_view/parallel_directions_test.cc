#include "lowlap/two_view/internal/parallel_directions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "two_view/line_scene.h"

namespace lowlap {
namespace {

using testing::LineScene;
using testing::LineSceneOptions;
using testing::MakeLineScene;

std::vector<DirectionPair> PairsOf(const LineScene& scene) {
  const auto& views = scene.views;
  return PairDirections(views.features1, views.features2,
                        FindVanishingDirections(views.features1, {}),
                        FindVanishingDirections(views.features2, {}),
                        scene.line_matches);
}

// Pairs that all twelve lines of a family vote for; they agree with the truth.
int NumWholeFamilies(const std::vector<DirectionPair>& pairs,
                     const LineScene& scene) {
  int num_whole = 0;
  for (const DirectionPair& pair : pairs) {
    if (pair.num_matches != 12) continue;
    ++num_whole;
    EXPECT_LT(DirectionResidual(pair, scene.cam2_from_cam1.rotation).norm(),
              1e-3);
  }
  return num_whole;
}

TEST(PairDirections, ConnectsWhatTheMatchesConnect) {
  const auto scene = MakeLineScene({}, 1);
  const auto pairs = PairsOf(scene);
  // Each family as its matched lines and as all of its lines.
  EXPECT_EQ(NumWholeFamilies(pairs, scene), 6);
}

TEST(PairDirections, NeedsTwoVotes) {
  auto scene = MakeLineScene({}, 1);
  scene.line_matches.resize(1);
  EXPECT_TRUE(PairsOf(scene).empty());
}

// Lines matched along one part of a direction that is not quite parallel to the
// rest: what all lines of it say is another direction.
TEST(PairDirections, LeavesOutAllLinesWhereTheMatchedOnesDiffer) {
  const auto scene = MakeLineScene({}, 1);
  auto directions1 = FindVanishingDirections(scene.views.features1, {});
  const auto directions2 = FindVanishingDirections(scene.views.features2, {});
  const Mat3 turn = RotationFromAngleAxis(Vec3::Constant(RadFromDeg(3)));
  for (VanishingDirection& direction : directions1) {
    direction.direction = turn * direction.direction;
  }
  const auto pairs =
      PairDirections(scene.views.features1, scene.views.features2, directions1,
                     directions2, scene.line_matches);
  EXPECT_EQ(NumWholeFamilies(pairs, scene), 3);
}

TEST(PossibleDirections, AreThoseThatNoMatchConnects) {
  auto scene = MakeLineScene({}, 1);
  const auto directions1 = FindVanishingDirections(scene.views.features1, {});
  const auto directions2 = FindVanishingDirections(scene.views.features2, {});
  ASSERT_EQ(directions1.size(), 3u);
  EXPECT_TRUE(
      PossibleDirections(directions1, directions2, PairsOf(scene)).empty());
  scene.line_matches.clear();
  const auto possible = PossibleDirections(directions1, directions2, {});
  EXPECT_EQ(possible.size(), 9u);
  int num_right = 0;
  for (const DirectionPair& pair : possible) {
    EXPECT_EQ(pair.num_matches, 0);
    // Each is known to a fraction of a degree; there are nine to choose from.
    EXPECT_GT(pair.agreement_digits, 0.5);
    EXPECT_LT(pair.agreement_digits, 2);
    num_right +=
        DirectionResidual(pair, scene.cam2_from_cam1.rotation).norm() < 1;
  }
  EXPECT_EQ(num_right, 3);
  // The truth has only the wrong ones against it, another rotation the right
  // ones, too.
  double wrong = 0;
  for (const DirectionPair& pair : possible) {
    if (DirectionResidual(pair, scene.cam2_from_cam1.rotation).norm() > 1) {
      wrong += pair.agreement_digits;
    }
  }
  EXPECT_NEAR(DirectionPenalty(possible, scene.cam2_from_cam1.rotation), wrong,
              0.1);
  const Mat3 other = RotationFromAngleAxis(Vec3::Constant(RadFromDeg(5))) *
                     scene.cam2_from_cam1.rotation;
  EXPECT_GT(DirectionPenalty(possible, other), wrong + 1.5);
}

// A direction that is known poorly agrees with another by chance.
TEST(PossibleDirections, SayNothingWhereTheyAreVague) {
  VanishingDirection direction;
  direction.covariance = Vec3(1, 1, 0).asDiagonal();
  EXPECT_TRUE(PossibleDirections({direction}, {direction}, {}).empty());
}

TEST(DirectionResidual, HasTheDerivativeOfFiniteDifferences) {
  // With round covariances the weights do not turn with the rotation.
  DirectionPair pair;
  pair.covariance1 = pair.covariance2 = 1e-4 * Mat3::Identity();
  for (const double sign : {1.0, -1.0}) {
    pair.direction1 = Vec3(0.3, -0.2, 1).normalized();
    pair.direction2 = sign * Vec3(0.25, -0.1, 1).normalized();
    const Mat3 rotation = RotationFromAngleAxis(Vec3(0.02, -0.01, 0.3));
    Eigen::Matrix<double, 2, 3> jacobian;
    DirectionResidual(pair, rotation, &jacobian);
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      const auto at = [&](double step) {
        return DirectionResidual(
            pair, RotationFromAngleAxis(step * Vec3::Unit(k)) * rotation);
      };
      const Vec2 slope = (at(h) - at(-h)) / (2 * h);
      EXPECT_LT((jacobian.col(k) - slope).norm(), 1e-4);
    }
  }
}

TEST(RotationsFromDirections, ContainTheTruth) {
  for (int seed = 0; seed < 10; ++seed) {
    LineSceneOptions options;
    options.noise_px = 0.3;
    const auto scene = MakeLineScene(options, 50 + seed);
    double nearest = 180;
    for (const Mat3& rotation : RotationsFromDirections(PairsOf(scene))) {
      nearest = std::min(nearest, testing::RotationErrorDeg(
                                      rotation, scene.cam2_from_cam1.rotation));
    }
    EXPECT_LT(nearest, 0.5) << "seed " << seed;
  }
}

TEST(RotationsFromDirections, NeedTwoDirections) {
  const auto scene = MakeLineScene({}, 3);
  auto pairs = PairsOf(scene);
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const DirectionPair& p) {
                               return std::abs(p.direction1.dot(
                                          scene.directions[0])) < 0.99;
                             }),
              pairs.end());
  ASSERT_FALSE(pairs.empty());
  EXPECT_TRUE(RotationsFromDirections(pairs).empty());
}

TEST(DirectionPenalty, IsCappedByTheMatches) {
  DirectionPair pair;
  pair.covariance1 = pair.covariance2 = 1e-6 * Mat3::Identity();
  pair.num_matches = 4;
  EXPECT_NEAR(DirectionPenalty({pair}, Mat3::Identity()), 0, 1e-12);
  const Mat3 quarter = RotationFromAngleAxis(Vec3(1, 0, 0));
  EXPECT_NEAR(DirectionPenalty({pair}, quarter), 4, 1e-12);
  pair.num_matches = 100;
  EXPECT_NEAR(DirectionPenalty({pair}, quarter), 10, 1e-12);
}

// From eight votes on a family comes twice, as its matched lines and as all of
// its lines; its matches have no more to say for that.
TEST(DirectionPenalty, CountsTheMatchesOfAFamilyOnce) {
  const auto scene = MakeLineScene({}, 1);
  const auto pairs = PairsOf(scene);
  ASSERT_EQ(NumWholeFamilies(pairs, scene), 6);
  const Mat3 wrong = RotationFromAngleAxis(Vec3::Constant(RadFromDeg(20))) *
                     scene.cam2_from_cam1.rotation;
  EXPECT_DOUBLE_EQ(DirectionPenalty(pairs, wrong), 3 * 10);
}

}  // namespace
}  // namespace lowlap
