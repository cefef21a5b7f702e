#include "lowlap/adjustment/internal/planes/scene_planes.h"

#include <gmock/gmock.h>

#include <cmath>

#include "lowlap/adjustment/internal/planes/plane_fit.h"
#include "lowlap/core/internal/random.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using ::testing::IsEmpty;
using testing::IsOk;
using ::testing::SizeIs;

constexpr double kStddev = 0.002;

class Landmarks {
 public:
  explicit Landmarks(std::uint64_t seed) : random_(seed) {}

  double Uniform() { return random_.Uniform(-2, 2); }

  void AddPoint(const Vec3& point) {
    const Vec3 error(random_.Gaussian(), random_.Gaussian(),
                     random_.Gaussian());
    landmarks_.push_back({false, static_cast<int>(num_points_++), {}});
    landmarks_.back().places = {Place(point + kStddev * error)};
  }
  void AddLine(const Vec3& from, const Vec3& to) {
    landmarks_.push_back({true, static_cast<int>(state_.lines.size()), {}});
    landmarks_.back().places = {Place(from), Place(to)};
    state_.lines.emplace_back();
  }
  // Two lines across z = height, and the pair of them.
  void AddPair(double height) {
    for (int n = 0; n < 2; ++n) {
      AddLine(Vec3(Uniform(), Uniform(), height),
              Vec3(Uniform(), Uniform(), height));
    }
    PairState pair;
    pair.second = static_cast<int>(state_.lines.size()) - 1;
    pair.first = pair.second - 1;
    state_.pairs.push_back(pair);
  }
  std::vector<PlaneState> Find() const {
    const auto planes = FindPlanes(landmarks_, state_, {});
    EXPECT_THAT(planes, IsOk());
    return *planes;
  }

 private:
  static FreePlace Place(const Vec3& point) {
    return {point, kStddev * kStddev * Mat3::Identity()};
  }

  Random random_;
  std::size_t num_points_ = 0;
  std::vector<FreeLandmark> landmarks_;
  StructureState state_;
};

TEST(FindPlanes, FindsTwoPlanesInACloud) {
  Landmarks landmarks(1);
  for (int n = 0; n < 60; ++n) {
    landmarks.AddPoint(Vec3(landmarks.Uniform(), landmarks.Uniform(), 1));
    landmarks.AddPoint(Vec3(landmarks.Uniform(), landmarks.Uniform(), -0.5));
    landmarks.AddPoint(
        Vec3(landmarks.Uniform(), landmarks.Uniform(), landmarks.Uniform()));
  }
  for (int n = 0; n < 4; ++n) {
    landmarks.AddPair(1);
    landmarks.AddPair(-0.5);
  }
  const std::vector<PlaneState> planes = landmarks.Find();
  ASSERT_THAT(planes, SizeIs(2));
  for (const PlaneState& plane : planes) {
    EXPECT_LT(plane.log10_nfa, -20);
    EXPECT_GT(std::abs(plane.normal.z()), 0.9999);
    const double height = plane.anchor.z() + plane.offset * plane.normal.z();
    EXPECT_LT(std::min(std::abs(height - 1), std::abs(height + 0.5)), kStddev);
    EXPECT_THAT(plane.lines, SizeIs(8));
    // Sixty, and what of the cloud is there by chance.
    EXPECT_GE(plane.points.size(), 55U);
    EXPECT_LE(plane.points.size(), 65U);
    EXPECT_LT(plane.thickness, 2 * kStddev);
  }
}

TEST(FindPlanes, ThicknessIsWhatDeviationsDoNotExplain) {
  Landmarks landmarks(2);
  Random random(3);
  constexpr double kRoughness = 0.015;
  for (int n = 0; n < 400; ++n) {
    landmarks.AddPoint(Vec3(landmarks.Uniform(), landmarks.Uniform(),
                            1 + kRoughness * random.Gaussian()));
    landmarks.AddPoint(
        Vec3(landmarks.Uniform(), landmarks.Uniform(), landmarks.Uniform()));
  }
  for (int n = 0; n < 6; ++n) landmarks.AddPair(1);
  const std::vector<PlaneState> planes = landmarks.Find();
  ASSERT_THAT(planes, SizeIs(1));
  EXPECT_NEAR(planes[0].thickness, kRoughness, 0.25 * kRoughness);
}

// An NFA below 1 allows one plane in a cloud on average.
TEST(FindPlanes, HardlyAPlaneIsInACloud) {
  constexpr int kClouds = 100;
  std::size_t num_planes = 0;
  for (std::uint64_t seed = 0; seed < kClouds; ++seed) {
    Landmarks landmarks(seed);
    for (int n = 0; n < 200; ++n) {
      landmarks.AddPoint(
          Vec3(landmarks.Uniform(), landmarks.Uniform(), landmarks.Uniform()));
    }
    for (int n = 0; n < 5; ++n) landmarks.AddPair(landmarks.Uniform());
    num_planes += landmarks.Find().size();
  }
  EXPECT_LE(num_planes, kClouds / 5);
}

TEST(FindPlanes, WithoutLandmarksThereIsNone) {
  EXPECT_THAT(Landmarks(0).Find(), IsEmpty());
}

TEST(PlaneFit, IsExactOnAPlane) {
  const Vec3 normal = Vec3(1, 2, -1).normalized();
  std::vector<FreeLandmark> landmarks;
  Random random(4);
  for (int n = 0; n < 10; ++n) {
    Vec3 point(random.Gaussian(), random.Gaussian(), random.Gaussian());
    point += (3 - normal.dot(point)) * normal;
    landmarks.push_back({false, n, {{point, 1e-6 * Mat3::Identity()}}});
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
