#include "lowlap/matching/internal/lines/guided_line_matching.h"

#include <gmock/gmock.h>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using testing::IsError;
using ::testing::Not;

const RigidTransform kCam2FromCam1 = {
    RotationFromAngleAxis(Vec3(0.02, -0.5, 0.03)), Vec3(0.95, 0.1, 0.3)};

Intrinsic Camera() {
  Intrinsic intrinsic;
  intrinsic.width_px = 1200;
  intrinsic.height_px = 800;
  intrinsic.fx_px = intrinsic.fy_px = 900;
  intrinsic.principal_point_px = Vec2(600, 400);
  return intrinsic;
}

LineDescriptor Noise(Random* random) {
  LineDescriptor descriptor;
  for (std::uint8_t& byte : descriptor) {
    byte = static_cast<std::uint8_t>(random->Uniform(0, 256));
  }
  return descriptor;
}

LineDescriptor Flip(LineDescriptor descriptor, int bits) {
  for (int bit = 0; bit < bits; ++bit) {
    const int at = (bit * 37) % 256;
    descriptor[at / 8] ^= static_cast<std::uint8_t>(1u << (at % 8));
  }
  return descriptor;
}

struct SeenLines {
  ViewFeatures features;
  std::vector<LineDescriptor> descriptors;

  void Add(const RigidTransform& cam_from_world, const Vec3& a, const Vec3& b,
           const LineDescriptor& descriptor) {
    LineSegment segment;
    segment.start_px = Camera().Project(cam_from_world * a);
    segment.end_px = Camera().Project(cam_from_world * b);
    features.segments.push_back(segment);
    descriptors.push_back(descriptor);
  }
};

// Short lines of all directions on a slanted wall. Descriptors of a match
// differ by more than the first pass allows.
class GuidedLineMatchingTest : public ::testing::Test {
 protected:
  GuidedLineMatchingTest() {
    Random random(7);
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column < 6; ++column) {
        const double angle = random.Uniform(0.6, 2.5);
        const Vec3 a = OnWall(-1 + 0.45 * column, -0.9 + 0.4 * row);
        const Vec3 b = OnWall(-1 + 0.45 * column + 0.3 * std::cos(angle),
                              -0.9 + 0.4 * row + 0.3 * std::sin(angle));
        const LineDescriptor descriptor = Noise(&random);
        first_.Add({}, a, b, descriptor);
        second_.Add(kCam2FromCam1, a, b, Flip(descriptor, 60));
        truth_.push_back({static_cast<FeatureIndex>(truth_.size()),
                          static_cast<FeatureIndex>(truth_.size())});
      }
    }
  }

  static Vec3 OnWall(double x, double y) { return {x, y, 4 + 0.4 * x}; }

  std::vector<FeatureMatch> Match(const RigidTransform& pose = kCam2FromCam1,
                                  const std::vector<FeatureMatch>& seeds = {},
                                  const GuidedLineOptions& options = {}) const {
    return MatchLinesGuided({first_.features.segments, first_.descriptors},
                            {second_.features.segments, second_.descriptors},
                            NormalizeFeatures(first_.features, Camera()),
                            NormalizeFeatures(second_.features, Camera()), pose,
                            seeds, options);
  }

  SeenLines first_;
  SeenLines second_;
  std::vector<FeatureMatch> truth_;
};

TEST_F(GuidedLineMatchingTest, FindsWhatTheGeometryLeavesUnambiguous) {
  EXPECT_EQ(Match(), truth_);
}

TEST_F(GuidedLineMatchingTest, TheScaleOfTheBaselineIsFree) {
  RigidTransform scaled = kCam2FromCam1;
  scaled.translation *= 50;
  EXPECT_EQ(Match(scaled), truth_);
}

TEST_F(GuidedLineMatchingTest, AllowsForASmallErrorOfThePose) {
  RigidTransform off = kCam2FromCam1;
  off.rotation = RotationFromAngleAxis(Vec3(0.002, 0.001, 0)) * off.rotation;
  EXPECT_EQ(Match(off), truth_);
}

TEST_F(GuidedLineMatchingTest, FindsNothingUnderAnOppositePose) {
  RigidTransform opposite = kCam2FromCam1;
  opposite.translation = -opposite.translation;
  EXPECT_THAT(Match(opposite), IsEmpty());
}

