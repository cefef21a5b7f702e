#include <gtest/gtest.h>

#include <bitset>

#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/lines/line_candidates.h"

namespace lowlap {
namespace {

TEST(HammingDistances, CountsTheBitsThatDiffer) {
  Random random(1);
  std::vector<LineDescriptor> all(37);
  for (LineDescriptor& descriptor : all) {
    for (auto& byte : descriptor) {
      byte = static_cast<std::uint8_t>(random.Index(256));
    }
  }
  all[5] = all[0];
  for (std::size_t k = 0; k < all[6].size(); ++k) {
    all[6][k] = static_cast<std::uint8_t>(~all[0][k]);
  }
  std::vector<int> distances(3, -1);
  HammingDistances(all[0], all, &distances);
  ASSERT_EQ(distances.size(), all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    std::size_t expected = 0;
    for (std::size_t k = 0; k < all[n].size(); ++k) {
      expected += std::bitset<8>(all[0][k] ^ all[n][k]).count();
    }
    EXPECT_EQ(distances[n], static_cast<int>(expected)) << n;
  }
  EXPECT_EQ(distances[5], 0);
  EXPECT_EQ(distances[6], 256);
  HammingDistances(all[0], {}, &distances);
  EXPECT_TRUE(distances.empty());
}

}  // namespace
}  // namespace lowlap
