#include "lowlap/averaging/reliability/internal/imprecise_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Solved {
  Scene scene;
  PoseSummary summary;
};

// Five views on a line of length 10, each known to `stddev` along z and to a
// tenth of it across.
Solved FiveInALine(double stddev) {
  Solved solved;
  solved.summary.components.resize(1);
  for (std::uint32_t n = 0; n < 5; ++n) {
    solved.scene.views[n].pose_id = n;
    Pose& pose = solved.scene.poses[n];
    pose.center = {2.5 * n, 0, 0};
    pose.center_covariance =
        Vec3(stddev / 10, stddev / 10, stddev).cwiseAbs2().asDiagonal();
    solved.summary.components[0].push_back(n);
  }
  return solved;
}

void Widen(PoseId pose, double factor, Scene* scene) {
  *scene->poses.at(pose).center_covariance *= factor * factor;
}

// A twentieth of 10 is 0.5, which the 95 % region of 0.1789 reaches.
TEST(ImpreciseViews, AreThoseWhoseRegionReachesATwentiethOfTheScene) {
  Solved solved = FiveInALine(0.178);
  EXPECT_THAT(FindImpreciseViews(solved.scene, solved.summary), IsEmpty());
  Widen(3, 2, &solved.scene);
  const auto warnings = FindImpreciseViews(solved.scene, solved.summary);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kImprecise);
  EXPECT_THAT(warnings[0].views, ElementsAre(3));
  EXPECT_NEAR(warnings[0].share, 2 * 0.178 / 10, 1e-12);
  solved = FiveInALine(0.18);
  EXPECT_EQ(FindImpreciseViews(solved.scene, solved.summary).size(), 5u);
}

TEST(ImpreciseViews, DoNotDependOnTheUnitOfTheWorld) {
  Solved solved = FiveInALine(0.18);
  for (auto& [id, pose] : solved.scene.poses) {
    pose.center *= 1e-3;
    *pose.center_covariance *= 1e-6;
  }
  EXPECT_EQ(FindImpreciseViews(solved.scene, solved.summary).size(), 5u);
}

// A view that is doubted anyway is neither named again, nor does its place
// make the scene larger.
TEST(ImpreciseViews, LeaveOutWhatIsDoubtedForAnotherReason) {
  Solved solved = FiveInALine(0.1);
  solved.scene.poses.at(4).center = {1000, 0, 0};
  ReliabilityWarning lost;
  lost.reason = WarningReason::kLostFeatures;
  lost.views = {4};
  solved.summary.reliability_warnings = {lost};
  // The others stretch over 7.5: a twentieth is 0.375.
  EXPECT_THAT(FindImpreciseViews(solved.scene, solved.summary), IsEmpty());
  Widen(0, 1.4, &solved.scene);
  Widen(4, 100, &solved.scene);
  const auto warnings = FindImpreciseViews(solved.scene, solved.summary);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].views, ElementsAre(0));
}

TEST(ImpreciseViews, NoneWithoutDeviationsOrASizeThatIsMeasured) {
  Solved solved = FiveInALine(10);
  for (auto& [id, pose] : solved.scene.poses) pose.center_covariance.reset();
  EXPECT_THAT(FindImpreciseViews(solved.scene, solved.summary), IsEmpty());
  solved = FiveInALine(10);
  solved.summary.components[0].resize(2);
  EXPECT_THAT(FindImpreciseViews(solved.scene, solved.summary), IsEmpty());
}

}  // namespace
}  // namespace lowlap
