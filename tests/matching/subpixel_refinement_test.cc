#include "lowlap/matching/internal/points/subpixel_refinement.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::ExpectRefused;
using testing::IsError;
using testing::IsOk;

const testing::BlobTexture kTexture(5, 120, 160);
const Vec2 kPoint(80, 80);  // of the texture

// An image that shows the texture through an affine map, its contrast and
// brightness changed.
struct Shot {
  Mat2 image_from_texture = Mat2::Identity();
  Vec2 place = Vec2(60, 60);  // of kPoint
  double gain = 0.8;
  double offset = 10;
  double noise = 0;
  std::uint64_t seed = 1;  // of the noise

  GrayImage Render() const {
    const Mat2 back = image_from_texture.inverse();
    return testing::Render(
        120, 120,
        [&](const Vec2& p) {
          return gain * kTexture(kPoint + back * (p - place)) + offset;
        },
        noise, seed);
  }
};

Keypoint At(const Vec2& position, double scale_px, double angle_rad = 0) {
  Keypoint keypoint;
  keypoint.position_px = position;
  keypoint.scale_px = scale_px;
  keypoint.angle_rad = angle_rad;
  return keypoint;
}

// Aligns the point of `first` in `second`, from a start that is off.
std::optional<Vec2> Align(const Shot& first, const Shot& second,
                          double scale_px, const Keypoint& start,
                          const PatchAlignmentOptions& options = {}) {
  const Keypoint from = At(first.place, scale_px);
  const auto patch = ExtractPatch(GrayPyramid(first.Render()), from);
  if (!patch) return std::nullopt;
  return AlignPatch(*patch, from, start, GrayPyramid(second.Render()), options);
}

TEST(AlignPatchTest, FindsAShiftUnderAnotherContrast) {
  const Shot first;
  Shot second;
  second.place = Vec2(57.37, 61.81);
  second.gain = 0.5;
  second.offset = 70;
  const auto place =
      Align(first, second, 2, At(second.place + Vec2(0.7, -0.6), 2));
  ASSERT_TRUE(place);
  EXPECT_LT((*place - second.place).norm(), 0.02);
}

TEST(AlignPatchTest, FindsASlantedPatchFromItsSimilarity) {
  const Shot first;
  Shot second;
  second.place = Vec2(61.4, 58.7);
  const double angle = 0.5;
  second.image_from_texture = 0.9 *
                              Eigen::Rotation2Dd(angle).toRotationMatrix() *
                              (Mat2() << 0.75, 0.1, 0, 1.1).finished();
  const auto place =
      Align(first, second, 2.2, At(second.place + Vec2(-0.5, 0.5), 2, angle));
  ASSERT_TRUE(place);
  EXPECT_LT((*place - second.place).norm(), 0.03);
}

TEST(AlignPatchTest, NoiseAveragesOut) {
  constexpr int kSeeds = 20;
  Shot first, second;
  first.noise = second.noise = 4;
  second.place = Vec2(60.45, 59.6);
  double sum = 0;
  for (int n = 0; n < kSeeds; ++n) {
    first.seed = 2 * n + 1;
    second.seed = 2 * n + 2;
    const auto place =
        Align(first, second, 2.5, At(second.place + Vec2(0.5, 0.5), 2.5));
    ASSERT_TRUE(place);
    sum += (*place - second.place).squaredNorm();
  }
  EXPECT_LT(std::sqrt(sum / kSeeds), 0.2);
}

TEST(AlignPatchTest, LargeBlobsAreComparedAtTheirOwnResolution) {
  Shot first;
  first.image_from_texture = 2 * Mat2::Identity();
  Shot second = first;
  second.place = Vec2(61.2, 59.1);
  const auto place =
      Align(first, second, 6, At(second.place + Vec2(0.8, -0.8), 6));
  ASSERT_TRUE(place);
  EXPECT_LT((*place - second.place).norm(), 0.05);
}

TEST(AlignPatchTest, LargeBlobsMayMoveFarther) {
  const Vec2 off(1.9, -1.6);
  Shot first;
  first.image_from_texture = 2 * Mat2::Identity();
  const auto place = Align(first, first, 6, At(first.place + off, 6));
  ASSERT_TRUE(place);
  EXPECT_LT((*place - first.place).norm(), 0.1);
  EXPECT_FALSE(Align(Shot(), Shot(), 2, At(Shot().place + off, 2)));
}

// The less a keypoint is trusted, the nearer the point comes to where its patch
// was aligned; the worse the fit, the nearer it stays to the keypoint.
TEST(AlignPatchTest, WeighsTheKeypointAgainstTheFit) {
  const Vec2 off(0.3, -0.3);
  const auto distance = [&](double noise, double keypoint_stddev) {
    Shot first, second;
    first.noise = second.noise = noise;
    second.seed = 2;
    PatchAlignmentOptions options;
    options.keypoint_stddev = keypoint_stddev;
    options.max_deviation = 100;
    const Vec2 start = second.place + off;
    const auto place = Align(first, second, 2.5, At(start, 2.5), options);
    const auto free = [&] {
      options.keypoint_stddev = 1e3;
      return Align(first, second, 2.5, At(start, 2.5), options);
    }();
    EXPECT_TRUE(place && free);
    return place && free ? (*place - start).norm() / (*free - start).norm()
                         : -1;
  };
  EXPECT_GT(distance(0, 0.3), 0.98);
  const double trusted = distance(4, 0.02), usual = distance(4, 0.3);
  EXPECT_LT(trusted, 0.6);
  EXPECT_GT(trusted, 0.01);
  EXPECT_GT(usual, trusted + 0.2);
  EXPECT_LT(usual, distance(0, 0.3));
}

