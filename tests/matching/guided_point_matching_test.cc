#include "lowlap/matching/internal/points/guided_point_matching.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/points/point_matching.h"
#include "support/matchers.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using ::testing::IsEmpty;
using testing::IsError;

constexpr double kFocalPx = 1000;

struct TestView {
  std::vector<Keypoint> keypoints;
  std::vector<PointDescriptor> descriptors;
  NormalizedFeatures features;

  PointView View() const { return {keypoints, descriptors, features}; }
  void Add(const Vec3& point, const Vec3& direction,
           const PointDescriptor& descriptor) {
    const Vec3 x = point / point.z();
    const Vec3 end = point + 1e-4 * direction;
    const Vec2 along = (end / end.z() - x).head<2>();
    Keypoint keypoint;
    keypoint.position_px = kFocalPx * x.head<2>();
    keypoint.scale_px = 20 / point.z();
    keypoint.angle_rad = std::atan2(along.y(), along.x());
    keypoints.push_back(keypoint);
    descriptors.push_back(descriptor);
    features.points.push_back(x);
    features.focal_px = kFocalPx;
  }
};

PointDescriptor RandomDescriptor(Random* random) {
  PointDescriptor descriptor;
  for (std::uint8_t& value : descriptor) {
    value = static_cast<std::uint8_t>(random->Index(240));
  }
  return descriptor;
}

PointDescriptor Noisy(PointDescriptor descriptor, Random* random) {
  for (std::uint8_t& value : descriptor) {
    value = static_cast<std::uint8_t>(value + random->Index(16));
  }
  return descriptor;
}

// Points in front of both cameras; point i of one view is point i of the
// other, and `copies` consecutive points look alike.
struct TestPair {
  TestView first, second;
  RigidTransform cam2_from_cam1;

  TestPair(int count, int copies, const Vec3& translation) {
    cam2_from_cam1.rotation =
        Eigen::AngleAxisd(0.2, Vec3(0.3, 1, 0.1).normalized())
            .toRotationMatrix();
    cam2_from_cam1.translation = translation;
    Random random(11);
    PointDescriptor look{};
    for (int i = 0; i < count; ++i) {
      if (i % copies == 0) look = RandomDescriptor(&random);
      const Vec3 point = testing::UniformVec3(random, {-2, -2, 5}, {2, 2, 9});
      const double angle = random.Uniform(-3, 3);
      const Vec3 direction(std::cos(angle), std::sin(angle), 0);
      first.Add(point, direction, Noisy(look, &random));
      second.Add(cam2_from_cam1.rotation * point + cam2_from_cam1.translation,
                 cam2_from_cam1.rotation * direction, Noisy(look, &random));
    }
  }
};

int CountRight(const std::vector<FeatureMatch>& matches) {
  return static_cast<int>(
      std::count_if(matches.begin(), matches.end(),
                    [](const FeatureMatch& m) { return m.first == m.second; }));
}

TEST(MatchPointsGuidedTest, PointsThatLookAlikeAreToldApartByTheirPlace) {
  const TestPair pair(600, 2, Vec3(-1, 0.1, 0.2));
  EXPECT_LT(
      MatchPoints(pair.first.descriptors, pair.second.descriptors, {}).size(),
      10u);
  GuidedPointOptions options;
  options.chance_points = 16;
  const auto matches = MatchPointsGuided(pair.first.View(), pair.second.View(),
                                         pair.cam2_from_cam1, 2, options);
  EXPECT_GT(CountRight(matches), 540);
  EXPECT_LT(matches.size() - static_cast<std::size_t>(CountRight(matches)),
            10u);
  EXPECT_TRUE(std::is_sorted(matches.begin(), matches.end()));
}

TEST(MatchPointsGuidedTest, AnEpipoleInTheImageDoesNotHarm) {
  const TestPair pair(600, 1, Vec3(0.1, -0.1, -1));
  const auto matches = MatchPointsGuided(pair.first.View(), pair.second.View(),
                                         pair.cam2_from_cam1, 2, {});
  EXPECT_GT(CountRight(matches), 560);
  EXPECT_EQ(CountRight(matches), static_cast<int>(matches.size()));
}

