#include "lowlap/merge/internal/rigid_pieces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/scene/view_graph.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Cameras on a line, where directions fix no ratio: what is one piece, given
/// ratios say. All that is added agrees.
class RigidPiecesTest : public ::testing::Test {
 protected:
  RigidPiecesTest() {
    for (std::uint32_t n = 0; n < 9; ++n) {
      poses_[n].center = Vec3(n, 0, 0);
    }
  }

  // Baselines with the ratios of all neighbours among them.
  void Add(const std::vector<ViewPair>& pairs) {
    for (const ViewPair& views : pairs) {
      PairAgreement pair;
      pair.views = views;
      pair.rotation_limit_rad = 0.02;
      pair.direction_limit_rad = 0.5;
      pairs_.push_back(pair);
    }
    for (const ViewTriplet& views : FindTriplets(ViewGraph(pairs))) {
      ratios_.push_back({views, 0, 0.299, -20});
    }
  }

  static std::vector<ViewPair> AllOf(std::uint32_t first, std::uint32_t last) {
    std::vector<ViewPair> pairs;
    for (std::uint32_t a = first; a <= last; ++a) {
      for (std::uint32_t b = a + 1; b <= last; ++b) pairs.push_back({a, b});
    }
    return pairs;
  }

  std::vector<RigidPiece> Find() const {
    const auto pieces = FindRigidPieces(poses_, pairs_, ratios_, 3, {});
    EXPECT_THAT(pieces, testing::IsOk());
    return pieces ? *pieces : std::vector<RigidPiece>();
  }

  std::map<ViewId, Pose> poses_;
  std::vector<PairAgreement> pairs_;
  std::vector<RatioAgreement> ratios_;
};

TEST_F(RigidPiecesTest, WithoutMeasurementsThereAreNone) {
  EXPECT_THAT(Find(), IsEmpty());
}

TEST_F(RigidPiecesTest, OnlyOneViewInCommonKeepsPiecesApart) {
  Add(AllOf(0, 5));
  Add(AllOf(5, 8));
  EXPECT_THAT(Find(), SizeIs(2));
}

// The third shares two views with the first; with it, the first shares two with
// the second.
TEST_F(RigidPiecesTest, APieceThatGrowsMayMeetAnother) {
  Add(AllOf(0, 5));
  Add(AllOf(5, 8));
  Add({{3, 6}, {4, 6}});
  const std::vector<RigidPiece> pieces = Find();
  ASSERT_THAT(pieces, SizeIs(1));
  EXPECT_THAT(pieces[0].views, SizeIs(9));
  EXPECT_EQ(pieces[0].pairs.size(), pairs_.size());
}

// As far from where two parts were put together: the wrong scale of a part
// changes a long distance by little, which agrees, but bears nothing out.
TEST_F(RigidPiecesTest, WhatNearlyContradictsJoinsNothing) {
  Add(AllOf(0, 3));
  const std::size_t num_before = ratios_.size();
  Add({{0, 4}, {1, 4}});
  for (std::size_t r = num_before; r < ratios_.size(); ++r) {
    ratios_[r].error = 0.95 * ratios_[r].limit;
  }
  for (const ViewId view : {0u, 1u}) {
    ratios_.push_back({{ViewId(2), view, ViewId(4)}, 0.28, 0.299, -20});
  }
  const std::vector<RigidPiece> pieces = Find();
  ASSERT_THAT(pieces, SizeIs(1));
  EXPECT_THAT(pieces[0].views, SizeIs(4));
}

}  // namespace
}  // namespace lowlap
