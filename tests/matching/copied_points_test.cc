#include "lowlap/matching/internal/repeats/copied_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/matching/pattern_view.h"

namespace lowlap {
namespace {

using testing::AddOthers;
using testing::AddPattern;
using testing::PatternView;
using testing::Resembling;

constexpr int kColumns = 7, kRows = 5, kMotif = 3, kNumOthers = 1000;
constexpr int kInPattern = kColumns * kRows * kMotif;

// A wall seen from straight before it, its columns a tenth apart.
PatternView FrontalView(std::uint64_t seed) {
  PatternView view;
  view.features.focal_px = 1000;
  Random random(seed);
  AddPattern(kColumns, kRows, kMotif, 0.3, RigidTransform(), &random, &view);
  AddOthers(kNumOthers, &random, &view);
  return view;
}

ConjugateTranslation ToNextColumn() { return {Vec3(0.1, 0, 0), Vec3(0, 0, 1)}; }

TEST(CopiedPoints, AreThoseThatATranslationTakesToTheirLike) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const PatternView view = FrontalView(seed);
    const std::vector<bool> copied =
        FindCopiedPoints(view.View(), {ToNextColumn()});
    ASSERT_EQ(copied.size(), view.keypoints.size());
    // Of many copies each is alike wherever it looks, and a few are missed.
    EXPECT_GT(std::count(copied.begin(), copied.begin() + kInPattern, true),
              0.8 * kInPattern);
    // Chance alone finds one in twenty where something happens to be.
    EXPECT_LT(std::count(copied.begin() + kInPattern, copied.end(), true),
              kNumOthers / 20);
  }
}

TEST(CopiedPoints, NeedNotBeTheNearestOfThePhotograph) {
  PatternView view = FrontalView(4);
  // Beside each copy of the first point something that looks still more alike.
  const PointDescriptor descriptor = view.descriptors[0];
  for (int n = 0; n < kColumns * kRows; ++n) {
    view.Add(view.features.points[n] + Vec3(0.02, 0.01, 0), descriptor, 2);
  }
  EXPECT_TRUE(FindCopiedPoints(view.View(), {ToNextColumn()})[0]);
}

TEST(CopiedPoints, AreOfOneSizeAndWhereTheTranslationLeads) {
  PatternView view;
  view.features.focal_px = 1000;
  Random random(6);
  const PointDescriptor descriptor = testing::RandomDescriptor(&random);
  AddOthers(500, &random, &view);
  for (Keypoint& keypoint : view.keypoints) keypoint.scale_px = 20;
  view.Add(Vec3(0, 0, 1), descriptor, 2);
  view.Add(Vec3(0.1, 0, 1), Resembling(descriptor, &random), 8);
  view.Add(Vec3(0.1, 0.01, 1), Resembling(descriptor, &random), 2);
  EXPECT_FALSE(FindCopiedPoints(view.View(), {ToNextColumn()})[500]);
  view.Add(Vec3(0.102, 0, 1), Resembling(descriptor, &random), 2);
  EXPECT_TRUE(FindCopiedPoints(view.View(), {ToNextColumn()})[500]);
}

TEST(CopiedPoints, AreNoneBeyondTheHorizon) {
  PatternView view = FrontalView(8);
  Random random(9);
  view.Add(Vec3(1 - std::pow(2, -53), 0.1, 1),
           testing::RandomDescriptor(&random), 2);
  const ConjugateTranslation away = {Vec3(0, 0.1, -1), Vec3(1, 0, 0)};
  ASSERT_GT(away.Map(view.features.points.back())->y(), 1e12);
  EXPECT_FALSE(FindCopiedPoints(view.View(), {away}).back());
}

TEST(CopiedPoints, AreNoneWithoutTranslationsOrRays) {
  PatternView view = FrontalView(7);
  const std::vector<bool> none(view.keypoints.size(), false);
  EXPECT_EQ(FindCopiedPoints(view.View(), {}), none);
  for (Vec3& x : view.features.points) x.setZero();
  EXPECT_EQ(FindCopiedPoints(view.View(), {ToNextColumn()}), none);
  view = PatternView();
  EXPECT_TRUE(FindCopiedPoints(view.View(), {ToNextColumn()}).empty());
}

}  // namespace
}  // namespace lowlap
