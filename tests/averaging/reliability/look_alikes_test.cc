#include "lowlap/averaging/reliability/internal/look_alikes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "averaging/reliability/cameras_in_a_row.h"
#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Truly;

LookAlikes Find(const Scene& scene, const PoseSummary& summary) {
  return FindLookAlikes(scene, summary,
                        PredictOverlaps(scene, RunContext()).value(),
                        RunContext())
      .value();
}

constexpr std::uint32_t kNumCameras = 8;

// Views from this one on belong elsewhere.
bool IsElsewhere(ViewId view, std::uint32_t first) {
  return view.value() >= first;
}

// Eight cameras one beside the other before a wall, each of which finds seven
// tenths of its points. Those from `first` on belong elsewhere: their wall
// looks the same as far as `alike` of its 20 columns, and relative poses with
// what is alike put it in the place of the other one.
Scene SceneOfTwoWalls(std::uint32_t first, std::uint32_t alike) {
  Scene scene = CamerasInARow(kNumCameras, 0.3);
  Random random(1);
  for (std::uint32_t n = 0; n < 800; ++n) {
    Landmark& landmark = scene.structure[n];
    landmark.position =
        Vec3(n % 20, (n % 400) / 20, 0) * 0.5 + Vec3(-4, -5, 10);
    for (std::uint32_t view = 0; view < kNumCameras; ++view) {
      const bool is_found = random.Uniform() < 0.7;
      const bool is_second_wall = n >= 400;
      const bool is_of_wall = n % 20 < alike
                                  ? !is_second_wall
                                  : IsElsewhere(view, first) == is_second_wall;
      if (is_found && is_of_wall) {
        landmark.observations.push_back({view, n, Vec2::Zero()});
      }
    }
  }
  for (std::uint32_t a = 0; a < kNumCameras; ++a) {
    for (std::uint32_t b = a + 1; b < kNumCameras; ++b) {
      RelativePose& pose = scene.relative_poses[{a, b}];
      pose.views = {a, b};
      // The nearer, the more.
      pose.log10_nfa = -100.0 / (b - a);
    }
  }
  return scene;
}

TEST(FindLookAlikes, WallsThatAreAlikeInPartAreToldApart) {
  for (const std::uint32_t alike : {4, 8, 12}) {
    const auto found = Find(SceneOfTwoWalls(5, alike), {});
    EXPECT_EQ(found.false_poses.size(), 5u * 3) << alike;
    const auto joins_both = [](const ViewPair& views) {
      return IsElsewhere(views.first, 5) != IsElsewhere(views.second, 5);
    };
    EXPECT_THAT(found.false_poses, Each(Truly(joins_both))) << alike;
    EXPECT_THAT(found.different, Not(IsEmpty())) << alike;
    EXPECT_THAT(found.different, Each(Truly(joins_both))) << alike;
    EXPECT_THAT(found.doubtful, ElementsAre(5, 6, 7)) << alike;
  }
}

TEST(FindLookAlikes, WithoutAMajorityAllAreDoubtful) {
  EXPECT_EQ(Find(SceneOfTwoWalls(4, 8), {}).doubtful.size(), kNumCameras);
}

TEST(FindLookAlikes, OneWallIsNoLookAlike) {
  const auto found = Find(SceneOfTwoWalls(kNumCameras, 8), {});
  EXPECT_THAT(found.different, IsEmpty());
  EXPECT_THAT(found.false_poses, IsEmpty());
  EXPECT_THAT(found.doubtful, IsEmpty());
}

TEST(FindLookAlikes, OnePairIsNotBelievedAgainstAllOthers) {
  Scene scene = SceneOfTwoWalls(kNumCameras, 20);
  // View 7 does not find what view 4 finds, except in a part.
  for (auto& [id, landmark] : scene.structure) {
    auto& seen = landmark.observations;
    const auto is_of = [](std::uint32_t view) {
      return [view](const PointObservation& o) { return o.view == view; };
    };
    const bool both = std::any_of(seen.begin(), seen.end(), is_of(4)) &&
                      std::any_of(seen.begin(), seen.end(), is_of(7));
    if (both && id.value() % 20 >= 8) {
      seen.erase(std::find_if(seen.begin(), seen.end(), is_of(7)));
    }
  }
  EXPECT_LT(Log10ChanceOfBare(OverlapPredictor(scene).RegionsOf(4, 7, 0),
                              2 * kChanceOfBare),
            -3);
  const auto found = Find(scene, {});
  EXPECT_THAT(found.different, IsEmpty());
  EXPECT_THAT(found.false_poses, IsEmpty());
}

