#include "lowlap/study/compare_strategies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lowlap/averaging/averager_registry.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "read_csv.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// Every three neighbours share points and lines, and three relative poses: the
// directions alone fix one scale.
SyntheticScene RichRoom() {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "window:2";
  options.noise_px = 0.5;
  options.rotation_noise_deg = 0.05;
  options.direction_noise_deg = 0.1;
  return *Simulate(options);
}

// No three views share anything: coplanar lines alone carry the scale.
SyntheticScene TrifocalFreeChain(int num_views) {
  SyntheticOptions options;
  options.num_views = num_views;
  options.pairs = "chain";
  options.trifocal_point_share = 0;
  options.trifocal_line_share = 0;
  options.noise_px = 0.3;
  return *Simulate(options);
}

CompareOptions WithTruth(const SyntheticScene& synthetic) {
  CompareOptions options;
  options.truth = synthetic.true_poses;
  return options;
}

const StrategyResult& Find(const Comparison& comparison,
                           const std::string& strategy) {
  for (const StrategyResult& result : comparison.results) {
    if (result.strategy == strategy) return result;
  }
  ADD_FAILURE() << strategy << " is missing";
  return comparison.results.front();
}

TEST(CompareStrategies, EveryStrategySolvesARichScene) {
  const SyntheticScene room = RichRoom();
  CompareOptions options = WithTruth(room);
  options.strategies = {"all", "1dsfm+lud"};
  options.solve.adjust = false;
  const auto comparison = CompareStrategies(room.scene, options, RunContext());
  ASSERT_TRUE(comparison) << comparison.error().ToString();
  std::vector<std::string> names = AveragerRegistry::WithBuiltIns().Names();
  names.push_back("1dsfm+lud");
  ASSERT_EQ(comparison->results.size(), names.size());
  EXPECT_EQ(comparison->reference, "graph");
  EXPECT_GT(comparison->num_ratios, 0);
  for (std::size_t n = 0; n < names.size(); ++n) {
    const StrategyResult& result = comparison->results[n];
    SCOPED_TRACE(names[n]);
    EXPECT_EQ(result.strategy, names[n]);
    EXPECT_FALSE(result.failure);
    EXPECT_EQ(result.num_placed, 8);
    EXPECT_EQ(result.num_components, 1);
    EXPECT_EQ(result.limit, "");
    EXPECT_FALSE(result.after);
    ASSERT_TRUE(result.before.errors);
    EXPECT_EQ(result.before.errors->position.count, 8);
    EXPECT_GT(result.before.consistency.num_points, 0u);
    EXPECT_EQ(result.before.difference.has_value(), names[n] != "graph");
    ASSERT_FALSE(result.costs.empty());
    EXPECT_EQ(result.costs.front().name, "averaging");
  }
  EXPECT_LT(Find(*comparison, "graph").before.errors->position.mean, 0.05);
  EXPECT_LT(Find(*comparison, "lud").before.errors->position.mean, 0.2);
}

TEST(CompareStrategies, AdjustmentBringsDifferentStartsTogether) {
  const SyntheticScene room = RichRoom();
  CompareOptions options = WithTruth(room);
  options.strategies = {"graph", "chain"};
  const auto comparison = CompareStrategies(room.scene, options, RunContext());
  ASSERT_TRUE(comparison) << comparison.error().ToString();
  for (const StrategyResult& result : comparison->results) {
    ASSERT_TRUE(result.after) << result.strategy;
    EXPECT_LT(result.after->errors->position.mean,
              result.before.errors->position.mean);
    EXPECT_GT(result.num_adjustment_iterations, 0);
  }
  const StrategyResult& chain = Find(*comparison, "chain");
  ASSERT_TRUE(chain.before.difference && chain.after->difference);
  EXPECT_LT(chain.after->difference->mean, 0.1 * chain.before.difference->mean);
}

TEST(CompareStrategies, OnAChainOnlyRatiosPlaceCameras) {
  const SyntheticScene chain = TrifocalFreeChain(10);
  CompareOptions options = WithTruth(chain);
  options.solve.adjust = false;
  const auto comparison = CompareStrategies(chain.scene, options, RunContext());
  ASSERT_TRUE(comparison) << comparison.error().ToString();
  for (const StrategyResult& result : comparison->results) {
    SCOPED_TRACE(result.strategy);
    EXPECT_FALSE(result.failure);
    if (result.strategy == "graph" || result.strategy == "chain") {
      EXPECT_EQ(result.num_placed, 10);
      EXPECT_EQ(result.limit, "");
      EXPECT_LT(result.before.errors->position.max, 0.2);
    } else {
      EXPECT_LE(result.num_placed, 2);
      EXPECT_EQ(result.num_placed + static_cast<int>(result.unplaced.size()),
                10);
      EXPECT_THAT(result.limit, HasSubstr("of 10 cameras"));
      EXPECT_THAT(result.limit, HasSubstr("A view needs "));
    }
  }
  const std::string text = ToText(*comparison);
  // What stops several strategies is said once.
  EXPECT_THAT(text, HasSubstr("lud, revised_lud, bata, revised_bata: places "
                              "none of 10 cameras. A view needs directions"));
  EXPECT_THAT(text, Not(HasSubstr("graph: ")));
}

