#include "lowlap/averaging/reliability/internal/missing_matches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

#include "averaging/reliability/cameras_in_a_row.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<ReliabilityWarning> FindMissing(const Scene& scene,
                                            const PoseSummary& summary) {
  return FindMissingMatches(scene, summary,
                            PredictOverlaps(scene, RunContext()).value());
}

constexpr std::uint32_t kViews = 8;

// Eight cameras one beside the other before a wall. Some belong elsewhere,
// before a wall of their own that lies where the other one does: a false
// relative pose, weaker than the others, put them there. All pairs were
// compared, and those of one wall found related.
Scene SceneOfTwoWallsInOnePlace(const std::set<std::uint32_t>& elsewhere = {5,
                                                                            6,
                                                                            7},
                                const ViewPair& false_pair = {4, 5}) {
  Scene scene = CamerasInARow(kViews, 0.3);
  for (std::uint32_t n = 0; n < 800; ++n) {
    const bool is_second = n >= 400;
    Landmark& landmark = scene.structure[n];
    landmark.position =
        Vec3(n % 20, (n % 400) / 20, 0) * 0.5 + Vec3(-4, -5, 10);
    for (std::uint32_t view = 0; view < kViews; ++view) {
      if ((elsewhere.count(view) > 0) == is_second) {
        landmark.observations.push_back({view, n, Vec2::Zero()});
      }
    }
  }
  for (std::uint32_t a = 0; a < kViews; ++a) {
    for (std::uint32_t b = a + 1; b < kViews; ++b) {
      const ViewPair views = {a, b};
      if (elsewhere.count(a) == elsewhere.count(b) || views == false_pair) {
        RelativePose& pose = scene.relative_poses[views];
        pose.views = views;
        pose.log10_nfa = views == false_pair ? -30 : -50;
      } else {
        scene.unrelated_pairs.push_back(views);
      }
    }
  }
  return scene;
}

TEST(MissingMatches, SpeakAgainstWhatJoinsTwoPlaces) {
  const auto warnings = FindMissing(SceneOfTwoWallsInOnePlace(), {});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kMissingMatches);
  EXPECT_THAT(warnings[0].views, ElementsAre(5, 6, 7));
  EXPECT_EQ(warnings[0].missing.size(), 14u);
  EXPECT_EQ(warnings[0].missing.front(), (ViewPair{0, 5}));
}

TEST(MissingMatches, AreSaidOnceWhateverTheIds) {
  const auto warnings =
      FindMissing(SceneOfTwoWallsInOnePlace({1, 3, 5}, {4, 5}), {});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].views, ElementsAre(1, 3, 5));
  EXPECT_EQ(warnings[0].missing.size(), 14u);
}

TEST(MissingMatches, OfTwoLikeHalvesEitherMayBeWrong) {
  const auto warnings =
      FindMissing(WithoutViews(SceneOfTwoWallsInOnePlace(), {0, 1}), {});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0].views, ElementsAre(2, 3, 4, 5, 6, 7));
}

TEST(MissingMatches, AreThoseThatWereLookedFor) {
  Scene scene = SceneOfTwoWallsInOnePlace();
  scene.unrelated_pairs = {{3, 6}, {4, 6}};
  EXPECT_THAT(FindMissing(scene, {}), IsEmpty());  // a few may happen
  scene.unrelated_pairs = {{3, 6}, {4, 6}, {4, 7}};
  EXPECT_EQ(FindMissing(scene, {}).size(), 1u);
  scene.unrelated_pairs.clear();
  EXPECT_THAT(FindMissing(scene, {}), IsEmpty());
}

// As where a facade repeats: no relative pose of their own, but tracks.
TEST(MissingMatches, PairsWithCommonTracksAreNoneOfThem) {
  Scene scene = SceneOfTwoWallsInOnePlace();
  for (std::uint32_t n = 0; n < 400; n += 7) {
    for (const std::uint32_t view : {5u, 6u, 7u}) {
      scene.structure.at(n).observations.push_back({view, n, Vec2::Zero()});
    }
  }
  EXPECT_THAT(FindMissing(scene, {}), IsEmpty());
}

TEST(MissingMatches, CountLessThanWhatIsFoundAcross) {
  Scene scene = SceneOfTwoWallsInOnePlace();
  for (const ViewPair views :
       {ViewPair{2, 5}, ViewPair{2, 6}, ViewPair{3, 5}, ViewPair{3, 6},
        ViewPair{3, 7}, ViewPair{4, 6}, ViewPair{4, 7}}) {
    RelativePose& pose = scene.relative_poses[views];
    pose.views = views;
    pose.log10_nfa = -3;
  }
  scene.unrelated_pairs = {{0, 5}, {0, 6}, {0, 7}, {1, 5},
                           {1, 6}, {1, 7}, {2, 7}};
  EXPECT_THAT(FindMissing(scene, {}), IsEmpty());
  // Those that are not in use hold nothing.
  PoseSummary summary;
  summary.outlier_edges = {{{3, 7}, OutlierReason::kDirection, 9}};
  EXPECT_THAT(FindMissing(scene, summary), IsEmpty());
  summary.outlier_edges.push_back({{3, 6}, OutlierReason::kDirection, 9});
  EXPECT_EQ(FindMissing(scene, summary).size(), 1u);
}

}  // namespace
}  // namespace lowlap
