#include "lowlap/matching/internal/repeats/conjugate_translation.h"

#include <gtest/gtest.h>

#include "tests/matching/pattern_view.h"
#include "tests/support/random_vectors.h"

namespace lowlap {
namespace {

using testing::ObliqueCamera;

constexpr double kTolerance = 1e-3;

/// Images of points of the wall z = 5 and of the same points moved on.
std::vector<AlikePlaces> MovedPlaces(const Vec3& step, double noise,
                                     Random* random) {
  std::vector<AlikePlaces> places;
  for (int n = 0; n < 40; ++n) {
    const Vec2 aside = testing::UniformVec2(*random, {-2, -1}, {2, 1});
    const Vec3 point(aside.x(), aside.y(), 5);
    AlikePlaces place;
    place.first = 2 * n;
    place.second = 2 * n + 1;
    place.from = ObliqueCamera() * point;
    place.to = ObliqueCamera() * (point + step);
    place.from /= place.from.z();
    place.to /= place.to.z();
    place.to.x() += random->Gaussian(noise);
    place.to.y() += random->Gaussian(noise);
    place.tolerance = kTolerance;
    places.push_back(place);
  }
  return places;
}

TEST(ConjugateTranslation, TwoPlacesGiveTheMapOfTheWholePlane) {
  Random random(1);
  const auto places = MovedPlaces(Vec3(0.5, 0.2, 0), 0, &random);
  const auto translation = ConjugateTranslation::FromTwo(places[0], places[1]);
  ASSERT_TRUE(translation);
  for (const AlikePlaces& place : places) {
    EXPECT_LT((*translation->Map(place.from) - place.to).norm(), 1e-9);
    EXPECT_TRUE(translation->Explains(place));
  }
  EXPECT_NEAR(translation->vanishing_line.dot(translation->vanishing_point), 0,
              1e-12);
  // The line is that of the wall's normal, the point that of the step.
  const Vec3 normal = ObliqueCamera().rotation * Vec3::UnitZ();
  EXPECT_NEAR(std::abs(translation->vanishing_line.dot(normal)), 1, 1e-9);
  const Vec3 step = ObliqueCamera().rotation * Vec3(0.5, 0.2, 0).normalized();
  EXPECT_LT(translation->vanishing_point.normalized().cross(step).norm(), 1e-9);
}

TEST(ConjugateTranslation, OnePlaceDoesWhereTheLineIsKnown) {
  Random random(3);
  const auto places = MovedPlaces(Vec3(-0.7, 0.1, 0), 0, &random);
  const Vec3 line = ObliqueCamera().rotation * Vec3::UnitZ();
  const auto translation = ConjugateTranslation::FromOne(places[7], line);
  ASSERT_TRUE(translation);
  for (const AlikePlaces& place : places) {
    EXPECT_LT((*translation->Map(place.from) - place.to).norm(), 1e-9);
  }
  // A place on the line is infinitely far away.
  AlikePlaces far = places[7];
  far.from = line.unitOrthogonal();
  far.from /= far.from.z();
  EXPECT_FALSE(ConjugateTranslation::FromOne(far, line));
}

TEST(ConjugateTranslation, StepsAcrossTheViewHaveNoFiniteVanishingPoint) {
  AlikePlaces a, b;
  a.from = Vec3(0, 0, 1);
  a.to = Vec3(0.1, 0, 1);
  b.from = Vec3(0, 0.2, 1);
  b.to = Vec3(0.1, 0.2, 1);
  a.tolerance = b.tolerance = kTolerance;
  const auto translation = ConjugateTranslation::FromTwo(a, b);
  ASSERT_TRUE(translation);
  EXPECT_LT((*translation->Map(Vec3(0.3, -0.4, 1)) - Vec3(0.4, -0.4, 1)).norm(),
            1e-9);
}

TEST(ConjugateTranslation, PlacesOnOneLineGiveNone) {
  AlikePlaces a, b;
  a.from = Vec3(0, 0, 1);
  a.to = Vec3(0.1, 0, 1);
  b.from = Vec3(0.2, 0, 1);
  b.to = Vec3(0.35, 0, 1);
  a.tolerance = b.tolerance = kTolerance;
  EXPECT_FALSE(ConjugateTranslation::FromTwo(a, b));
  EXPECT_FALSE(ConjugateTranslation::FromTwo(a, a));
}

TEST(ConjugateTranslation, RefinementAveragesTheNoiseAndLeavesOutTheRest) {
  Random random(2);
  auto places = MovedPlaces(Vec3(0.5, 0.2, 0), kTolerance / 4, &random);
  for (std::size_t n = 30; n < places.size(); ++n) {
    places[n].to += Vec3(0.1, -0.2, 0);
  }
  const auto rough = ConjugateTranslation::FromTwo(places[0], places[1]);
  ASSERT_TRUE(rough);
  auto refined = rough;
  for (int step = 0; step < 3 && refined; ++step) {
    refined = refined->Refined(places, places.size(), 4);
  }
  ASSERT_TRUE(refined);
  const auto exact = MovedPlaces(Vec3(0.5, 0.2, 0), 0, &random);
  const auto error_of = [&](const ConjugateTranslation& translation) {
    double sum = 0;
    for (const AlikePlaces& place : exact) {
      sum += (*translation.Map(place.from) - place.to).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(exact.size()));
  };
  EXPECT_LT(error_of(*refined), kTolerance / 4);
  EXPECT_LT(error_of(*refined), error_of(*rough));
  EXPECT_NEAR(refined->vanishing_line.dot(refined->vanishing_point), 0, 1e-9);
  EXPECT_FALSE(rough->Refined(places, 2, 4));  // of four unknowns
}

TEST(ConjugateTranslation, WhatGoesBehindTheCameraHasNoImage) {
  ConjugateTranslation translation;
  translation.vanishing_point = Vec3(0, 0, -2);
  translation.vanishing_line = Vec3(1, 0, 0);
  EXPECT_TRUE(translation.Map(Vec3(0.1, 0, 1)));
  EXPECT_FALSE(translation.Map(Vec3(0.6, 0, 1)));
}

}  // namespace
}  // namespace lowlap
