// What joins parts of castle-P19 once eight of its photographs are missing, on
// the measurements that come with the sources.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"
#include "support/data_folder.h"
#include "support/matchers.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;

PoseSummary SolveWithout(const std::vector<ViewId>& views) {
  const auto measured =
      ReadScene(SourceFolder() + "/sfm_data/samples/castle-p19/scene.lowlap");
  EXPECT_THAT(measured, testing::IsOk());
  Scene scene = WithoutViews(*measured, views);
  SolveOptions options;
  options.adjust = false;
  const auto solved = SolveScene(&scene, options, RunContext(), nullptr);
  EXPECT_THAT(solved, testing::IsOk());
  EXPECT_EQ(solved->poses.num_placed, 11);
  return solved->poses;
}

// Five of the eleven may be 2.8 times too near to one another: what tells the
// scale across 3 is weak, and false.
TEST(CastleContests, TheScaleAcrossOneCamera) {
  const auto grades = GradeViews(SolveWithout({0, 1, 2, 4, 8, 9, 11, 12}));
  for (const ViewId view : {5u, 6u, 7u, 10u}) {
    EXPECT_THAT(grades.at(view).reasons, Contains("weak_scale")) << view;
  }
}

// A false relative pose, 4-16, wins against four that are right, until third
// views are asked. What it held hangs on the one that is right to a degree.
TEST(CastleContests, OneLinkAgainstFour) {
  const PoseSummary poses = SolveWithout({0, 1, 2, 5, 11, 12, 17, 18});
  EXPECT_THAT(
      poses.outlier_edges,
      Contains(AllOf(Field(&OutlierEdge::views, ViewPair{4, 16}),
                     Field(&OutlierEdge::reason, OutlierReason::kOutweighed))));
  const auto grades = GradeViews(poses);
  for (const ViewId view : {13u, 14u, 15u, 16u}) {
    EXPECT_THAT(grades.at(view).reasons, Contains("contested_link")) << view;
  }
}

}  // namespace
}  // namespace lowlap
