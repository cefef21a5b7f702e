#include "lowlap/pipeline/internal/output/run_report.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/internal/output/summary_json.h"
#include "lowlap/report/internal/page_data.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::VectorNear;

// A simulated room, solved, and what a command would say of it.
class MakeReportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    SyntheticOptions options;
    options.num_views = 6;
    options.pairs = "window:2";
    const auto simulated = Simulate(options);
    ASSERT_THAT(simulated, IsOk());
    scene_ = simulated->scene;
    SolveOptions solve;
    auto solved = SolveScene(&scene_, solve, {}, nullptr);
    ASSERT_THAT(solved, IsOk());
    summary_.command = "solve";
    summary_.truth = GroundTruthFromScene(TrueSolution(*simulated));
    summary_.evaluation = EvaluatePoses(scene_, *summary_.truth);
    summary_.kinds = solve.scale_estimator->kinds();
    summary_.solve = std::move(*solved);
  }

  Scene scene_;
  RunSummary summary_;
};

TEST_F(MakeReportTest, TheSummaryHasTheDeviationOfEveryCentre) {
  const auto summary = nlohmann::json::parse(ToJson(summary_, scene_));
  const auto& grades = summary["solve"]["poses"]["grades"];
  ASSERT_EQ(grades.size(), scene_.views.size());
  for (const auto& graded : grades) {
    const double stddev = graded["center_stddev"];
    const Pose& pose = *scene_.FindPose(graded["view"].get<std::uint32_t>());
    const double trace = pose.center_covariance->trace();
    EXPECT_LE(stddev * stddev, trace * (1 + 1e-12));
    EXPECT_GE(stddev * stddev, trace / 3);
  }
}

TEST_F(MakeReportTest, TheSummaryIsOfWhatWasDone) {
  summary_.solve->adjustment->coplanar.observations_surplus = 7;
  summary_.solve->adjustment->lines = {};
  auto solve = nlohmann::json::parse(ToJson(summary_, scene_))["solve"];
  const auto& adjustment = solve["adjustment"];
  EXPECT_EQ(adjustment["coplanar"]["observations_surplus"], 7);
  EXPECT_TRUE(adjustment["points"]["final_rmse_px"].is_number());
  EXPECT_TRUE(adjustment["lines"]["final_rmse_px"].is_null());
  EXPECT_TRUE(adjustment["lines"]["initial_rmse_px"].is_null());
  EXPECT_TRUE(solve["poses"].contains("doubtful"));
  EXPECT_TRUE(solve.contains("structure"));

  summary_.has_given_poses = true;
  summary_.solve->structure.reset();
  solve = nlohmann::json::parse(ToJson(summary_, scene_))["solve"];
  EXPECT_EQ(solve["poses"]["placed"], 6);
  for (const char* name : {"doubtful", "grades", "contests", "components",
                           "median_rotation_residual_deg"}) {
    EXPECT_FALSE(solve["poses"].contains(name)) << name;
  }
  for (const char* name :
       {"ambiguous_motions", "reconsidered_poses", "structure"}) {
    EXPECT_FALSE(solve.contains(name)) << name;
  }
}

// The figure at the top is that of the plots.
TEST_F(MakeReportTest, ThePageHasOneRmse) {
  const auto report = MakeReport(summary_, scene_, {});
  ASSERT_THAT(report, IsOk());
  const auto page = nlohmann::json::parse(PageData(scene_, *report));
  const AdjustmentSummary& adjustment = *summary_.solve->adjustment;
  EXPECT_NEAR(page["residuals"]["points"]["after"]["rmse_px"],
              *adjustment.points.final_rmse_px, 1e-6);
  EXPECT_NEAR(page["residuals"]["lines"]["after"]["rmse_px"],
              *adjustment.lines.final_rmse_px, 1e-6);
}

TEST_F(MakeReportTest, TheSummaryHasTheRatiosThatWereLeftOut) {
  summary_.solve->poses.left_out_ratios = {{0, 1, 2}};
  const auto summary = nlohmann::json::parse(ToJson(summary_, scene_));
  EXPECT_EQ(summary["solve"]["poses"]["left_out_ratios"],
            nlohmann::json::parse("[[0, 1, 2]]"));
}

