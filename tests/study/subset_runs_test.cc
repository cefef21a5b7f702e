#include "lowlap/study/internal/subset_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/study/internal/subset_table.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "read_csv.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Scene SceneOfViews(std::uint32_t count) {
  Scene scene;
  for (std::uint32_t view = 0; view < count; ++view) {
    scene.views[2 * view].filename = "image " + std::to_string(view) + ".jpg";
  }
  return scene;
}

TEST(ChooseSubsets, AllOfThemInOrder) {
  const auto all = ChooseSubsets(SceneOfViews(5), 2, 0, 0);
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 10u);
  EXPECT_TRUE(std::is_sorted(all->begin(), all->end()));
  EXPECT_THAT(all->front(), ElementsAre(0, 2));
  EXPECT_THAT(all->back(), ElementsAre(6, 8));
  EXPECT_EQ(std::set<std::vector<ViewId>>(all->begin(), all->end()).size(),
            10u);
  EXPECT_EQ(ChooseSubsets(SceneOfViews(19), 3, 0, 0)->size(), 969u);
}

TEST(ChooseSubsets, ASampleIsDistinctAndSeeded) {
  const Scene scene = SceneOfViews(40);
  const auto one = ChooseSubsets(scene, 20, 100, 1);
  ASSERT_TRUE(one);
  EXPECT_EQ(std::set<std::vector<ViewId>>(one->begin(), one->end()).size(),
            100u);
  for (const auto& subset : *one) EXPECT_EQ(subset.size(), 20u);
  EXPECT_EQ(*one, *ChooseSubsets(scene, 20, 100, 1));
  EXPECT_NE(*one, *ChooseSubsets(scene, 20, 100, 2));
  EXPECT_EQ(ChooseSubsets(scene, 1, 100, 1)->size(), 40u);
}

TEST(ChooseSubsets, RefusesWhatMakesNoSense) {
  for (const int drop : {-1, 0, 3, 5}) {
    const auto none = ChooseSubsets(SceneOfViews(5), drop, 0, 0);
    ASSERT_FALSE(none) << drop;
    EXPECT_EQ(none.error().code, ErrorCode::kInvalidArgument);
  }
  EXPECT_FALSE(ChooseSubsets(SceneOfViews(40), 20, 0, 0));
}

SubsetOutcome Outcome(std::uint32_t dropped, int placed, double mean,
                      double max) {
  SubsetOutcome outcome;
  outcome.dropped = {dropped, dropped + 2};
  outcome.num_views = 4;
  outcome.num_placed = placed;
  outcome.mean_error = outcome.mean_error_before_adjustment = mean;
  outcome.max_error = max;
  outcome.worst_view = 4;
  outcome.seconds = 1.5;
  return outcome;
}

std::vector<SubsetOutcome> Outcomes() {
  std::vector<SubsetOutcome> outcomes = {
      Outcome(0, 4, 0.02, 0.04), Outcome(2, 4, 0.04, 0.08),
      Outcome(4, 3, 0.01, 0.02), Outcome(6, 4, 0.3, 0.7),
      Outcome(0, 3, 0.3, 0.7),   Outcome(2, 4, 0.3, 0.7)};
  outcomes[3].doubts = {"open_loop", "weak_ratio"};
  outcomes[3].firm_errors = {{4, 0.7}, {6, 0.04}, {8, 0.3}};
  outcomes[3].doubtful_errors = {{10, 0.6}, {12, 0.01}, {14, 0.1}};
  outcomes[0].firm_errors = {{4, 0.02}};
  SubsetOutcome failure;
  failure.dropped = {0, 8};
  failure.num_views = 4;
  failure.failure = "no \"relative\" pose, at all";
  outcomes.push_back(failure);
  return outcomes;
}

