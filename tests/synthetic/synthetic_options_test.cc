#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

TEST(SyntheticOptions, DefaultsAreValid) {
  EXPECT_THAT(SyntheticOptions().Validate(), IsOk());
}

TEST(SyntheticOptions, EveryBadValueIsNamed) {
  const auto expect_named = [](const std::string& name, auto change) {
    SyntheticOptions options;
    change(&options);
    EXPECT_THAT(options.Validate(), IsError(ErrorCode::kInvalidArgument, name));
    EXPECT_FALSE(Simulate(options).has_value()) << name;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Options = SyntheticOptions;
  expect_named("num_views", [](Options* o) { o->num_views = 1; });
  expect_named("points_per_wall", [](Options* o) { o->points_per_wall = -1; });
  expect_named("lines_per_wall", [](Options* o) { o->lines_per_wall = -1; });
  expect_named("trifocal_point_share",
               [](Options* o) { o->trifocal_point_share = 1.1; });
  expect_named("trifocal_line_share",
               [](Options* o) { o->trifocal_line_share = -0.1; });
  expect_named("broken_line_share",
               [=](Options* o) { o->broken_line_share = nan; });
  expect_named("wrong_point_share",
               [](Options* o) { o->wrong_point_share = 2; });
  expect_named("wrong_line_share", [](Options* o) { o->wrong_line_share = 2; });
  expect_named("wrong_candidate_share",
               [](Options* o) { o->wrong_candidate_share = 40; });
  expect_named("noise_px", [=](Options* o) { o->noise_px = nan; });
  expect_named("rotation_noise_deg",
               [](Options* o) { o->rotation_noise_deg = -1; });
  expect_named("direction_noise_deg", [](Options* o) {
    o->direction_noise_deg = std::numeric_limits<double>::infinity();
  });
  expect_named("pose_noise_factor",
               [](Options* o) { o->pose_noise_factor = -1; });
  expect_named("wrong_pose_share",
               [](Options* o) { o->wrong_pose_share = -0.1; });
  expect_named("wrong_direction_share",
               [](Options* o) { o->wrong_direction_share = 1.1; });
  expect_named("off_line_m", [=](Options* o) { o->off_line_m = nan; });
  expect_named("twin_baseline_m",
               [](Options* o) { o->twin_baseline_m = -0.1; });
  expect_named("wall_bulge_m", [](Options* o) { o->wall_bulge_m = -0.1; });
  expect_named("section_m", [](Options* o) { o->section_m = 0; });
  expect_named("section_m", [=](Options* o) { o->section_m = nan; });
  expect_named("box_offset_m", [=](Options* o) { o->box_offset_m = nan; });
  expect_named("width_px", [](Options* o) { o->width_px = 0; });
  expect_named("focal_px", [](Options* o) { o->focal_px = 0; });
  expect_named("focal_px", [](Options* o) {
    o->focal_px = std::numeric_limits<double>::infinity();
  });
  for (const char* pairs : {"", "ring", "window", "window:", "window:0",
                            "window:2x", "window:-1"}) {
    expect_named("pairs", [=](Options* o) { o->pairs = pairs; });
  }
  expect_named("num_views", [](Options* o) {
    o->pairs = "all";
    o->num_views = 1000;
  });
}

TEST(SyntheticKind, NamesComeBack) {
  for (const SyntheticKind kind :
       {SyntheticKind::kRoom, SyntheticKind::kCorridor, SyntheticKind::kRing,
        SyntheticKind::kHouse, SyntheticKind::kCloud, SyntheticKind::kPlanar,
        SyntheticKind::kCollinear, SyntheticKind::kPureRotation,
        SyntheticKind::kTwins}) {
    EXPECT_EQ(SyntheticKindFromName(SyntheticKindName(kind)), kind);
  }
  EXPECT_EQ(SyntheticKindFromName("garden"), std::nullopt);
}

}  // namespace
}  // namespace lowlap