TEST_F(MakeReportTest, HasTheTruthAndTheStartInTheFrameOfTheScene) {
  const auto report = MakeReport(summary_, scene_, {});
  ASSERT_THAT(report, IsOk());
  ASSERT_TRUE(report->truth.has_value());
  for (const auto& [view, pose] : report->truth->poses) {
    EXPECT_THAT(pose.center, VectorNear(scene_.FindPose(view)->center, 0.05));
    EXPECT_LT((pose.rotation - scene_.FindPose(view)->rotation).norm(), 0.05);
    EXPECT_TRUE(report->truth->position_errors.count(view));
  }
  ASSERT_TRUE(report->before_adjustment.has_value());
  EXPECT_EQ(report->before_adjustment->poses.size(), 6u);
  EXPECT_GT(report->before_adjustment->points.size(), 50u);
  EXPECT_GT(report->before_adjustment->lines.size(), 10u);
}

TEST_F(MakeReportTest, HasEveryPairAndAProfileOfEveryRatio) {
  const ViewPair left_out = scene_.relative_poses.begin()->first;
  summary_.solve->poses.outlier_edges.push_back(
      {left_out, OutlierReason::kDirection, 3});
  const auto report = MakeReport(summary_, scene_, {});
  ASSERT_THAT(report, IsOk());
  ASSERT_EQ(report->pairs.size(), scene_.relative_poses.size());
  for (const ReportPair& pair : report->pairs) {
    EXPECT_EQ(pair.is_used, pair.views != left_out);
    EXPECT_EQ(pair.note.empty(), pair.views != left_out);
  }
  ASSERT_FALSE(scene_.scale_ratios.empty());
  for (const ScaleRatio& ratio : scene_.scale_ratios) {
    ASSERT_TRUE(report->profiles.count(ratio.views));
    const ReportProfile& profile = report->profiles.at(ratio.views);
    // It is least near the ratio, at about its NFA.
    const auto least =
        std::min_element(profile.log10_nfas.begin(), profile.log10_nfas.end());
    const auto at = least - profile.log10_nfas.begin();
    EXPECT_NEAR(profile.log_ratios[at], ratio.log_ratio, 0.05);
    EXPECT_LE(*least, 0.8 * ratio.log10_nfa);
    EXPECT_EQ(profile.kinds.front().second.size(), profile.log_ratios.size());
  }
  summary_.kinds.clear();
  EXPECT_TRUE(MakeReport(summary_, scene_, {})->profiles.empty());
}

TEST_F(MakeReportTest, TellsWhichViewsAWarningConcerns) {
  ReliabilityWarning doubt;
  doubt.reason = WarningReason::kLostFeatures;
  doubt.views = {2};
  summary_.solve->poses.reliability_warnings = {doubt};
  const auto report = MakeReport(summary_, scene_, {});
  ASSERT_THAT(report, IsOk());
  EXPECT_THAT(report->warnings,
              ::testing::Contains(::testing::Field(&ReportWarning::views,
                                                   std::vector<ViewId>{2})));
}

TEST_F(MakeReportTest, LeavesOutPhotographsThatCannotBeRead) {
  const auto folder =
      std::filesystem::temp_directory_path() /
      ("lowlap_report_photographs_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  scene_.root_path = folder.string();
  cv::imwrite(scene_.ImagePath(1), cv::Mat(60, 90, CV_8UC3, cv::Scalar(9)));
  std::ofstream(scene_.ImagePath(2)) << "no image";
  const auto report = MakeReport(summary_, scene_, {});
  std::filesystem::remove_all(folder);
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->photographs.size(), 1u);
  EXPECT_TRUE(report->photographs.count(1));
}

TEST_F(MakeReportTest, CanBeCancelled) {
  RunContext context;
  context.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  EXPECT_THAT(MakeReport(summary_, scene_, context),
              IsError(ErrorCode::kCancelled, ""));
}

}  // namespace
}  // namespace lowlap
