#include "lowlap/pipeline/internal/measure/measurement_choices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/matchers.h"

namespace lowlap {
namespace {

MeasurementOptions OptionsOf(const MeasurementChoices& choices,
                             const ScaleOptions& scale = {}) {
  MeasurementOptions options;
  EXPECT_THAT(SetChoices(choices, scale, &options), testing::IsOk());
  return options;
}

TEST(MeasurementChoices, AreTheDefaultsUnlessSaidOtherwise) {
  const MeasurementOptions options = OptionsOf({}), defaults;
  EXPECT_EQ(options.matching.points.matcher, defaults.matching.points.matcher);
  EXPECT_TRUE(options.relative_poses.pair.use_points);
  EXPECT_TRUE(options.relative_poses.pair.use_lines);
  EXPECT_TRUE(options.features.detect_lines);
  EXPECT_TRUE(options.matching.match_lines);
}

TEST(MeasurementChoices, BothPassesOfMatchingAreOfOneKind) {
  const MeasurementOptions options = OptionsOf({"flann", {"points"}});
  EXPECT_EQ(options.matching.points.matcher, PointMatcher::kFlann);
  EXPECT_EQ(options.matching.relaxed_points.matcher, PointMatcher::kFlann);
}

TEST(MeasurementChoices, BoundTheTilt) {
  MeasurementChoices choices;
  EXPECT_EQ(OptionsOf(choices).features.tilts.max_tilt, TiltOptions().max_tilt);
  choices.max_tilt = 2;
  EXPECT_EQ(OptionsOf(choices).features.tilts.max_tilt, 2);
  choices.max_tilt = 0.5;
  MeasurementOptions options;
  EXPECT_THAT(SetChoices(choices, {}, &options),
              testing::IsError(ErrorCode::kInvalidArgument, "max_tilt"));
}

TEST(MeasurementChoices, LinesAreDetectedIfAnythingNeedsThem) {
  ScaleOptions points;
  points.features = {"points"};
  const MeasurementOptions none = OptionsOf({"exact", {"points"}}, points);
  EXPECT_FALSE(none.relative_poses.pair.use_lines);
  EXPECT_FALSE(none.features.detect_lines);
  EXPECT_FALSE(none.matching.match_lines);
  EXPECT_TRUE(OptionsOf({"exact", {"lines"}}, points).features.detect_lines);
  for (const char* feature : {"lines", "coplanar"}) {
    ScaleOptions scale;
    scale.features = {feature};
    const MeasurementOptions options = OptionsOf({"exact", {"points"}}, scale);
    EXPECT_TRUE(options.features.detect_lines) << feature;
    EXPECT_TRUE(options.matching.match_lines) << feature;
  }
}

TEST(MeasurementChoices, OtherWordsAreNamed) {
  MeasurementOptions options;
  EXPECT_THAT(SetChoices({"fast", {}}, {}, &options),
              testing::IsError(ErrorCode::kInvalidArgument,
                               "matcher: 'fast' is not one of exact, flann"));
  EXPECT_THAT(
      SetChoices({"exact", {"points", "circles"}}, {}, &options),
      testing::IsError(ErrorCode::kInvalidArgument,
                       "two_view: 'circles' is not one of points, lines"));
}

}  // namespace
}  // namespace lowlap
