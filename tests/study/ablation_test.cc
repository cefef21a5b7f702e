#include "lowlap/study/internal/ablation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "lowlap/synthetic/synthetic_scene.h"
#include "read_csv.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

SyntheticScene NoisyRoom() {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "window:2";
  options.noise_px = 0.5;
  options.rotation_noise_deg = 0.1;
  options.direction_noise_deg = 0.3;
  return *Simulate(options);
}

const AblationCase& Find(const std::vector<AblationCase>& cases,
                         const std::string& name) {
  for (const AblationCase& entry : cases) {
    if (entry.name == name) return entry;
  }
  ADD_FAILURE() << name << " is missing";
  return cases.front();
}

std::vector<std::string> NamesOf(const std::vector<AblationCase>& cases) {
  std::vector<std::string> names;
  for (const AblationCase& entry : cases) names.push_back(entry.name);
  return names;
}

TEST(Ablation, HasTheCasesOfThePaper) {
  const SyntheticScene room = NoisyRoom();
  const auto ablation = Ablate(room.scene, room.true_poses, {}, RunContext());
  ASSERT_TRUE(ablation) << ablation.error().ToString();
  EXPECT_THAT(NamesOf(ablation->criteria),
              testing::ElementsAre("0.5 px", "1 px", "3 px", "6 px", "9 px",
                                   "a contrario"));
  EXPECT_THAT(NamesOf(ablation->features),
              testing::ElementsAre("points", "lines", "points + lines",
                                   "coplanar", "all", "all + adjustment"));
  EXPECT_THAT(
      NamesOf(ablation->ties),
      testing::ElementsAre("before adjustment", "none", "pairs", "planes",
                           "directions", "planes + directions"));
  for (const auto* cases :
       {&ablation->criteria, &ablation->features, &ablation->ties}) {
    for (const AblationCase& entry : *cases) {
      SCOPED_TRACE(entry.name);
      EXPECT_FALSE(entry.failure);
      EXPECT_EQ(entry.num_placed, 8);
      EXPECT_LT(entry.errors.position.mean, 0.2);
      EXPECT_GT(entry.ratios.num_meaningful, 0);
      EXPECT_GT(entry.abs_log_ratio.count, 0);
    }
  }
  // The shared cases, and what is varied in the others.
  const AblationCase& all = Find(ablation->features, "all");
  EXPECT_EQ(all.errors.position.mean,
            Find(ablation->criteria, "a contrario").errors.position.mean);
  EXPECT_NE(all.errors.position.mean,
            Find(ablation->criteria, "9 px").errors.position.mean);
  EXPECT_FALSE(Find(ablation->features, "coplanar").scale.Asks("points"));
  const AblationCase& adjusted = Find(ablation->features, "all + adjustment");
  EXPECT_TRUE(adjusted.adjusted);
  EXPECT_LT(adjusted.errors.position.mean, all.errors.position.mean);
  EXPECT_EQ(Find(ablation->ties, "before adjustment").errors.position.mean,
            all.errors.position.mean);
  EXPECT_EQ(Find(ablation->ties, "planes + directions").errors.position.mean,
            adjusted.errors.position.mean);
}

TEST(Ablation, AdjustmentsAreHeldByWhatTheyName) {
  const SyntheticScene room = NoisyRoom();
  AblationOptions options;
  options.thresholds_px = {};
  // Every case sets its own ties.
  options.solve.adjustment.use_directions = false;
  options.solve.adjustment.coplanar_ties = CoplanarTies::kPairs;
  const auto ablation =
      Ablate(room.scene, room.true_poses, options, RunContext());
  ASSERT_TRUE(ablation) << ablation.error().ToString();
  struct Held {
    bool pairs, planes, directions;
  };
  const std::map<std::string, Held> expected = {
      {"none", {false, false, false}},
      {"pairs", {true, false, false}},
      {"planes", {false, true, false}},
      {"directions", {false, false, true}},
      {"planes + directions", {false, true, true}}};
  std::set<double> errors;
  for (const auto& [name, held] : expected) {
    SCOPED_TRACE(name);
    const AblationCase& entry = Find(ablation->ties, name);
    EXPECT_TRUE(entry.adjusted);
    EXPECT_EQ(entry.adjustment.coplanar.observations_used > 0, held.pairs);
    EXPECT_EQ(entry.adjustment.planes > 0, held.planes);
    EXPECT_EQ(entry.adjustment.directions > 0, held.directions);
    errors.insert(entry.errors.position.mean);
  }
  EXPECT_EQ(errors.size(), expected.size());
}

// Ratios, poses and structure that the cases share are those of a solution.
TEST(Ablation, AdjustmentsAreThoseOfTheWholeSolution) {
  const SyntheticScene room = NoisyRoom();
  AblationOptions options;
  options.thresholds_px = {};
  const auto ablation =
      Ablate(room.scene, room.true_poses, options, RunContext());
  ASSERT_TRUE(ablation) << ablation.error().ToString();
  const auto error_of_solution = [&](const SolveOptions& solve) {
    Scene scene = room.scene;
    StageLog stages;
    EXPECT_TRUE(SolveScene(&scene, solve, RunContext(), &stages));
    return EvaluatePoses(scene, room.true_poses).position.mean;
  };
  SolveOptions solve;
  EXPECT_NEAR(Find(ablation->ties, "planes + directions").errors.position.mean,
              error_of_solution(solve), 1e-9);
  solve.adjustment.coplanar_ties = CoplanarTies::kPairs;
  EXPECT_NEAR(Find(ablation->ties, "pairs").errors.position.mean,
              error_of_solution(solve), 1e-9);
}

