#include "lowlap/matching/internal/pair_retrieval.h"

#include <gmock/gmock.h>

#include "lowlap/core/internal/random.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using testing::ExpectRefused;
using ::testing::IsEmpty;
using testing::IsOk;

// A view sees the points [begin, end) of a long wall.
DetectedFeatures ViewOfWall(std::size_t begin, std::size_t end) {
  DetectedFeatures view;
  for (std::size_t i = begin; i < end; ++i) {
    Random random(i);
    PointDescriptor descriptor;
    for (std::uint8_t& value : descriptor) {
      value = static_cast<std::uint8_t>(random.Index(256));
    }
    Keypoint keypoint;
    keypoint.scale_px = 2;
    view.keypoints.push_back(keypoint);
    view.point_descriptors.push_back(descriptor);
  }
  return view;
}

TEST(RetrievePairsTest, EveryViewFindsThePartnersItSharesMostWith) {
  // Views of 40 points, 10 apart; seen out of order. Neighbours share 30.
  std::map<ViewId, DetectedFeatures> features;
  for (const std::size_t place : {0u, 1u, 2u, 3u, 4u}) {
    features[static_cast<ViewId>((place * 2) % 5 + 7)] =
        ViewOfWall(10 * place, 10 * place + 40);
  }
  RetrievalOptions options;
  options.max_partners = 1;
  const auto pairs = RetrievePairs(features, options, RunContext());
  ASSERT_THAT(pairs, IsOk());
  // Places 0 1 2 3 4 are the views 7 9 11 8 10.
  EXPECT_THAT(*pairs, ElementsAre(ViewPair{7, 9}, ViewPair{8, 10},
                                  ViewPair{8, 11}, ViewPair{9, 11}));
}

// Among other photographs, so that a neighbour may be chance.
TEST(RetrievePairsTest, AnIndexFindsThePartnersOfManyViews) {
  constexpr std::size_t kViews = 40;
  std::map<ViewId, DetectedFeatures> features;
  for (std::size_t place = 0; place < kViews; ++place) {
    features[static_cast<ViewId>(place)] =
        ViewOfWall(10 * place, 10 * place + 40);
  }
  RetrievalOptions options;
  options.max_partners = 2;
  options.max_exhaustive = 0;
  const auto pairs = RetrievePairs(features, options, RunContext());
  ASSERT_THAT(pairs, IsOk());
  RunContext two_threads;
  two_threads.num_threads = 2;
  EXPECT_EQ(*RetrievePairs(features, options, two_threads), *pairs);
  for (std::uint32_t place = 0; place + 1 < kViews; ++place) {
    EXPECT_THAT(*pairs, Contains(ViewPair{place, place + 1}));
  }
  for (const ViewPair& pair : *pairs) {
    EXPECT_LE(pair.second.value() - pair.first.value(), 3U);
  }
}

TEST(RetrievePairsTest, OneVoteKeepsTwoGroupsConnected) {
  std::map<ViewId, DetectedFeatures> features;
  features[0] = ViewOfWall(0, 40);
  features[1] = ViewOfWall(5, 41);
  features[2] = ViewOfWall(40, 80);  // shares one point with view 1
  features[3] = ViewOfWall(45, 85);
  features[4] = ViewOfWall(200, 240);  // shares nothing
  RetrievalOptions options;
  options.max_partners = 1;
  const auto pairs = RetrievePairs(features, options, RunContext());
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs,
              ElementsAre(ViewPair{0, 1}, ViewPair{1, 2}, ViewPair{2, 3}));
}

TEST(RetrievePairsTest, ASmallSetIsMatchedCompletely) {
  std::map<ViewId, DetectedFeatures> features;
  EXPECT_THAT(*RetrievePairs(features, {}, RunContext()), IsEmpty());
  for (const ViewId id : {3u, 5u, 9u}) features[id];
  EXPECT_THAT(*RetrievePairs(features, {}, RunContext()),
              ElementsAre(ViewPair{3, 5}, ViewPair{3, 9}, ViewPair{5, 9}));
}

TEST(RetrievePairsTest, TheLargestPointsVote) {
  std::map<ViewId, DetectedFeatures> features;
  for (ViewId id = 0; id < 3; ++id) features[id] = ViewOfWall(0, 60);
  // The large points of view 2 are others.
  for (std::size_t i = 0; i < 30; ++i) {
    features[0].keypoints[i].scale_px = 9;
    features[1].keypoints[i].scale_px = 9;
    features[2].keypoints[30 + i].scale_px = 9;
  }
  RetrievalOptions options;
  options.max_partners = 1;
  options.sample_points = 30;
  const auto pairs = RetrievePairs(features, options, RunContext());
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs, ElementsAre(ViewPair{0, 1}));
}

TEST(RetrievalOptionsTest, RejectsValuesOutOfRange) {
  ExpectRefused(&RetrievalOptions::sample_points, 1, "sample_points");
  ExpectRefused(&RetrievalOptions::max_partners, 0, "max_partners");
  ExpectRefused(&RetrievalOptions::max_exhaustive, -1, "max_exhaustive");
  ExpectRefused(&RetrievalOptions::max_ratio, 0, "max_ratio");
}

}  // namespace
}  // namespace lowlap
