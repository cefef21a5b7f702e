#include "lowlap/merge/internal/signed_clusters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace lowlap {
namespace {

using ::testing::ElementsAre;

TEST(ClusterByLinks, WithoutLinksAllAreAlone) {
  EXPECT_THAT(ClusterByLinks(3, {}), ElementsAre(0, 1, 2));
}

TEST(ClusterByLinks, PositiveLinksJoin) {
  EXPECT_THAT(ClusterByLinks(5, {{0, 3, 1}, {3, 4, 0.5}, {1, 2, -1}}),
              ElementsAre(0, 1, 2, 0, 0));
}

// 0-1-2 and 3-4-5, with a false link between 2 and 3.
TEST(ClusterByLinks, OneFalseLinkDoesNotJoinWhatManyKeepApart) {
  std::vector<SignedLink> links = {
      {0, 1, 1}, {1, 2, 1},  {0, 2, 1},  {3, 4, 1},  {4, 5, 1}, {3, 5, 1},
      {2, 3, 1}, {0, 3, -1}, {1, 4, -1}, {0, 5, -1}, {2, 5, -1}};
  EXPECT_THAT(ClusterByLinks(6, links), ElementsAre(0, 0, 0, 1, 1, 1));
  std::reverse(links.begin(), links.end());
  EXPECT_THAT(ClusterByLinks(6, links), ElementsAre(0, 0, 0, 1, 1, 1));
}

TEST(ClusterByLinks, LinksOfOnePairAddUp) {
  EXPECT_THAT(ClusterByLinks(2, {{0, 1, 1}, {1, 0, -3}, {0, 1, 1}}),
              ElementsAre(0, 1));
  EXPECT_THAT(ClusterByLinks(2, {{0, 1, 1}, {1, 0, -3}, {0, 1, 2.5}}),
              ElementsAre(0, 0));
}

}  // namespace
}  // namespace lowlap