TEST(SubsetTable, RecordsAreReadAsTheyWereWritten) {
  for (const SubsetOutcome& outcome : Outcomes()) {
    const std::string line = ToJsonLine(outcome);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const auto read = SubsetFromJsonLine(line);
    ASSERT_TRUE(read) << line;
    EXPECT_EQ(ToJsonLine(*read), line);
    EXPECT_EQ(read->dropped, outcome.dropped);
    EXPECT_EQ(read->mean_error, outcome.mean_error);
    EXPECT_EQ(read->doubts, outcome.doubts);
    EXPECT_EQ(read->firm_errors, outcome.firm_errors);
    EXPECT_EQ(read->doubtful_errors, outcome.doubtful_errors);
    EXPECT_EQ(read->failure, outcome.failure);
    EXPECT_EQ(read->worst_view, outcome.worst_view);
    for (std::size_t cut = 0; cut < line.size(); ++cut) {
      EXPECT_FALSE(SubsetFromJsonLine(line.substr(0, cut))) << cut;
    }
  }
  for (const char* wrong : {"[]", "{}", "7", R"({"dropped": 3})"}) {
    EXPECT_FALSE(SubsetFromJsonLine(wrong)) << wrong;
  }
}

TEST(SubsetTable, TheCsvHasARecordForEachSubset) {
  const auto records = ReadCsv(ToCsv(Outcomes(), SceneOfViews(6)));
  ASSERT_EQ(records.size(), 7u);
  EXPECT_EQ(records[3].at("dropped"), "6+8");
  EXPECT_EQ(records[3].at("max_error"), "0.700000");
  EXPECT_EQ(records[3].at("worst_view"), "image 2.jpg");
  EXPECT_EQ(records[3].at("firm"), "3");
  EXPECT_EQ(records[3].at("firm_max_error"), "0.700000");
  EXPECT_EQ(records[1].at("firm_max_error"), "");
  EXPECT_EQ(records[3].at("reasons"), "open_loop;weak_ratio");
  EXPECT_EQ(records[6].at("mean_error"), "");
  EXPECT_EQ(records[6].at("failure"), "no \"relative\" pose, at all");
}

TEST(SubsetTable, Summary) {
  const SubsetBounds bounds;
  const SubsetSummary summary = SummarizeSubsets(Outcomes(), bounds);
  EXPECT_EQ(summary.num_subsets, 7u);
  EXPECT_EQ(summary.num_complete, 4u);
  EXPECT_EQ(summary.num_accurate_mean, 2u);
  EXPECT_EQ(summary.num_accurate, 1u);
  EXPECT_EQ(summary.num_flagged, 1u);
  EXPECT_EQ(summary.num_flagged_failures, 1u);
  // A view that is missing does not excuse one that is wrong.
  EXPECT_EQ(summary.num_silent_failures, 2u);
  EXPECT_DOUBLE_EQ(summary.median_max_error, 0.7);
  EXPECT_EQ(summary.num_good_cameras, 3u);
  EXPECT_EQ(summary.num_good_doubted, 1u);
  EXPECT_EQ(summary.num_wrong_cameras, 2u);
  EXPECT_EQ(summary.num_wrong_firm, 1u);
  EXPECT_THAT(WrongFirmViews(Outcomes()[3], bounds), ElementsAre(4));
  EXPECT_TRUE(WrongFirmViews(Outcomes()[1], bounds).empty());
  EXPECT_THAT(ToText(summary, bounds), HasSubstr("silent failures: 2"));
  EXPECT_THAT(ToText(summary, bounds), HasSubstr("doubted: 1 of 3 (33.3 %)"));
  EXPECT_THAT(ToText(summary, bounds),
              HasSubstr("beyond 0.5: 2, named in no warning: 1"));
  EXPECT_THAT(ToJson(summary, bounds), HasSubstr("\"silent_failures\": 2"));
  const auto plot = DrawSubsets(Outcomes());
  ASSERT_TRUE(plot);
  EXPECT_THAT(*plot, HasSubstr("<svg"));
  EXPECT_TRUE(DrawSubsets({}));
  EXPECT_FALSE((SubsetBounds{0.5, 0.1}).Validate());
  // There is no median of nothing.
  const SubsetSummary none = SummarizeSubsets({}, bounds);
  EXPECT_THAT(ToText(none, bounds),
              HasSubstr("mean errors -, of the largest errors -"));
  EXPECT_THAT(ToJson(none, bounds), HasSubstr("\"median_max_error\": null"));
}

class RunSubsetsTest : public ::testing::Test {
 protected:
  RunSubsetsTest() {
    SyntheticOptions options;
    options.num_views = 7;
    options.pairs = "window:3";
    options.noise_px = 0.3;
    const SyntheticScene made = *Simulate(options);
    scene_ = made.scene;
    truth_ = made.true_poses;
    options_.adjust = false;
  }