// Kinds that see nothing are cases without a solution, not errors.
TEST(Ablation, KindsWithoutFeaturesSayThatNothingIsPlaced) {
  SyntheticOptions simulation;
  simulation.num_views = 6;
  simulation.pairs = "chain";
  simulation.trifocal_point_share = simulation.trifocal_line_share = 0;
  const SyntheticScene chain = *Simulate(simulation);
  AblationOptions options;
  options.thresholds_px = {3};
  const auto ablation =
      Ablate(chain.scene, chain.true_poses, options, RunContext());
  ASSERT_TRUE(ablation) << ablation.error().ToString();
  EXPECT_EQ(ablation->criteria.size(), 2u);
  EXPECT_EQ(Find(ablation->features, "coplanar").num_placed, 6);
  EXPECT_LT(Find(ablation->features, "all + adjustment").errors.position.max,
            1e-3);
  const AblationCase& points = Find(ablation->features, "points");
  EXPECT_EQ(points.ratios.num_meaningful, 0);
  EXPECT_LE(points.num_placed, 2);
  EXPECT_THAT(ToText(*ablation), HasSubstr("0/4"));
}

TEST(Ablation, TablesHoldEveryCase) {
  const SyntheticScene room = NoisyRoom();
  AblationOptions options;
  options.thresholds_px = {2.5};
  const auto ablation =
      Ablate(room.scene, room.true_poses, options, RunContext());
  ASSERT_TRUE(ablation) << ablation.error().ToString();
  const auto records = ReadCsv(ToCsv(*ablation));
  ASSERT_EQ(records.size(), 2u + 6u + 6u);
  EXPECT_EQ(records[0].at("case"), "2.5 px");
  EXPECT_EQ(records[0].at("criterion"), "fixed threshold");
  EXPECT_EQ(records[0].at("threshold_px"), "2.5");
  EXPECT_EQ(records[1].at("threshold_px"), "");
  EXPECT_EQ(records[4].at("features"), "points+lines");
  EXPECT_EQ(records[7].at("adjusted"), "yes");
  EXPECT_NEAR(std::atof(records[2].at("position_error_mean").c_str()),
              ablation->features[0].errors.position.mean, 1e-8);
  EXPECT_EQ(records[8].at("table"), "ties");
  EXPECT_EQ(records[8].at("adjusted"), "no");
  EXPECT_EQ(records[8].at("planes"), "");
  EXPECT_EQ(records[10].at("case"), "pairs");
  EXPECT_EQ(records[10].at("planes"), "0");
  EXPECT_EQ(
      records[10].at("coplanar_pairs"),
      std::to_string(ablation->ties[2].adjustment.coplanar.observations_used));
  const auto json = nlohmann::json::parse(ToJson(*ablation));
  EXPECT_EQ(json.at("criteria").size(), 2u);
  EXPECT_EQ(json.at("features").at(5).at("case"), "all + adjustment");
  EXPECT_FALSE(json.at("ties").at(0).contains("held_by"));
  EXPECT_EQ(json.at("ties").at(4).at("held_by").at("directions"),
            ablation->ties[4].adjustment.directions);
  const std::string text = ToText(*ablation);
  for (const char* part :
       {"2.5 px", "a contrario", "points + lines", "mean position error",
        "cameras placed", "8/8", "planes + directions"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(Ablation, OptionsAndTruthAreChecked) {
  const SyntheticScene room = NoisyRoom();
  AblationOptions options;
  options.thresholds_px = {1, 0};
  auto ablation = Ablate(room.scene, room.true_poses, options, RunContext());
  ASSERT_FALSE(ablation);
  EXPECT_EQ(ablation.error().code, ErrorCode::kInvalidArgument);
  options = {};
  options.solve.adjustment.principal_point_stddev = 1e-3;
  ablation = Ablate(room.scene, room.true_poses, options, RunContext());
  ASSERT_FALSE(ablation);
  EXPECT_THAT(ablation.error().message, HasSubstr("intrinsics must be held"));
  GroundTruth two = room.true_poses;
  while (two.size() > 2) two.erase(two.begin());
  ablation = Ablate(room.scene, two, {}, RunContext());
  ASSERT_FALSE(ablation);
  EXPECT_EQ(ablation.error().code, ErrorCode::kInsufficientData);
}

TEST(Ablation, ErrorsOfNoRatioAreAbsentNotZero) {
  Ablation ablation;
  ablation.features.resize(2);
  ablation.features[1].abs_log_ratio.count = 1;
  const auto json = nlohmann::json::parse(ToJson(ablation));
  EXPECT_FALSE(json["features"][0]["ratios"].contains("abs_log_error_median"));
  EXPECT_TRUE(json["features"][1]["ratios"].contains("abs_log_error_median"));
}

TEST(Ablation, FilesAreWrittenOrTheFolderIsNamed) {
  const fs::path folder = fs::temp_directory_path() /
                          ("lowlap_ablate_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  Ablation ablation;
  ablation.criteria.resize(1);
  ablation.features.resize(1);
  ablation.ties.resize(1);
  ASSERT_TRUE(WriteAblation(ablation, folder.string()));
  for (const char* name : {"ablate.csv", "ablate.json", "criteria.svg",
                           "features.svg", "ties.svg"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  std::ofstream(folder / "file") << "in the way";
  const Status refused = WriteAblation(ablation, (folder / "file").string());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace lowlap
