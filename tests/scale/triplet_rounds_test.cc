#include "lowlap/scale/internal/triplet_rounds.h"

#include <gmock/gmock.h>

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scale/row_of_views.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;

class Silent : public EvidenceKind {
 public:
  Silent(std::string name, EvidenceRound round, bool may_speak = true)
      : name_(std::move(name)), round_(round), may_speak_(may_speak) {}
  std::string Name() const override { return name_; }
  EvidenceRound Round() const override { return round_; }
  std::unique_ptr<Evidence> Gather(const TripletView&) const override {
    return nullptr;
  }
  bool MaySpeak(const SceneFeatures&, const ViewTriplet&) const override {
    return may_speak_;
  }

 private:
  std::string name_;
  EvidenceRound round_;
  bool may_speak_;
};

EvidenceKinds FirstAndUndecided(bool may_speak) {
  return {
      std::make_shared<Silent>("late", EvidenceRound::kUndecided, may_speak),
      std::make_shared<Silent>("first", EvidenceRound::kFirst)};
}

const std::vector<ViewTriplet> kTriplets = {{0, 1, 2}, {1, 2, 3}, {0, 2, 3}};

TEST(LargestFirst, OrdersByTheMatchesOfBothPairs) {
  testing::RowOfViews row;
  row.scene.relative_poses[{0, 1}].point_inliers.resize(1);
  row.scene.relative_poses[{2, 3}].line_inliers.clear();
  EXPECT_THAT(LargestFirst(row.scene, kTriplets), ElementsAre(1, 2, 0));
}

TEST(PrepareRound, TakesTheKindsOfTheRound) {
  const testing::RowOfViews row;
  const SceneFeatures features(row.scene);
  const auto kinds =
      PrepareRound(FirstAndUndecided(true), EvidenceRound::kUndecided, features,
                   kTriplets, RunContext());
  ASSERT_TRUE(kinds.has_value());
  ASSERT_EQ(kinds->size(), 1u);
  EXPECT_EQ(kinds->front()->Name(), "late");
}

// What a test of triplet (1, 2, 3) alone calls meaningful.
std::map<ViewTriplet, std::vector<std::string>> KindsAsked(bool may_speak,
                                                           int* num_tests) {
  const testing::RowOfViews row;
  const auto ratios = TestTriplets<ScaleRatio>(
      row.scene, kTriplets, FirstAndUndecided(may_speak), RunContext(), "test",
      [](const TripletView& view,
         const TripletEvidence& evidence) -> Result<ScaleRatio> {
        ScaleRatio ratio;
        ratio.views = view.views;
        ratio.log_ratio = evidence.num_tests;
        ratio.verdict = view.views == kTriplets[1]
                            ? RatioVerdict::kMeaningful
                            : RatioVerdict::kNotMeaningful;
        for (const auto& kind : evidence.kinds) {
          ratio.kinds.emplace_back().kind = kind.name;
        }
        return ratio;
      });
  EXPECT_TRUE(ratios.has_value());
  std::map<ViewTriplet, std::vector<std::string>> asked;
  *num_tests = 0;
  for (std::size_t n = 0; n < ratios->size(); ++n) {
    EXPECT_EQ((*ratios)[n].views, kTriplets[n]);
    *num_tests += static_cast<int>((*ratios)[n].log_ratio);
    for (const KindSupport& kind : (*ratios)[n].kinds) {
      asked[kTriplets[n]].push_back(kind.kind);
    }
  }
  return asked;
}

TEST(TestTriplets, AsksTheLateKindsAboutUndecidedTriplets) {
  int num_tests = 0;
  const auto asked = KindsAsked(true, &num_tests);
  EXPECT_THAT(asked.at(kTriplets[0]), ElementsAre("first", "late"));
  EXPECT_THAT(asked.at(kTriplets[1]), ElementsAre("first"));
  EXPECT_THAT(asked.at(kTriplets[2]), ElementsAre("first", "late"));
  EXPECT_EQ(num_tests, 2 + 1 + 2);
}

TEST(TestTriplets, SavesTheSecondTestIfNoLateKindMaySpeak) {
  int num_tests = 0;
  const auto asked = KindsAsked(false, &num_tests);
  for (const ViewTriplet& views : kTriplets) {
    EXPECT_THAT(asked.at(views), ElementsAre("first"));
  }
  EXPECT_EQ(num_tests, 3);
}

