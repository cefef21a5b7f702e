#include "lowlap/merge/internal/linked_pieces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lowlap {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::Field;
using ::testing::IsEmpty;

/// Baselines in parts, each of which says something about every other one that
/// it meets in a view: that they belong together, or, of another part, that
/// they do not.
class LinkedPiecesTest : public ::testing::Test {
 protected:
  void Add(const std::vector<ViewPair>& part) {
    parts_.push_back(part);
    baselines_.insert(baselines_.end(), part.begin(), part.end());
  }

  static std::vector<ViewPair> PairsAmong(
      const std::vector<std::uint32_t>& views) {
    std::vector<ViewPair> pairs;
    for (std::size_t a = 0; a < views.size(); ++a) {
      for (std::size_t b = a + 1; b < views.size(); ++b) {
        pairs.push_back({ViewId(views[a]), ViewId(views[b])});
      }
    }
    return pairs;
  }

  // A piece of these views that all pairs among them bear out, and no other.
  static auto Of(const std::vector<std::uint32_t>& views) {
    return AllOf(Field(&RigidPiece::views, ElementsAreArray(views)),
                 Field(&RigidPiece::pairs, PairsAmong(views)));
  }

  std::vector<RigidPiece> Find() const {
    const ViewGraph graph(baselines_);
    std::vector<std::size_t> part_of(graph.pairs().size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (const ViewPair& views : parts_[p]) {
        part_of[*graph.FindPair(views.first, views.second)] = p;
      }
    }
    std::vector<SignedLink> links;
    for (const ViewTriplet& views : FindTriplets(graph)) {
      const std::size_t a = *graph.FindPair(views.first, views.middle);
      const std::size_t b = *graph.FindPair(views.middle, views.last);
      links.push_back({a, b, part_of[a] == part_of[b] ? 1.0 : -1.0});
    }
    return PiecesOfLinks(graph, std::move(links));
  }

  std::vector<std::vector<ViewPair>> parts_;
  std::vector<ViewPair> baselines_;
};

TEST_F(LinkedPiecesTest, WithoutBaselinesThereAreNone) {
  EXPECT_THAT(Find(), IsEmpty());
}

TEST_F(LinkedPiecesTest, TwoMayMeetInOneView) {
  Add(PairsAmong({0, 1, 2, 3}));
  Add(PairsAmong({3, 4, 5}));
  EXPECT_THAT(Find(), ElementsAre(Of({0, 1, 2, 3}), Of({3, 4, 5})));
}

// A baseline of the second, true in direction, that ends in the first.
TEST_F(LinkedPiecesTest, ASmallerOneIsNotLostByABaselineTooFar) {
  Add(PairsAmong({0, 1, 2, 3}));
  std::vector<ViewPair> second = PairsAmong({3, 4, 5});
  second.push_back({ViewId(2), ViewId(5)});
  Add(second);
  EXPECT_THAT(Find(), ElementsAre(Of({0, 1, 2, 3}), Of({3, 4, 5})));
}

TEST_F(LinkedPiecesTest, NorDoesTheLargerOneKeepOneThatIsTheOthers) {
  std::vector<ViewPair> first = PairsAmong({0, 1, 2, 3});
  first.push_back({ViewId(0), ViewId(5)});
  Add(first);
  Add(PairsAmong({3, 4, 5}));
  EXPECT_THAT(Find(), ElementsAre(Of({0, 1, 2, 3}), Of({3, 4, 5})));
}

// Each of its baselines leads to the same view, and no two other parts do.
TEST_F(LinkedPiecesTest, BaselinesBetweenOthersAreNone) {
  Add(PairsAmong({0, 1, 2, 3}));
  Add(PairsAmong({3, 4, 5, 6}));
  Add({{ViewId(0), ViewId(4)}, {ViewId(1), ViewId(4)}, {ViewId(2), ViewId(4)}});
  EXPECT_THAT(Find(), ElementsAre(Of({0, 1, 2, 3}), Of({3, 4, 5, 6})));
}

}  // namespace
}  // namespace lowlap
