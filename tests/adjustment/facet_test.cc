#include "lowlap/adjustment/internal/planes/facet.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/adjustment/planes_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/random_vectors.h"

namespace lowlap {
namespace {

using ::testing::IsEmpty;
using testing::IsOk;
using ::testing::SizeIs;

constexpr double kStddev = PlaneLandmarks::kStddev;

std::vector<Facet> Find(const PlaneLandmarks& landmarks) {
  const auto facets =
      FindFacets(landmarks.landmarks(), SceneReach(landmarks.landmarks()), {});
  EXPECT_THAT(facets, IsOk());
  return *facets;
}

TEST(FindFacets, FindsTwoPlanesInACloud) {
  PlaneLandmarks landmarks(1);
  for (int n = 0; n < 60; ++n) {
    landmarks.AddPoint(landmarks.OnFloor(1));
    landmarks.AddPoint(landmarks.OnFloor(-0.5));
    landmarks.AddPoint(landmarks.InCloud());
  }
  for (int n = 0; n < 8; ++n) {
    landmarks.AddLine(landmarks.OnFloor(1), landmarks.OnFloor(1));
    landmarks.AddLine(landmarks.OnFloor(-0.5), landmarks.OnFloor(-0.5));
  }
  const std::vector<Facet> facets = Find(landmarks);
  ASSERT_THAT(facets, SizeIs(2));
  for (const Facet& facet : facets) {
    EXPECT_LT(facet.log10_nfa, -20);
    EXPECT_GT(std::abs(facet.plane.normal.z()), 0.9999);
    const double height = facet.plane.offset / facet.plane.normal.z();
    EXPECT_LT(std::min(std::abs(height - 1), std::abs(height + 0.5)), kStddev);
    // Sixty-eight, and what of the cloud is there by chance.
    EXPECT_GE(facet.members.size(), 63U);
    EXPECT_LE(facet.members.size(), 73U);
    EXPECT_LT(facet.thickness, 2 * kStddev);
  }
}

TEST(FindFacets, ThicknessIsWhatDeviationsDoNotExplain) {
  PlaneLandmarks landmarks(2);
  Random random(3);
  constexpr double kRoughness = 0.015;
  for (int n = 0; n < 400; ++n) {
    landmarks.AddPoint(landmarks.OnFloor(1 + kRoughness * random.Gaussian()));
    landmarks.AddPoint(landmarks.InCloud());
  }
  const std::vector<Facet> facets = Find(landmarks);
  ASSERT_THAT(facets, SizeIs(1));
  EXPECT_NEAR(facets[0].thickness, kRoughness, 0.25 * kRoughness);
}

// All that a pair sees may lie on one wall: it is narrow within the scene.
TEST(FindFacets, APairMaySeeNothingElse) {
  PlaneLandmarks landmarks(4);
  for (int n = 0; n < 40; ++n) landmarks.AddPoint(landmarks.OnFloor(1));
  landmarks.SeenFrom({1, 2});
  for (int n = 0; n < 80; ++n) landmarks.AddPoint(landmarks.InCloud());
  const std::vector<Facet> facets = Find(landmarks);
  ASSERT_THAT(facets, SizeIs(1));
  EXPECT_THAT(facets[0].members, SizeIs(40));
}

// An NFA below 1 allows one facet in a cloud on average.
TEST(FindFacets, HardlyAFacetIsInACloud) {
  constexpr int kClouds = 100;
  std::size_t num_facets = 0;
  for (std::uint64_t seed = 0; seed < kClouds; ++seed) {
    PlaneLandmarks landmarks(seed);
    for (int n = 0; n < 200; ++n) landmarks.AddPoint(landmarks.InCloud());
    num_facets += Find(landmarks).size();
  }
  EXPECT_LE(num_facets, kClouds / 5);
}

TEST(FindFacets, WithoutLandmarksThereIsNone) {
  EXPECT_THAT(Find(PlaneLandmarks(0)), IsEmpty());
}

TEST(PlaneFit, IsExactOnAPlane) {
  const Vec3 normal = Vec3(1, 2, -1).normalized();
  std::vector<FreeLandmark> landmarks;
  Random random(4);
  for (int n = 0; n < 10; ++n) {
    Vec3 point = testing::GaussianVec3(random);
    point += (3 - normal.dot(point)) * normal;
    landmarks.push_back({false, n, {{point, 1e-6 * Mat3::Identity()}}, {}});
  }
  std::vector<const FreeLandmark*> members;
  for (const FreeLandmark& landmark : landmarks) members.push_back(&landmark);
  const Plane plane = FitPlane(members, {Vec3(1, 1, -1).normalized(), 0}, 0.1);
  EXPECT_NEAR(plane.normal.dot(normal), 1, 1e-12);
  EXPECT_NEAR(plane.offset, 3, 1e-12);
  EXPECT_NEAR(PlaneThickness(members, plane), 0.25e-3, 1e-9);
}

}  // namespace
}  // namespace lowlap