TEST(AlignPatchTest, RefusesWhatItCannotAlign) {
  const Shot first, same;
  EXPECT_TRUE(Align(first, same, 2, At(same.place + Vec2(0.3, 0), 2)));
  // Too far away.
  PatchAlignmentOptions options;
  options.max_deviation = 0.4;
  EXPECT_FALSE(
      Align(first, same, 2, At(same.place + Vec2(0.3, 0), 2), options));
  // Another place, a negative, a flat image, the image's border.
  EXPECT_FALSE(Align(first, same, 2, At(same.place + Vec2(20, 17), 2)));
  Shot negative;
  negative.gain = -0.8;
  negative.offset = 240;
  EXPECT_FALSE(Align(first, negative, 2, At(negative.place, 2)));
  Shot flat;
  flat.gain = 0;
  EXPECT_FALSE(Align(first, flat, 2, At(flat.place, 2)));
  EXPECT_FALSE(Align(flat, first, 2, At(first.place, 2)));
  EXPECT_FALSE(Align(first, same, 2, At(Vec2(5, 60), 2)));
  EXPECT_FALSE(ExtractPatch(GrayPyramid(first.Render()), At(Vec2(5, 60), 2)));
}

TEST(PatchAlignmentOptionsTest, RejectsValuesOutOfRange) {
  ExpectRefused(&PatchAlignmentOptions::max_iterations, 0, "max_iterations");
  ExpectRefused(&PatchAlignmentOptions::min_step, 0, "min_step");
  ExpectRefused(&PatchAlignmentOptions::min_correlation, 1, "min_correlation");
  ExpectRefused(&PatchAlignmentOptions::keypoint_stddev, 0, "keypoint_stddev");
  ExpectRefused(&PatchAlignmentOptions::max_deviation, std::nan(""),
                "max_deviation");
}

class RefinePointTracksTest : public ::testing::Test {
 protected:
  // Three images of one point; the second view's blob is the largest, and the
  // keypoints of the others are off.
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("lowlap_subpixel_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    scene_.root_path = folder_.string();
    Track track;
    for (std::uint32_t id = 0; id < 3; ++id) {
      Shot shot;
      shot.place = true_[id];
      const GrayImage image = shot.Render();
      View view;
      view.filename = std::to_string(id) + ".pgm";
      view.width_px = image.width;
      view.height_px = image.height;
      scene_.views[id] = view;
      std::ofstream(folder_ / view.filename, std::ios::binary)
          << "P5\n120 120\n255\n"
          << std::string(image.pixels.begin(), image.pixels.end());
      const Vec2 off = id == 1 ? Vec2(0, 0) : Vec2(0.6, -0.4);
      DetectedFeatures& features = detected_[id];
      features.keypoints = {At(Vec2(3, 3), 9), At(true_[id] + off, 2)};
      if (id == 1) features.keypoints[1].scale_px = 2.001;
      for (const Keypoint& k : features.keypoints) {
        features.features.points_px.push_back(k.position_px);
      }
      scene_.features[id] = features.features;
      track.push_back({id, 1});
    }
    scene_.point_tracks[0] = track;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
  std::map<ViewId, Vec2> true_{
      {0, Vec2(60.3, 61.2)}, {1, Vec2(58, 60)}, {2, Vec2(61.7, 59.45)}};
  std::map<ViewId, DetectedFeatures> detected_;
  Scene scene_;
};

TEST_F(RefinePointTracksTest, EveryViewAgreesWithTheLargestBlob) {
  const Scene before = scene_;
  const auto summary = RefinePointTracks(detected_, {}, RunContext(), &scene_);
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->observations, 2u);
  EXPECT_EQ(summary->refined, 2u);
  for (ViewId id = 0; id < 3; ++id) {
    EXPECT_LT((scene_.features[id].points_px[1] - true_[id]).norm(), 0.02)
        << id;
    // What is in no track stays.
    EXPECT_EQ(scene_.features[id].points_px[0], Vec2(3, 3));
  }
  EXPECT_EQ(scene_.features[1].points_px[1], true_[1]);
  Scene others = scene_;
  others.features = before.features;
  EXPECT_TRUE(others == before);
}

TEST_F(RefinePointTracksTest, WhatCannotBeAlignedStays) {
  detected_[2].keypoints[1].position_px = Vec2(30, 40);
  scene_.features[2].points_px[1] = Vec2(30, 40);
  const auto summary = RefinePointTracks(detected_, {}, RunContext(), &scene_);
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->refined, 1u);
  EXPECT_EQ(scene_.features[2].points_px[1], Vec2(30, 40));
}

TEST_F(RefinePointTracksTest, ErrorsNameTheCauseAndChangeNothing) {
  fs::remove(folder_ / "2.pgm");
  const Scene before = scene_;
  EXPECT_THAT(RefinePointTracks(detected_, {}, RunContext(), &scene_),
              IsError(ErrorCode::kNotFound, "2.pgm"));
  detected_[1].keypoints.pop_back();
  EXPECT_THAT(RefinePointTracks(detected_, {}, RunContext(), &scene_),
              IsError(ErrorCode::kInvalidArgument, "without a keypoint"));
  EXPECT_TRUE(scene_ == before);
}

}  // namespace
}  // namespace lowlap