TEST(MatchPointsGuidedTest, PointsBehindACameraAreNoMatches) {
  TestPair pair(300, 1, Vec3(-1, 0.1, 0.2));
  pair.cam2_from_cam1.translation *= -1;
  EXPECT_THAT(MatchPointsGuided(pair.first.View(), pair.second.View(),
                                pair.cam2_from_cam1, 2, {}),
              IsEmpty());
}

TEST(MatchPointsGuidedTest, SwappingTheImagesSwapsTheMatches) {
  const TestPair pair(500, 3, Vec3(-1, 0.1, 0.2));
  // Few enough that most copies are not in the sample.
  GuidedPointOptions options;
  options.chance_points = 16;
  const auto forward = MatchPointsGuided(pair.first.View(), pair.second.View(),
                                         pair.cam2_from_cam1, 5, options);
  auto backward = MatchPointsGuided(pair.second.View(), pair.first.View(),
                                    pair.cam2_from_cam1.Inverse(), 5, options);
  for (FeatureMatch& match : backward) std::swap(match.first, match.second);
  std::sort(backward.begin(), backward.end());
  EXPECT_EQ(forward, backward);
  EXPECT_GT(forward.size(), 50u);
}

TEST(MatchPointsGuidedTest, ALoneCandidateMustLookBetterThanChance) {
  TestPair pair(300, 1, Vec3(-1, 0.1, 0.2));
  Random random(5);
  for (PointDescriptor& d : pair.second.descriptors) {
    d = RandomDescriptor(&random);
  }
  EXPECT_THAT(MatchPointsGuided(pair.first.View(), pair.second.View(),
                                pair.cam2_from_cam1, 0.1, {}),
              IsEmpty());
}

TEST(MatchPointsGuidedTest, ATurnedOrResizedBlobIsAnother) {
  for (const bool turned : {false, true}) {
    TestPair pair(200, 1, Vec3(-1, 0.1, 0.2));
    for (Keypoint& keypoint : pair.second.keypoints) {
      if (turned) {
        keypoint.angle_rad += 2;
      } else {
        keypoint.scale_px *= 4;
      }
    }
    EXPECT_THAT(MatchPointsGuided(pair.first.View(), pair.second.View(),
                                  pair.cam2_from_cam1, 2, {}),
                IsEmpty());
  }
}

TEST(MatchPointsGuidedTest, NothingToMatchGivesNothing) {
  const TestPair pair(20, 1, Vec3(-1, 0, 0));
  const TestView none;
  RigidTransform still = pair.cam2_from_cam1;
  still.translation.setZero();
  EXPECT_THAT(MatchPointsGuided(pair.first.View(), none.View(),
                                pair.cam2_from_cam1, 2, {}),
              IsEmpty());
  EXPECT_THAT(MatchPointsGuided(none.View(), pair.second.View(),
                                pair.cam2_from_cam1, 2, {}),
              IsEmpty());
  EXPECT_THAT(
      MatchPointsGuided(pair.first.View(), pair.second.View(), still, 2, {}),
      IsEmpty());
}

TEST(GuidedPointOptionsTest, RejectsValuesOutOfRange) {
  const auto rejects = [](auto member, auto value, const char* name) {
    GuidedPointOptions options;
    options.*member = value;
    EXPECT_THAT(options.Validate(), IsError(ErrorCode::kInvalidArgument, name));
  };
  rejects(&GuidedPointOptions::max_ratio, 0.0, "max_ratio");
  rejects(&GuidedPointOptions::chance_points, 0, "chance_points");
  rejects(&GuidedPointOptions::max_scale_factor, 0.5, "max_scale_factor");
  rejects(&GuidedPointOptions::max_turn_deg, 181.0, "max_turn_deg");
}

}  // namespace
}  // namespace lowlap