TEST(CompareStrategies, WithoutTruthTheReferenceIsWhatIsComparedWith) {
  const SyntheticScene room = RichRoom();
  CompareOptions options;
  options.strategies = {"chain", "graph"};
  options.reference = "chain";
  options.solve.adjust = false;
  const auto comparison = CompareStrategies(room.scene, options, RunContext());
  ASSERT_TRUE(comparison) << comparison.error().ToString();
  EXPECT_EQ(comparison->reference, "chain");
  EXPECT_FALSE(Find(*comparison, "chain").before.difference);
  const StrategyResult& graph = Find(*comparison, "graph");
  EXPECT_FALSE(graph.before.errors);
  ASSERT_TRUE(graph.before.difference);
  EXPECT_GT(graph.before.difference->mean, 0);
  EXPECT_LT(graph.before.difference->mean, 0.1);
  EXPECT_THAT(ToText(*comparison), HasSubstr("difference before"));
  const auto plots = DrawComparison(*comparison);
  ASSERT_TRUE(plots);
  EXPECT_EQ(plots->front().first, "difference.svg");
}

// What does not take part cannot be the reference; then the first that places
// cameras is.
TEST(CompareStrategies, TheReferenceIsOneThatPlacesCameras) {
  const SyntheticScene chain = TrifocalFreeChain(5);
  CompareOptions options;
  options.strategies = {"lud", "chain"};
  options.solve.adjust = false;
  const auto comparison = CompareStrategies(chain.scene, options, RunContext());
  ASSERT_TRUE(comparison) << comparison.error().ToString();
  EXPECT_EQ(comparison->reference, "chain");
}

TEST(CompareStrategies, RepeatedNamesCountOnce) {
  const SyntheticScene chain = TrifocalFreeChain(4);
  CompareOptions options;
  options.strategies = {"chain", "all", "chain"};
  options.solve.adjust = false;
  const auto comparison = CompareStrategies(chain.scene, options, RunContext());
  ASSERT_TRUE(comparison);
  EXPECT_EQ(comparison->results.size(),
            AveragerRegistry::WithBuiltIns().Names().size());
  EXPECT_EQ(comparison->results.front().strategy, "chain");
}

TEST(CompareStrategies, UnknownStrategiesAreRefusedBeforeAnyWork) {
  CompareOptions options;
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"graph", "guess"},
        std::vector<std::string>{"1dsfm+guess"}, std::vector<std::string>{""},
        std::vector<std::string>{}}) {
    options.strategies = names;
    // The empty scene would be an error of its own.
    const auto comparison = CompareStrategies(Scene(), options, RunContext());
    ASSERT_FALSE(comparison);
    EXPECT_EQ(comparison.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(comparison.error().message, HasSubstr("strategy"));
    EXPECT_FALSE(options.Validate());
  }
  options = CompareOptions();
  options.reference = "guess";
  const auto refused = CompareStrategies(Scene(), options, RunContext());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("unknown strategy 'guess'"));
}

TEST(CompareStrategies, CancellingStopsTheRun) {
  const SyntheticScene chain = TrifocalFreeChain(4);
  RunContext context;
  context.progress = [](const std::string& stage, std::size_t done,
                        std::size_t) {
    return stage != "strategies" || done < 1;
  };
  const auto comparison =
      CompareStrategies(chain.scene, CompareOptions(), context);
  ASSERT_FALSE(comparison);
  EXPECT_EQ(comparison.error().code, ErrorCode::kCancelled);
}

// Cells of times, which differ from run to run.
std::string WithoutTimes(const std::string& csv) {
  std::string rest;
  for (const auto& record : ReadCsv(csv)) {
    for (const auto& [column, cell] : record) {
      if (column.size() > 2 && column.substr(column.size() - 2) == "_s") {
        continue;
      }
      rest += column + "=" + cell + "\n";
    }
  }
  return rest;
}

