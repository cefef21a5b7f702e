// The pairs of unordered photographs of a bland room.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "lowlap/matching/internal/pair_selection.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/image_measurements.h"
#include "lowlap/pipeline/measure_images.h"
#include "support/data_folder.h"
#include "support/matchers.h"
#include "third_party_adapters/strecha/internal/strecha.h"

namespace lowlap {
namespace {

using testing::IsOk;

class PairsAuto : public ::testing::TestWithParam<int> {};

TEST_P(PairsAuto, FindTheNeighboursOfARoom) {
  const std::string images = DataFolder() + "/rooms/study/images";
  if (!std::filesystem::exists(images)) GTEST_SKIP() << "skipped: no data";
  IntrinsicSource source;
  source.calibration = *strecha::ReadCalibrationMatrix(images + "/K.txt");
  const auto scene = SceneFromImages(images, source, {});
  ASSERT_THAT(scene, IsOk());
  MeasurementOptions options;
  options.pairs = "auto";
  options.features.detect_lines = false;
  options.matching.match_lines = false;
  options.features.tilts.max_tilt = 1;
  // With the default, everybody's partners are everybody in so small a set.
  options.retrieval.max_partners = 4;
  options.retrieval.max_exhaustive = GetParam();
  StageLog stages;
  const auto measured = MatchImages(*scene, options, RunContext(), &stages);
  ASSERT_THAT(measured, IsOk());
  ASSERT_EQ(stages.stages().size(), 4u);
  EXPECT_EQ(stages.stages()[1].name, "pair retrieval");
  EXPECT_LT(measured->matches.size(), 40u);  // of 55
  const auto neighbours = SelectViewPairs(*scene, "cycle");
  ASSERT_THAT(neighbours, IsOk());
  for (const ViewPair& views : *neighbours) {
    EXPECT_EQ(measured->matches.count(views), 1u)
        << views.first << " and " << views.second;
  }
}

INSTANTIATE_TEST_SUITE_P(ExactlyAndByIndex, PairsAuto,
                         ::testing::Values(350, 0));

}  // namespace
}  // namespace lowlap