TEST_F(GuidedLineMatchingTest, OppositePolarityIsNoMatch) {
  std::swap(second_.features.segments[8].start_px,
            second_.features.segments[8].end_px);
  EXPECT_THAT(Match(), Not(Contains(FeatureMatch{8, 8})));
}

TEST_F(GuidedLineMatchingTest, ASeedAgainstThePoseIsDropped) {
  second_.descriptors[0] = second_.descriptors[29] = first_.descriptors[0];
  EXPECT_THAT(Match(kCam2FromCam1, {{0, 29}}),
              Not(Contains(FeatureMatch{0, 29})));
}

TEST_F(GuidedLineMatchingTest, PiecesOfABrokenEdgeShareTheirPartner) {
  const LineSegment whole = second_.features.segments[14];
  const Vec2 along = whole.end_px - whole.start_px;
  second_.features.segments[14].end_px = whole.start_px + 0.45 * along;
  LineSegment rest = whole;
  rest.start_px = whole.start_px + 0.55 * along;
  second_.features.segments.push_back(rest);
  second_.descriptors.push_back(second_.descriptors[14]);
  const auto matches = Match();
  EXPECT_THAT(matches, Contains(FeatureMatch{14, 14}));
  EXPECT_THAT(matches, Contains(FeatureMatch{14, 30}));
  EXPECT_EQ(matches.size(), truth_.size() + 1);
}

TEST_F(GuidedLineMatchingTest, TwinsAreLeftUndecided) {
  // The same descriptor a little beside it: nothing tells the two apart.
  LineSegment twin = second_.features.segments[14];
  twin.start_px.x() += 3;
  twin.end_px.x() += 3;
  second_.features.segments.push_back(twin);
  second_.descriptors.push_back(second_.descriptors[14]);
  for (const FeatureMatch& match : Match()) EXPECT_NE(match.first, 14u);
}

TEST_F(GuidedLineMatchingTest, ALineOffTheSurfaceOfItsNeighboursScoresLess) {
  // A partner that the epipolar lines allow, at a third of the wall's depth.
  const Vec3 a = OnWall(0.35, 0.1), b = OnWall(0.45, 0.35);
  Random random(3);
  const LineDescriptor descriptor = Noise(&random);
  first_.Add({}, a, b, descriptor);
  second_.Add(kCam2FromCam1, a / 3, b / 3, Flip(descriptor, 60));
  EXPECT_THAT(Match(), Not(Contains(FeatureMatch{30, 30})));
  second_.features.segments.pop_back();
  second_.descriptors.pop_back();
  second_.Add(kCam2FromCam1, a, b, Flip(descriptor, 60));
  EXPECT_THAT(Match(), Contains(FeatureMatch{30, 30}));
}

TEST_F(GuidedLineMatchingTest, NoSegmentsNoMatches) {
  first_ = {};
  EXPECT_THAT(Match(), IsEmpty());
}

TEST(GuidedLineOptionsTest, RefusesNonsense) {
  const auto with = [](auto change) {
    GuidedLineOptions options;
    change(&options);
    return options.Validate();
  };
  EXPECT_TRUE(GuidedLineOptions().Validate());
  using Options = GuidedLineOptions;
  EXPECT_THAT(with([](Options* o) { o->max_distance_bits = 257; }),
              IsError(ErrorCode::kInvalidArgument, "max_distance_bits"));
  EXPECT_THAT(with([](Options* o) { o->min_overlap = 1.5; }),
              IsError(ErrorCode::kInvalidArgument, "min_overlap"));
  EXPECT_THAT(with([](Options* o) { o->min_epipolar_angle_deg = 90; }),
              IsError(ErrorCode::kInvalidArgument, "min_epipolar_angle_deg"));
  EXPECT_THAT(with([](Options* o) { o->epipolar_tolerance_px = -1; }),
              IsError(ErrorCode::kInvalidArgument, "epipolar_tolerance_px"));
  EXPECT_THAT(with([](Options* o) { o->min_score = -0.1; }),
              IsError(ErrorCode::kInvalidArgument, "min_score"));
}

}  // namespace
}  // namespace lowlap