// Two halves of the views hardly find each other's points, all over the wall.
TEST(FindLookAlikes, OneWallOfWhichLittleIsFoundIsNoLookAlike) {
  Scene scene = SceneOfTwoWalls(kNumCameras, 20);
  Random random(2);
  for (auto& [id, landmark] : scene.structure) {
    const bool by_both = random.Uniform() < 0.6;
    const bool by_first = random.Uniform() < 0.5;
    auto& seen = landmark.observations;
    seen.erase(std::remove_if(seen.begin(), seen.end(),
                              [&](const PointObservation& o) {
                                return !by_both &&
                                       (o.view.value() < 4) != by_first;
                              }),
               seen.end());
  }
  EXPECT_THAT(Find(scene, {}).false_poses, IsEmpty());
}

// Hardly anything of the other wall is found: that says something by what other
// views find only.
TEST(FindLookAlikes, FewLandmarksAreEnough) {
  for (const std::uint32_t alike : {2, 4}) {
    Scene scene = SceneOfTwoWalls(5, alike);
    for (std::uint32_t n = 0; n < 800; ++n) {
      if (n % 5 > 0) scene.structure.erase(n);
    }
    EXPECT_EQ(Find(scene, {}).false_poses.size(), 5u * 3) << alike;
  }
}

// A strong false one between others that are right.
TEST(FindLookAlikes, TheStrongestRelativePoseMayBeFalse) {
  Scene scene = SceneOfTwoWalls(5, 8);
  scene.relative_poses.at({2, 6}).log10_nfa = -500;
  EXPECT_EQ(Find(scene, {}).false_poses.size(), 5u * 3);
  scene.relative_poses.at({2, 6}).weakness = PoseWeakness::kRepeats;
  EXPECT_EQ(Find(scene, {}).false_poses.size(), 5u * 3);
}

// A small part of the walls differs.
TEST(FindLookAlikes, WhereSomeAreKnownLessTellsOthers) {
  LookAlikes before;
  before.false_poses = {{0, 1}};
  PoseSummary summary;
  summary.look_alikes = std::make_shared<LookAlikes>(before);
  const Scene nearly_alike = SceneOfTwoWalls(5, 17);
  EXPECT_THAT(Find(nearly_alike, {}).false_poses, IsEmpty());
  EXPECT_EQ(Find(nearly_alike, summary).false_poses.size(), 5u * 3);
  const Scene one_wall = SceneOfTwoWalls(kNumCameras, 8);
  EXPECT_THAT(Find(one_wall, summary).false_poses, IsEmpty());
  // None were found before.
  summary.look_alikes = std::make_shared<LookAlikes>();
  EXPECT_THAT(Find(nearly_alike, summary).false_poses, IsEmpty());
}

// The same, where another relative pose between the walls is in the way.
TEST(FindLookAlikes, WhereOthersContradictLessTells) {
  const auto find_without = [](std::uint32_t alike, const ViewPair& rejected,
                               double log10_nfa) {
    Scene scene = SceneOfTwoWalls(5, alike);
    scene.relative_poses.at(rejected).log10_nfa = log10_nfa;
    PoseSummary summary;
    summary.outlier_edges = {{rejected, OutlierReason::kDirection, 90}};
    return Find(scene, summary).false_poses;
  };
  constexpr std::uint32_t kNearlyAll = 17;
  EXPECT_EQ(find_without(kNearlyAll, {0, 5}, -500).size(), 5u * 3 - 1);
  EXPECT_THAT(find_without(kNearlyAll, {0, 5}, -5), IsEmpty());
  // Within a group it says nothing of the other one.
  EXPECT_THAT(find_without(kNearlyAll, {0, 4}, -500), IsEmpty());
  // One wall stays one.
  EXPECT_THAT(find_without(20, {0, 5}, -500), IsEmpty());
}

TEST(FindLookAlikes, OnlyWhatIsInUseIsFalse) {
  PoseSummary summary;
  summary.outlier_edges = {{{0, 7}, OutlierReason::kRotation, 90}};
  summary.unplaced = {6};
  const auto found = Find(SceneOfTwoWalls(5, 8), summary);
  EXPECT_EQ(found.false_poses.size(), 5u * 2 - 1);
}

TEST(FindLookAlikes, WithoutStructureNothingIsSaid) {
  Scene scene = SceneOfTwoWalls(5, 8);
  scene.structure.clear();
  EXPECT_THAT(Find(scene, {}).different, IsEmpty());
}

}  // namespace
}  // namespace lowlap
