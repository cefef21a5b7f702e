#include "lowlap/scene/scale_ratio.h"

#include <gtest/gtest.h>

#include <string>

namespace lowlap {
namespace {

KindSupport Support(const std::string& kind, int inliers, int candidates,
                    int min_agreeing) {
  KindSupport support;
  support.kind = kind;
  support.inliers = inliers;
  support.candidates = candidates;
  support.min_agreeing = min_agreeing;
  return support;
}

TEST(ScaleRatio, KindsAlikeAgreeTogether) {
  ScaleRatio ratio;
  EXPECT_FALSE(ratio.HasAgreement());
  ratio.kinds = {Support("points", 1, 3, 2), Support("lines", 0, 3, 2),
                 Support("coplanar", 2, 9, 3)};
  EXPECT_FALSE(ratio.HasAgreement());
  ratio.kinds[1].inliers = 1;
  EXPECT_TRUE(ratio.HasAgreement());
}

TEST(ScaleRatio, KindsAlikeHaveAMajorityTogether) {
  ScaleRatio ratio;
  EXPECT_FALSE(ratio.HasMajority());
  ratio.kinds = {Support("points", 3, 4, 2), Support("lines", 0, 2, 2),
                 Support("coplanar", 40, 80, 3)};
  EXPECT_FALSE(ratio.HasMajority());  // halves
  ratio.kinds[1].inliers = 1;
  EXPECT_TRUE(ratio.HasMajority());
  ratio.kinds[1].inliers = 0;
  ratio.kinds[2].inliers = 41;
  EXPECT_TRUE(ratio.HasMajority());
}

}  // namespace
}  // namespace lowlap