TEST(ComparisonOutput, CsvHoldsOneRecordPerStrategy) {
  const SyntheticScene chain = TrifocalFreeChain(5);
  CompareOptions options = WithTruth(chain);
  options.strategies = {"graph", "lud"};
  options.solve.adjust = false;
  const auto comparison = CompareStrategies(chain.scene, options, RunContext());
  ASSERT_TRUE(comparison) << comparison.error().ToString();
  const auto records = ReadCsv(ToCsv(*comparison));
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].at("strategy"), "graph");
  EXPECT_EQ(records[0].at("status"), "all placed");
  EXPECT_EQ(records[0].at("placed"), "5");
  EXPECT_EQ(records[0].at("reason"), "");
  EXPECT_NEAR(std::atof(records[0].at("before_position_error_mean").c_str()),
              comparison->results[0].before.errors->position.mean, 1e-8);
  EXPECT_EQ(records[0].at("after_position_error_mean"), "");
  EXPECT_NE(records[0].at("averaging_wall_s"), "");
  EXPECT_EQ(records[1].at("status"), "none placed");
  EXPECT_EQ(records[1].at("reason"), comparison->results[1].limit);
  EXPECT_EQ(records[1].at("before_position_error_mean"), "");
}

TEST(ComparisonOutput, FailuresAreRowsWithTheirMessage) {
  Comparison comparison;
  comparison.num_views = 3;
  comparison.results.resize(2);
  comparison.results[0].strategy = "graph";
  comparison.results[1].strategy = "broken";
  comparison.results[1].failure =
      Error{ErrorCode::kNumerical, "no step, \"at all\"", {}, {}};
  const auto records = ReadCsv(ToCsv(comparison));
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[1].at("status"), "failed");
  EXPECT_EQ(records[1].at("reason"), "Failed: no step, \"at all\".");
  EXPECT_THAT(ToText(comparison),
              HasSubstr("broken: Failed: no step, \"at all\"."));
  const auto json = nlohmann::json::parse(ToJson(comparison, Scene()));
  EXPECT_EQ(json.at("strategies").at(1).at("status"), "failed");
  EXPECT_TRUE(DrawComparison(comparison));
}

TEST(ComparisonOutput, WithoutAReferenceNoneIsNamed) {
  Comparison comparison;
  comparison.results.resize(1);
  comparison.results.front().strategy = "lud";
  EXPECT_THAT(ToText(comparison), HasSubstr("no strategy places any camera"));
  EXPECT_THAT(ToText(comparison), Not(HasSubstr("''")));
}

TEST(ComparisonOutput, ThreadsChangeNothingButTimes) {
  const SyntheticScene room = RichRoom();
  CompareOptions options = WithTruth(room);
  options.solve.adjust = false;
  std::vector<std::string> outputs;
  for (const int num_threads : {1, 3}) {
    RunContext context;
    context.num_threads = num_threads;
    const auto comparison = CompareStrategies(room.scene, options, context);
    ASSERT_TRUE(comparison);
    auto json = nlohmann::json::parse(ToJson(*comparison, room.scene));
    json.erase("cost");
    for (auto& entry : json["strategies"]) entry.erase("cost");
    outputs.push_back(WithoutTimes(ToCsv(*comparison)) + json.dump());
    const auto plots = DrawComparison(*comparison);
    ASSERT_TRUE(plots);
    for (const auto& [name, svg] : *plots) {
      if (name != "time.svg") outputs.back() += svg;
    }
  }
  EXPECT_EQ(outputs[0], outputs[1]);
}

TEST(ComparisonOutput, FilesAreWrittenOrTheFolderIsNamed) {
  const fs::path folder = fs::temp_directory_path() /
                          ("lowlap_compare_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  Comparison comparison;
  comparison.num_views = 3;
  comparison.has_truth = true;
  comparison.results.resize(1);
  comparison.results[0].strategy = "graph";
  const Status written =
      WriteComparison(comparison, Scene(), (folder / "new").string());
  ASSERT_TRUE(written) << written.error().ToString();
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "new")) {
    names.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(names,
              testing::UnorderedElementsAre(
                  "compare.csv", "compare.json", "position_error.svg",
                  "cameras_placed.svg", "direction_error.svg", "time.svg"));
  // A plot of the run before does not stay beside tables that it is not of.
  comparison.has_truth = false;
  std::ofstream(folder / "new" / "my_position_error.svg") << "mine";
  ASSERT_TRUE(WriteComparison(comparison, Scene(), (folder / "new").string()));
  EXPECT_TRUE(fs::exists(folder / "new" / "difference.svg"));
  EXPECT_FALSE(fs::exists(folder / "new" / "position_error.svg"));
  EXPECT_TRUE(fs::exists(folder / "new" / "my_position_error.svg"));
  // What has the name of a plot and is no file is none of ours.
  fs::create_directory(folder / "new" / "position_error.svg");
  ASSERT_TRUE(WriteComparison(comparison, Scene(), (folder / "new").string()));
  EXPECT_TRUE(fs::exists(folder / "new" / "position_error.svg"));
  std::ofstream(folder / "file") << "in the way";
  const Status refused =
      WriteComparison(comparison, Scene(), (folder / "file").string());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  EXPECT_EQ(refused.error().file, (folder / "file").string());
  fs::remove_all(folder);
}

}  // namespace
}  // namespace lowlap
