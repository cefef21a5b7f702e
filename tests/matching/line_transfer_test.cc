#include "lowlap/matching/internal/lines/line_transfer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/geometry/internal/rotation.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using testing::ExpectRefused;
using ::testing::IsEmpty;

const RigidTransform kSlightCam2FromCam1 = {
    RotationFromAngleAxis(Vec3(0.05, -0.4, 0.02)), Vec3(0.9, 0.1, 0.42)};

NormalizedSegment SegmentIn(const RigidTransform& cam_from_world, const Vec3& a,
                            const Vec3& b) {
  NormalizedSegment segment;
  const Vec3 start = cam_from_world * a, end = cam_from_world * b;
  segment.start = start / start.z();
  segment.end = end / end.z();
  segment.normal = segment.start.cross(segment.end).normalized();
  return segment;
}

// Whether the match of segment a1-b1 (camera 1's frame) seen in view 1 and
// a2-b2 seen in view 2 is kept.
bool IsKept(const Vec3& a1, const Vec3& b1, const Vec3& a2, const Vec3& b2,
            const RigidTransform& cam2_from_cam1 = kSlightCam2FromCam1,
            const LineFilterOptions& options = {}) {
  NormalizedFeatures first, second;
  first.segments = {SegmentIn({}, a1, b1)};
  second.segments = {SegmentIn(kSlightCam2FromCam1, a2, b2)};
  return !FilterLineMatches({{0, 0}}, first, second, cam2_from_cam1, options)
              .empty();
}

const Vec3 kStart(-0.5, -1.2, 5);
const Vec3 kEnd(-0.1, 1.1, 4.5);

Vec3 Along(double s) { return kStart + s * (kEnd - kStart); }

TEST(FilterLineMatchesTest, KeepsTheSameSegmentInEitherDirection) {
  EXPECT_TRUE(IsKept(Along(0), Along(1), Along(0), Along(1)));
  EXPECT_TRUE(IsKept(Along(0), Along(1), Along(1), Along(0)));
}

TEST(FilterLineMatchesTest, TheScaleOfTheBaselineIsFree) {
  for (const double scale : {0.01, 100.0}) {
    RigidTransform scaled = kSlightCam2FromCam1;
    scaled.translation *= scale;
    EXPECT_TRUE(IsKept(Along(0), Along(1), Along(0), Along(1), scaled));
  }
}

TEST(FilterLineMatchesTest, OverlapIsMeasuredOnTheShorterSegment) {
  EXPECT_TRUE(IsKept(Along(0), Along(1), Along(0.4), Along(0.6)));
  EXPECT_TRUE(IsKept(Along(0), Along(0.5), Along(0.2), Along(1)));
  EXPECT_FALSE(IsKept(Along(0), Along(0.5), Along(0.4), Along(1)));
  EXPECT_FALSE(IsKept(Along(0), Along(0.4), Along(0.6), Along(1)));
  LineFilterOptions loose;
  loose.min_overlap = 0.1;
  EXPECT_TRUE(IsKept(Along(0), Along(0.5), Along(0.4), Along(1),
                     kSlightCam2FromCam1, loose));
}

TEST(FilterLineMatchesTest, DropsLinesBehindTheCameras) {
  RigidTransform reversed = kSlightCam2FromCam1;
  reversed.translation = -reversed.translation;
  EXPECT_FALSE(IsKept(Along(0), Along(1), Along(0), Along(1), reversed));
}

TEST(FilterLineMatchesTest, KeepsASegmentOfWhichACameraSeesOnlyThePartInFront) {
  // The line runs past camera 1; view 2 sees it also where view 1 cannot.
  RigidTransform pose;
  pose.translation = Vec3(0.5, 0.3, 4);
  NormalizedFeatures first, second;
  const Vec3 a(1, -0.8, -2), b(1.2, -0.8, 2), c(1.4, -0.8, 6);
  first.segments = {SegmentIn({}, b, c)};
  second.segments = {SegmentIn(pose, a, c)};
  EXPECT_THAT(FilterLineMatches({{0, 0}}, first, second, pose, {}),
              ElementsAre(FeatureMatch{0, 0}));
}

TEST(FilterLineMatchesTest, DropsLinesInAnEpipolarPlane) {
  const Vec3 center2 = kSlightCam2FromCam1.Center();
  const Vec3 a(0.2, 0.7, 4);
  const Vec3 b = a + 0.8 * center2;  // parallel to the baseline
  EXPECT_FALSE(IsKept(a, b, a, b));
}

TEST(FilterLineMatchesTest, DropsInvalidSegmentsAndIndices) {
  NormalizedFeatures first, second;
  first.segments = {NormalizedSegment{}, SegmentIn({}, kStart, kEnd)};
  second.segments = {SegmentIn(kSlightCam2FromCam1, kStart, kEnd)};
  EXPECT_THAT(FilterLineMatches({{0, 0}, {1, 0}, {5, 0}, {1, 7}}, first, second,
                                kSlightCam2FromCam1, {}),
              ElementsAre(FeatureMatch{1, 0}));
  EXPECT_THAT(FilterLineMatches({}, {}, {}, kSlightCam2FromCam1, {}),
              IsEmpty());
}

TEST(LineFilterOptionsTest, RejectsBadValues) {
  ExpectRefused(&LineFilterOptions::min_overlap, 1.5, "min_overlap");
  ExpectRefused(&LineFilterOptions::min_epipolar_angle_deg, 90,
                "min_epipolar_angle_deg");
}

}  // namespace
}  // namespace lowlap
