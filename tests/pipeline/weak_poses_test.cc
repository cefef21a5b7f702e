#include "lowlap/pipeline/internal/measure/weak_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;

PairEstimate Pose(const ViewPair& views, double log10_nfa,
                  double turn_deg = 0) {
  PairEstimate estimate;
  estimate.pose.emplace();
  estimate.pose->views = views;
  estimate.pose->log10_nfa = log10_nfa;
  estimate.pose->rotation =
      RotationFromAngleAxis(RadFromDeg(turn_deg) * Vec3::UnitY());
  return estimate;
}

// Whether the weak pose of views 0 and 3 is kept beside 0-1-2-3, whose weakest
// link has a log10 NFA of -40, and beside a shorter path that has less.
bool IsKept(double log10_nfa, double turn_deg) {
  std::vector<PairEstimate> estimates = {Pose({0, 3}, log10_nfa, turn_deg),
                                         Pose({0, 1}, -90, 10),
                                         Pose({1, 2}, -40, 10),
                                         Pose({2, 3}, -80, 10),
                                         Pose({0, 4}, -3, 90),
                                         Pose({3, 4}, -70, 0)};
  estimates.front().pose->weakness = PoseWeakness::kRepeats;
  DropWeakPoses(&estimates);
  for (std::size_t n = 1; n < estimates.size(); ++n) {
    EXPECT_TRUE(estimates[n].pose);
  }
  const bool is_kept = estimates.front().pose.has_value();
  EXPECT_EQ(is_kept, estimates.front().reason.empty());
  return is_kept;
}

TEST(DropWeakPoses, KeepsThoseOfMoreEvidenceThanThePathOfOthers) {
  EXPECT_TRUE(IsKept(-41, 30));
  EXPECT_TRUE(IsKept(-41, 120));
  EXPECT_FALSE(IsKept(-39, 120));
}

TEST(DropWeakPoses, KeepsThoseOfHalfAsMuchThatAgreeWithThePath) {
  EXPECT_TRUE(IsKept(-21, 30));
  EXPECT_TRUE(IsKept(-21, 34));
  EXPECT_FALSE(IsKept(-21, 36));
  EXPECT_FALSE(IsKept(-19, 30));
}

TEST(DropWeakPoses, KeepsThoseThatNothingElseJoins) {
  std::vector<PairEstimate> estimates = {Pose({0, 1}, -90), Pose({2, 3}, -90),
                                         Pose({1, 2}, -1, 50),
                                         Pose({0, 3}, -2)};
  // They do not join views for each other.
  estimates[2].pose->weakness = PoseWeakness::kSurroundings;
  estimates[3].pose->weakness = PoseWeakness::kMatchesSideBySide;
  DropWeakPoses(&estimates);
  EXPECT_TRUE(estimates[2].pose);
  EXPECT_TRUE(estimates[3].pose);
}

TEST(DropWeakPoses, SaysWhy) {
  std::vector<PairEstimate> estimates = {Pose({0, 1}, -90), Pose({1, 2}, -90),
                                         Pose({0, 2}, -2, 50)};
  estimates[2].pose->weakness = PoseWeakness::kMatchesSideBySide;
  DropWeakPoses(&estimates);
  ASSERT_FALSE(estimates[2].pose);
  EXPECT_THAT(estimates[2].reason, HasSubstr("side by side"));
  EXPECT_THAT(estimates[2].reason, HasSubstr("other relative poses join"));
}

}  // namespace
}  // namespace lowlap