  Result<std::map<std::vector<ViewId>, SubsetOutcome>> Run(
      const std::vector<std::vector<ViewId>>& dropped, int threads) const {
    std::map<std::vector<ViewId>, SubsetOutcome> outcomes;
    RunContext context;
    context.num_threads = threads;
    const Status status = RunSubsets(
        scene_, truth_, dropped, options_, context,
        [&](const SubsetOutcome& outcome) -> Status {
          EXPECT_TRUE(outcomes.emplace(outcome.dropped, outcome).second);
          return {};
        });
    if (!status) return tl::unexpected<Error>(status.error());
    return outcomes;
  }

  Scene scene_;
  GroundTruth truth_;
  SolveOptions options_;
};

TEST_F(RunSubsetsTest, ReusedRatiosGiveWhatSolvingEachSubsetGives) {
  const std::vector<std::vector<ViewId>> dropped = {{0}, {2, 5}, {3}};
  const auto outcomes = Run(dropped, 1);
  ASSERT_TRUE(outcomes) << outcomes.error().ToString();
  ASSERT_EQ(outcomes->size(), 3u);
  for (const std::vector<ViewId>& views : dropped) {
    Scene subset = WithoutViews(scene_, views);
    StageLog stages;
    RunContext context;
    const auto solved = SolveScene(&subset, options_, context, &stages);
    ASSERT_TRUE(solved) << solved.error().ToString();
    const SubsetOutcome& outcome = outcomes->at(views);
    EXPECT_EQ(outcome.num_views, 7 - static_cast<int>(views.size()));
    EXPECT_EQ(outcome.num_placed, solved->poses.num_placed);
    const PoseEvaluation evaluation = EvaluatePoses(subset, truth_);
    EXPECT_EQ(outcome.mean_error, evaluation.position.mean);
    EXPECT_EQ(outcome.max_error, evaluation.position.max);
    EXPECT_LT(outcome.max_error, 0.05);
    EXPECT_TRUE(outcome.failure.empty());
    EXPECT_EQ(outcome.firm_errors.size() + outcome.doubtful_errors.size(),
              static_cast<std::size_t>(outcome.num_placed));
    for (const auto& [view, graded] : GradeViews(solved->poses)) {
      EXPECT_EQ(outcome.firm_errors.count(view) > 0,
                graded.grade == ViewGrade::kFirm);
    }
    for (const auto& [view, error] : outcome.firm_errors) {
      EXPECT_LT(error, 0.1) << view;
    }
  }
}

TEST_F(RunSubsetsTest, ThreadsDoNotChangeIt) {
  const auto subsets = ChooseSubsets(scene_, 2, 6, 3);
  ASSERT_TRUE(subsets);
  const auto one = Run(*subsets, 1), two = Run(*subsets, 2);
  ASSERT_TRUE(one && two);
  for (auto [views, outcome] : *one) {
    SubsetOutcome other = two->at(views);
    outcome.seconds = other.seconds = 0;
    EXPECT_EQ(ToJsonLine(outcome), ToJsonLine(other));
  }
}

TEST_F(RunSubsetsTest, WhatCannotBeSolvedIsAnOutcome) {
  for (ViewId view = 1; view < 7; ++view)
    scene_.relative_poses.erase({0, view});
  for (ViewId view = 2; view < 7; ++view)
    scene_.relative_poses.erase({1, view});
  const auto outcomes = Run({{2, 3, 4}}, 1);
  ASSERT_TRUE(outcomes);
  const SubsetOutcome& outcome = outcomes->at({2, 3, 4});
  EXPECT_EQ(outcome.num_views, 4);
  EXPECT_LT(outcome.num_placed, 4);
}

TEST_F(RunSubsetsTest, AnErrorOfTheCallerEndsTheRun) {
  int calls = 0;
  RunContext context;
  context.num_threads = 1;
  const Status status =
      RunSubsets(scene_, truth_, *ChooseSubsets(scene_, 1, 0, 0), options_,
                 context, [&](const SubsetOutcome&) -> Status {
                   ++calls;
                   return MakeError(ErrorCode::kIo, "the disk is full");
                 });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace lowlap