TEST(TestTriplets, HasNoCandidatesWithoutFeatures) {
  testing::RowOfViews row;
  row.scene.features.erase(3);
  const auto ratios = TestTriplets<ScaleRatio>(
      row.scene, kTriplets, FirstAndUndecided(true), RunContext(), "test",
      [](const TripletView& view,
         const TripletEvidence&) -> Result<ScaleRatio> {
        ScaleRatio ratio;
        ratio.views = view.views;
        ratio.verdict = RatioVerdict::kMeaningful;
        return ratio;
      });
  ASSERT_TRUE(ratios.has_value());
  EXPECT_EQ((*ratios)[0].verdict, RatioVerdict::kMeaningful);
  EXPECT_EQ((*ratios)[1].verdict, RatioVerdict::kNoCandidates);
  EXPECT_EQ((*ratios)[1].views, kTriplets[1]);
}

// A test that gives ratios that are not finite, or fails, at some triplets.
TEST(TestTriplets, OneThatFailsDoesNotLoseTheOthers) {
  const testing::RowOfViews row;
  std::vector<std::string> warnings;
  RunContext context;
  context.log = [&](LogLevel, const std::string& text) {
    warnings.push_back(text);
  };
  const auto ratios = TestTriplets<ScaleRatio>(
      row.scene, kTriplets, FirstAndUndecided(false), context, "test",
      [](const TripletView& view,
         const TripletEvidence&) -> Result<ScaleRatio> {
        if (view.views == kTriplets[0]) {
          return MakeError(ErrorCode::kNumerical, "nothing converged");
        }
        ScaleRatio ratio;
        ratio.views = view.views;
        ratio.verdict = RatioVerdict::kMeaningful;
        if (view.views == kTriplets[2]) {
          ratio.kinds.emplace_back().log10_nfa =
              -std::numeric_limits<double>::infinity();
        }
        return ratio;
      });
  ASSERT_TRUE(ratios.has_value());
  EXPECT_EQ((*ratios)[0].verdict, RatioVerdict::kNoCandidates);
  EXPECT_EQ((*ratios)[1].verdict, RatioVerdict::kMeaningful);
  EXPECT_EQ((*ratios)[2].verdict, RatioVerdict::kNoCandidates);
  EXPECT_TRUE((*ratios)[2].kinds.empty());
  EXPECT_EQ((*ratios)[2].views, kTriplets[2]);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("2 of 3 triplets"));
  EXPECT_THAT(warnings[0],
              ::testing::HasSubstr(row.scene.views.at(0).filename));
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("nothing converged"));
}

// Triplet 0 fails in the second round, 1 in the first, 2 in both.
TEST(TestTriplets, TheLastTestThatDidNotFailCounts) {
  const testing::RowOfViews row;
  std::vector<std::string> warnings;
  RunContext context;
  context.log = [&](LogLevel, const std::string& text) {
    warnings.push_back(text);
  };
  const auto ratios = TestTriplets<ScaleRatio>(
      row.scene, kTriplets, FirstAndUndecided(true), context, "test",
      [](const TripletView& view,
         const TripletEvidence& evidence) -> Result<ScaleRatio> {
        const bool again = evidence.num_tests == 2;
        if (view.views == kTriplets[again ? 0 : 1] ||
            view.views == kTriplets[2]) {
          return MakeError(ErrorCode::kNumerical, "nothing converged");
        }
        ScaleRatio ratio;
        ratio.views = view.views;
        ratio.log_ratio = evidence.num_tests;
        ratio.verdict = RatioVerdict::kNotMeaningful;
        return ratio;
      });
  ASSERT_TRUE(ratios.has_value());
  EXPECT_EQ((*ratios)[0].log_ratio, 1);
  EXPECT_EQ((*ratios)[1].log_ratio, 2);
  EXPECT_EQ((*ratios)[2].verdict, RatioVerdict::kNoCandidates);
  EXPECT_EQ((*ratios)[2].views, kTriplets[2]);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("2 of 3 triplets"));
}

TEST(TestTriplets, CanBeCancelledByTheTest) {
  const testing::RowOfViews row;
  const auto ratios = TestTriplets<ScaleRatio>(
      row.scene, kTriplets, FirstAndUndecided(false), RunContext(), "test",
      [](const TripletView&, const TripletEvidence&) -> Result<ScaleRatio> {
        return MakeError(ErrorCode::kCancelled, "");
      });
  ASSERT_FALSE(ratios.has_value());
  EXPECT_EQ(ratios.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace lowlap
