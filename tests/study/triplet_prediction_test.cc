// What averaging over triplets makes of castle-P19 without three of its images,
// with OpenMVG's own matches.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/relative_poses.h"
#include "lowlap/study/internal/subset_runs.h"
#include "support/data_folder.h"
#include "third_party_adapters/openmvg/internal/import.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;

class CastleTriplets : public ::testing::Test {
 protected:
  void SetUp() override {
    if (DataFolder().empty()) GTEST_SKIP() << "skipped: no data";
    const std::string folder = DataFolder() + "/openmvg/castle-P19/matches";
    auto project =
        openmvg::ImportProject(folder + "/sfm_data.json", folder, {});
    ASSERT_TRUE(project) << project.error().ToString();
    std::map<ViewPair, PairMatches> matches;
    for (auto& [views, points] : project->matches) {
      matches[views].points = std::move(points);
    }
    castle_ = std::move(project->scene);
    const auto pairs = EstimateRelativePoses(&castle_, matches, nullptr,
                                             RelativePoseOptions(), {});
    ASSERT_TRUE(pairs) << pairs.error().ToString();
    // Only the graph and its tracks count from here on.
    castle_.features.clear();
    for (auto& entry : castle_.relative_poses) {
      entry.second.point_inliers.clear();
    }
  }

  TripletPrediction Without(const std::vector<std::string>& names) const {
    return PredictTripletAveraging(
        WithoutViews(castle_, *FindViews(castle_, names)));
  }

  Scene castle_;
};

// OpenMVG returns these as successes, with cameras off by 0.5 to 17 m.
TEST_F(CastleTriplets, ItsSilentFailuresAreGlued) {
  const TripletPrediction triple = Without({"0003", "0009", "0014"});
  EXPECT_TRUE(triple.lost.empty());
  ASSERT_EQ(triple.groups.size(), 2u);
  EXPECT_THAT(triple.groups[1].views, ElementsAre(10, 11, 12));
  ASSERT_EQ(triple.articulation_views.size(), 1u);
  EXPECT_EQ(triple.articulation_views[0].view, 10u);
}

TEST_F(CastleTriplets, WhatItLosesOrSolvesIsNotGlued) {
  EXPECT_FALSE(Without({}).IsGlued());
  EXPECT_TRUE(Without({}).lost.empty());
  const TripletPrediction lost = Without({"0007", "0009", "0017"});
  EXPECT_EQ(lost.lost.size(), 7u);  // OpenMVG places 9 of 16
}

// The counts of an independent null-space test of its triplet equations.
TEST_F(CastleTriplets, AllWaysToDropThree) {
  const auto subsets = ChooseSubsets(castle_, 3, 0, 0);
  ASSERT_TRUE(subsets);
  int complete_rigid = 0, complete_glued = 0, lost_rigid = 0, lost_glued = 0;
  for (const std::vector<ViewId>& dropped : *subsets) {
    const TripletPrediction prediction =
        PredictTripletAveraging(WithoutViews(castle_, dropped));
    if (prediction.lost.empty()) {
      ++(prediction.IsGlued() ? complete_glued : complete_rigid);
    } else {
      ++(prediction.IsGlued() ? lost_glued : lost_rigid);
    }
  }
  EXPECT_EQ(complete_rigid, 196);
  EXPECT_EQ(complete_glued, 198);
  EXPECT_EQ(lost_rigid, 481);
  EXPECT_EQ(lost_glued, 94);
}

}  // namespace
}  // namespace lowlap
