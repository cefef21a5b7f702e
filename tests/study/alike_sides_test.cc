#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/averaging/reliability/internal/look_alikes.h"
#include "lowlap/pipeline/internal/decisions/decide_by_structure.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/study/internal/trust/scenes.h"
#include "lowlap/study/internal/trust/trial.h"

namespace lowlap {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

RunContext Seeded(std::uint64_t seed) {
  RunContext context;
  context.seed = seed;
  context.num_threads = 1;
  return context;
}

TEST(AlikeSides, AHouseIsNotFolded) {
  // All views see a side that has its copy; no view is missing.
  constexpr std::uint64_t kSeed = 108;
  const TrustScene drawn = DrawTrustScene(TrustFamily::kAlikeSides, kSeed);
  ASSERT_GT(drawn.options.alike_share, 0);
  ASSERT_TRUE(drawn.left_out.empty());
  const auto trial =
      RunTrustTrial(TrustFamily::kAlikeSides, kSeed, Seeded(kSeed));
  ASSERT_TRUE(trial);
  EXPECT_EQ(static_cast<int>(trial->views.size()), drawn.options.num_views);
  for (const JudgedView& judged : trial->views) {
    EXPECT_LT(judged.error, 0.01) << judged.view;
    EXPECT_TRUE(judged.IsFirm()) << judged.view;
  }

  auto made = MakeTrustScene(drawn, Seeded(kSeed));
  ASSERT_TRUE(made);
  const Scene measured = made->scene;
  const auto result =
      SolveScene(&made->scene, SolveOptions(), Seeded(kSeed), nullptr);
  ASSERT_TRUE(result);
  EXPECT_THAT(result->poses.outlier_edges,
              Contains(Field(&OutlierEdge::reason, OutlierReason::kLookAlike)));
  EXPECT_TRUE(result->poses.look_alikes->false_poses.empty());
  // What was left out is still there.
  EXPECT_EQ(made->scene.relative_poses.size(), measured.relative_poses.size());
  EXPECT_EQ(made->scene.unrelated_pairs, measured.unrelated_pairs);
  EXPECT_EQ(made->scene.point_tracks, measured.point_tracks);
  EXPECT_EQ(made->scene.line_tracks, measured.line_tracks);
}

// Without the look-alikes found first, others hold one camera on the wrong side
// still; they differ in few regions.
TEST(AlikeSides, WhereSomeAreFoundOthersAreLookedFor) {
  constexpr std::uint64_t kSeed = 119;
  const auto trial =
      RunTrustTrial(TrustFamily::kAlikeSides, kSeed, Seeded(kSeed));
  ASSERT_TRUE(trial);
  for (const JudgedView& judged : trial->views) {
    EXPECT_LT(judged.error, 0.01) << judged.view;
    EXPECT_TRUE(judged.IsFirm()) << judged.view;
  }
}

TEST(AlikeSides, ASolutionThatIsNoBetterLeavesTheFirst) {
  constexpr std::uint64_t kSeed = 103;
  const auto made = MakeTrustScene(
      DrawTrustScene(TrustFamily::kAlikeSides, kSeed), Seeded(kSeed));
  ASSERT_TRUE(made);
  RunContext context = Seeded(kSeed);
  std::vector<std::string> messages;
  context.log = [&](LogLevel, const std::string& message) {
    messages.push_back(message);
  };
  Scene solved = made->scene;
  const auto result = SolveScene(&solved, SolveOptions(), context, nullptr);
  ASSERT_TRUE(result);
  ASSERT_THAT(messages, Contains(StartsWith("no better without")));

  Scene first = made->scene;
  auto composed =
      ComposeSolution(&first, SolveOptions(), Seeded(kSeed), nullptr);
  ASSERT_TRUE(composed);
  SolveResult expected;
  expected.motions = composed->start.motions;
  expected.ratios = composed->ratios;
  expected.poses = composed->poses;
  ASSERT_TRUE(DecideHypothesesByStructure(composed->start.rotations,
                                          SolveOptions(), Seeded(kSeed),
                                          nullptr, &first, &expected));
  ASSERT_TRUE(FinishSolution(&first, SolveOptions(), Seeded(kSeed), nullptr,
                             &expected));
  EXPECT_EQ(solved, first);
  EXPECT_EQ(result->poses.unplaced, expected.poses.unplaced);
  const LookAlikes& found = *result->poses.look_alikes;
  EXPECT_FALSE(found.false_poses.empty());
  EXPECT_THAT(
      result->poses.reliability_warnings,
      Contains(
          AllOf(Field(&ReliabilityWarning::reason, WarningReason::kLookAlikes),
                Field(&ReliabilityWarning::views, found.doubtful),
                Field(&ReliabilityWarning::missing, found.different))));
}

// Between sections 0 to 3 and 4 on; what contradicts that says that some of the
// relative poses between them are of another section.
TEST(AlikeSections, ACorridorIsNotFolded) {
  constexpr std::uint64_t kSeed = 103;
  const TrustScene drawn = DrawTrustScene(TrustFamily::kAlikeSections, kSeed);
  ASSERT_GT(drawn.options.alike_share, 0.5);
  EXPECT_THAT(drawn.Labels(), Contains("alike sections"));
  const auto trial =
      RunTrustTrial(TrustFamily::kAlikeSections, kSeed, Seeded(kSeed));
  ASSERT_TRUE(trial);
  for (const JudgedView& judged : trial->views) {
    EXPECT_TRUE(judged.IsPlaced()) << judged.view;
    EXPECT_LT(judged.error, 0.01) << judged.view;
  }
}

// Nine tenths of it are alike: as good as all.
TEST(AlikeSections, WhatCannotBeToldIsDoubtful) {
  constexpr std::uint64_t kSeed = 108;
  ASSERT_GT(
      DrawTrustScene(TrustFamily::kAlikeSections, kSeed).options.alike_share,
      0.8);
  const auto trial =
      RunTrustTrial(TrustFamily::kAlikeSections, kSeed, Seeded(kSeed));
  ASSERT_TRUE(trial);
  int num_wrong = 0;
  for (const JudgedView& judged : trial->views) {
    if (judged.error < 0.05) continue;
    ++num_wrong;
    EXPECT_FALSE(judged.IsFirm()) << judged.view;
  }
  EXPECT_GT(num_wrong, 0);
}

// Half as much is found of another session as of one's own.
TEST(TwoSessions, AreOnePlace) {
  constexpr std::uint64_t kSeed = 310;
  const TrustScene drawn = DrawTrustScene(TrustFamily::kTwoSessions, kSeed);
  EXPECT_THAT(drawn.likeness.second_session, Not(IsEmpty()));
  EXPECT_THAT(drawn.Labels(), Contains("two sessions"));
  const auto trial =
      RunTrustTrial(TrustFamily::kTwoSessions, kSeed, Seeded(kSeed));
  ASSERT_TRUE(trial);
  for (const JudgedView& judged : trial->views) {
    EXPECT_TRUE(judged.IsFirm()) << judged.view;
    EXPECT_LT(judged.error, 0.01) << judged.view;
  }
}

TEST(AlikeSides, ViewsThatAreLeftOutAreNotJudged) {
  std::uint64_t seed = 0;
  while (DrawTrustScene(TrustFamily::kAlikeSides, seed).left_out.empty()) {
    ++seed;
  }
  const TrustScene drawn = DrawTrustScene(TrustFamily::kAlikeSides, seed);
  const auto trial =
      RunTrustTrial(TrustFamily::kAlikeSides, seed, Seeded(seed));
  ASSERT_TRUE(trial);
  for (const JudgedView& judged : trial->views) {
    EXPECT_EQ(
        std::count(drawn.left_out.begin(), drawn.left_out.end(), judged.view),
        0);
  }
  EXPECT_LT(static_cast<int>(trial->views.size()), drawn.options.num_views);
}

}  // namespace
}  // namespace lowlap
