#include "lowlap/two_view/internal/evidence/repeat_evidence.h"

#include <gtest/gtest.h>

#include "support/matchers.h"
#include "tests/two_view/tiled_pair.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::IsError;
using testing::IsOk;
using testing::kInPattern;
using testing::RotationErrorDeg;
using testing::TiledPair;

std::optional<EvidenceBeyondRepeats> Evidence(const TwoViewInput& input,
                                              const RelativePose& pose) {
  Random random(3);
  return FindEvidenceBeyondRepeats(input, ShuffleMatches(input, random), pose,
                                   {});
}

TEST(EvidenceBeyondRepeats, IsWhatTheOtherMatchesSay) {
  const TiledPair pair(60);
  const auto evidence = Evidence(pair.Input(), pair.TruePose());
  ASSERT_TRUE(evidence);
  EXPECT_GT(evidence->num_repeated, kInPattern / 2);
  EXPECT_GT(evidence->num_others, 30);
  EXPECT_EQ(evidence->num_repeated + evidence->num_others,
            static_cast<int>(pair.matches.size()));
  EXPECT_LT(evidence->log10_nfa, -20);
  // Of another motion they say nothing.
  RelativePose wrong = pair.TruePose();
  wrong.rotation = RotationFromAngleAxis({0, 0.3, 0.2}) * wrong.rotation;
  EXPECT_GT(Evidence(pair.Input(), wrong)->log10_nfa, 0);
}

TEST(EvidenceBeyondRepeats, IsNoneOfAPatternAlone) {
  const TiledPair pair(0);
  TwoViewInput input = pair.Input();
  // The copies that were found: any number of them.
  std::vector<FeatureMatch> found;
  for (const FeatureMatch& match : input.point_matches) {
    if (pair.repeats1.HasPoint(match.first)) found.push_back(match);
  }
  ASSERT_GT(found.size(), 50u);
  input.point_matches = found;
  const auto evidence = Evidence(input, pair.TruePose());
  ASSERT_TRUE(evidence);
  EXPECT_EQ(evidence->num_others, 0);
  EXPECT_TRUE(std::isinf(evidence->log10_nfa));
  EXPECT_THAT(EstimateRelativePose(input, {}, 1),
              IsError(ErrorCode::kInsufficientData, "repeats"));
  // Without what is known of the patterns the same matches are a pose.
  input.repeats1 = input.repeats2 = nullptr;
  const auto pose = EstimateRelativePose(input, {}, 1);
  ASSERT_TRUE(pose);
  EXPECT_LT(pose->pose.log10_nfa, -20);
}

TEST(EvidenceBeyondRepeats, IsNotAskedForWhereNoMatchRepeats) {
  const TiledPair pair(60);
  TwoViewInput input = pair.Input();
  const RepeatedPattern nothing;
  input.repeats1 = input.repeats2 = &nothing;
  EXPECT_FALSE(Evidence(input, pair.TruePose()));
  input.repeats1 = nullptr;
  EXPECT_FALSE(Evidence(input, pair.TruePose()));
}

// Each tile with its neighbour: they agree on a motion, too, and are more.
TEST(EstimateRelativePose, HearsWhatDoesNotRepeat) {
  constexpr int kOthers = 100;
  const TiledPair pair(kOthers);
  TwoViewInput input = pair.Input();
  input.point_matches = testing::MatchesOfNeighbours(kOthers);
  const RigidTransform truth = pair.cam2_from_cam1;
  const auto heard = EstimateRelativePose(input, {}, 1);
  ASSERT_THAT(heard, IsOk());
  EXPECT_LT(RotationErrorDeg(heard->pose.rotation, truth.rotation), 0.2);
  EXPECT_LT(
      DirectionErrorDeg(heard->pose.direction, truth.translation.normalized()),
      1);
  EXPECT_LT(heard->log10_nfa_with_repeats, 2 * heard->pose.log10_nfa);

  input.repeats1 = input.repeats2 = nullptr;
  const auto deceived = EstimateRelativePose(input, {}, 1);
  ASSERT_THAT(deceived, IsOk());
  EXPECT_GT(DirectionErrorDeg(deceived->pose.direction,
                              truth.translation.normalized()),
            5);
}

// A wall alone has two motions: neither counts for its pattern.
TEST(EstimateRelativePose, CountsWhatRepeatsForNoneOfItsMotions) {
  // Towards the slanted wall, with points of it that do not repeat.
  const TiledPair pair(
      60, {RotationFromAngleAxis({0.1, -0.1, 0}), Vec3(0, 0.3, -1)}, 5);
  TwoViewInput input = pair.Input();
  const auto discounted = EstimateRelativePose(input, {}, 1);
  ASSERT_THAT(discounted, IsOk());
  input.repeats1 = input.repeats2 = nullptr;
  const auto plain = EstimateRelativePose(input, {}, 1);
  ASSERT_THAT(plain, IsOk());
  ASSERT_EQ(plain->geometry, TwoViewGeometry::kAmbiguousPlane);
  ASSERT_EQ(discounted->alternatives.size(), 1u);
  EXPECT_GT(discounted->pose.log10_nfa, 0.7 * plain->pose.log10_nfa);
  EXPECT_LT(discounted->pose.log10_nfa, 0);
  EXPECT_GT(discounted->alternatives[0].log10_nfa,
            0.7 * plain->alternatives[0].log10_nfa);
  EXPECT_LT(discounted->alternatives[0].log10_nfa, 0);
}

}  // namespace
}  // namespace lowlap
