#include "lowlap/two_view/internal/other_copies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lowlap/geometry/internal/rotation.h"
#include "support/matchers.h"
#include "tests/two_view/tiled_pair.h"

namespace lowlap {
namespace {

using testing::IsOk;
using testing::kColumns;
using testing::kInPattern;
using testing::kRows;
using testing::SideStep;
using testing::TiledPair;

constexpr double kOnTheWall = 5;

// The cells of the upper rows, but for the last column, go with the next
// column; the last has no match.
std::set<FeatureIndex> ShiftUpperRows(int num_rows, TiledPair* pair) {
  std::set<FeatureIndex> shifted;
  std::vector<FeatureMatch> matches;
  for (const FeatureMatch& match : pair->matches) {
    const int cell = static_cast<int>(match.first) % (kColumns * kRows);
    if (static_cast<int>(match.first) >= kInPattern ||
        cell / kColumns >= num_rows) {
      matches.push_back(match);
    } else if (cell % kColumns + 1 < kColumns) {
      matches.push_back({match.first, match.second + 1});
      shifted.insert(match.first);
    }
  }
  pair->matches = std::move(matches);
  return shifted;
}

// The first points of the matches found.
std::set<FeatureIndex> Found(const TwoViewInput& input,
                             const RelativePose& pose) {
  Random random(3);
  const ShuffledMatches matches = ShuffleMatches(input, random);
  const std::vector<int> others =
      MatchesOfOtherCopies(input, matches, pose, random);
  EXPECT_TRUE(std::is_sorted(others.begin(), others.end()));
  std::set<FeatureIndex> found;
  for (const int n : others) {
    found.insert(input.point_matches[matches.match_of_pair[n]].first);
  }
  return found;
}

TEST(MatchesOfOtherCopies, AreThoseShiftedAlongThePattern) {
  TiledPair pair(60, SideStep(), kOnTheWall);
  EXPECT_TRUE(Found(pair.Input(), pair.TruePose()).empty());
  const std::set<FeatureIndex> shifted = ShiftUpperRows(3, &pair);
  ASSERT_GT(shifted.size(), 100u);
  const std::set<FeatureIndex> found = Found(pair.Input(), pair.TruePose());
  EXPECT_GT(2 * found.size(), shifted.size());
  EXPECT_TRUE(std::includes(shifted.begin(), shifted.end(), found.begin(),
                            found.end()));
}

// One cell of the next column: as much as chance brings about.
TEST(MatchesOfOtherCopies, AreNoneOfAFewByChance) {
  TiledPair pair(60, SideStep(), kOnTheWall);
  for (FeatureMatch& match : pair.matches) {
    if (match.first == kColumns) ++match.second;
  }
  EXPECT_TRUE(Found(pair.Input(), pair.TruePose()).empty());
}

TEST(MatchesOfOtherCopies, AreUnknownWithoutAPlaneOrAPattern) {
  TiledPair pair(60, SideStep(), kOnTheWall);
  ShiftUpperRows(3, &pair);
  TwoViewInput input = pair.Input();
  // Nine points that do not repeat.
  const auto is_superfluous = [&](const FeatureMatch& match) {
    return match.first < kInPattern ? !pair.repeats1.HasPoint(match.first)
                                    : match.first >= kInPattern + 9;
  };
  input.point_matches.erase(
      std::remove_if(input.point_matches.begin(), input.point_matches.end(),
                     is_superfluous),
      input.point_matches.end());
  EXPECT_TRUE(Found(input, pair.TruePose()).empty());
  input = pair.Input();
  input.repeats1 = nullptr;
  EXPECT_TRUE(Found(input, pair.TruePose()).empty());
}

// Along the rows, so that the next column lies on the epipolar line.
RigidTransform StepAlongTheWall() {
  const Mat3 rotation = SideStep().rotation;
  return {rotation,
          rotation * testing::ObliqueCamera().rotation * Vec3(-0.9, 0, 0)};
}

TEST(EstimateRelativePose, LeavesOutMatchesOfOtherCopies) {
  TiledPair pair(40, StepAlongTheWall(), 4);
  const std::set<FeatureIndex> shifted = ShiftUpperRows(2, &pair);
  const auto num_shifted_inliers = [&](const TwoViewInput& input) {
    const auto result = EstimateRelativePose(input, {}, 1);
    EXPECT_THAT(result, IsOk());
    EXPECT_LT(AngleBetween(result->pose.direction, pair.TruePose().direction),
              0.03);
    const std::vector<FeatureMatch>& inliers = result->pose.point_inliers;
    return static_cast<std::size_t>(std::count_if(
        inliers.begin(), inliers.end(),
        [&](const auto& match) { return shifted.count(match.first) > 0; }));
  };
  TwoViewInput input = pair.Input();
  EXPECT_LT(num_shifted_inliers(input), shifted.size() / 2);
  input.repeats1 = input.repeats2 = nullptr;
  EXPECT_GT(num_shifted_inliers(input), shifted.size() * 9 / 10);
}

// The next column lies near the epipolar lines, and most of what does not
// repeat near the wall: a motion that is off explains both.
TEST(EstimateRelativePose, CorrectsAMotionThatCopiesDrawAside) {
  for (const int num_rows : {4, 7}) {
    const Mat3 rotation = SideStep().rotation;
    const Vec3 step(-0.9, 0.05, 0);
    TiledPair pair(
        120, {rotation, rotation * testing::ObliqueCamera().rotation * step},
        4);
    ShiftUpperRows(num_rows, &pair);
    const auto error_deg = [&](const TwoViewInput& input) {
      const auto result = EstimateRelativePose(input, {}, 1);
      EXPECT_THAT(result, IsOk());
      return DegFromRad(
          AngleBetween(result->pose.direction, pair.TruePose().direction));
    };
    TwoViewInput input = pair.Input();
    EXPECT_LT(error_deg(input), 0.1) << num_rows;
    input.repeats1 = input.repeats2 = nullptr;
    EXPECT_GT(error_deg(input), 1) << num_rows;
  }
}

}  // namespace
}  // namespace lowlap
