#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/cache/cache_folder.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_bytes.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_key.h"
#include "lowlap/pipeline/internal/measure/image_measurements.h"
#include "lowlap/pipeline/measure_images.h"
#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::IsError;
using testing::IsOk;
using ::testing::Not;

class CacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / (std::string("lowlap_cache_") +
                                     info->name() + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "images");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string CachePath() const { return (folder_ / "cache").string(); }
  std::vector<fs::path> Entries() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(CachePath())) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  static std::string Read(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  static void Write(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }

  /// Three photographs of one texture, moved.
  void AddImages() {
    const testing::BlobTexture texture(3, 150, 240);
    for (int n = 0; n < 3; ++n) {
      GrayImage image = testing::Render(160, 120, [&](const Vec2& p) {
        return texture(p + Vec2(30 + 9 * n, 20)) + (p.x() > 60 ? 50 : 0);
      });
      cv::imwrite(
          (folder_ / "images" / (std::to_string(n) + ".png")).string(),
          cv::Mat(image.height, image.width, CV_8UC1, image.pixels.data()));
    }
  }
  struct Run {
    Result<Scene> scene;
    std::vector<std::string> log;
  };
  Run Measure(MeasurementOptions options = {},
              RunContext::ProgressSink progress = nullptr) {
    Run run;
    IntrinsicSource source;
    source.focal_px = 150;
    run.scene = SceneFromImages((folder_ / "images").string(), source, {});
    options.cache_folder = CachePath();
    RunContext context;
    context.log = [&](LogLevel, const std::string& message) {
      run.log.push_back(message);
    };
    context.progress = std::move(progress);
    StageLog stages;
    const auto pairs = MeasureImages(&*run.scene, options, context, &stages);
    if (!pairs) run.scene = tl::unexpected<Error>(pairs.error());
    return run;
  }

  fs::path folder_;
};

const Hash128::Value kKey = {0x0123456789abcdefull, 42};

TEST_F(CacheTest, AnEntryComesBackAndOnlyUnderItsKindAndKey) {
  const auto cache = CacheFolder::Open(CachePath());
  ASSERT_THAT(cache, IsOk());
  const std::string bytes("a\0b\n", 4);
  ASSERT_THAT(cache->Write("kind", kKey, bytes), IsOk());
  EXPECT_EQ(cache->Read("kind", kKey).value(), bytes);
  EXPECT_EQ(cache->Read("other", kKey).value(), std::nullopt);
  EXPECT_EQ(cache->Read("kind", {1, 2}).value(), std::nullopt);
  EXPECT_EQ(Entries().size(), 1u);
}

TEST_F(CacheTest, EveryDamageIsNoticed) {
  const auto cache = CacheFolder::Open(CachePath());
  ASSERT_THAT(cache->Write("kind", kKey, "some content"), IsOk());
  const fs::path file = Entries().front();
  const std::string whole = Read(file);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Write(file, whole.substr(0, size));
    EXPECT_THAT(cache->Read("kind", kKey), IsError(ErrorCode::kParse, "entry"))
        << size;
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    Write(file, damaged);
    EXPECT_THAT(cache->Read("kind", kKey), IsError(ErrorCode::kParse, "entry"))
        << at;
  }
  Write(file, whole + "x");
  EXPECT_THAT(cache->Read("kind", kKey), IsError(ErrorCode::kParse, "damaged"));
}

TEST_F(CacheTest, ADamagedImageIsLeftOutAndNamed) {
  AddImages();
  IntrinsicSource source;
  source.focal_px = 150;
  const auto scene = SceneFromImages((folder_ / "images").string(), source, {});
  ASSERT_THAT(scene, IsOk());
  Write(folder_ / "images" / "1.png", "gone bad since");
  for (const std::string& cache : {std::string(), CachePath(), CachePath()}) {
    MeasurementOptions options;
    options.cache_folder = cache;
    std::vector<std::string> warnings;
    RunContext context;
    context.log = [&](LogLevel level, const std::string& message) {
      if (level == LogLevel::kWarning) warnings.push_back(message);
    };
    StageLog stages;
    const auto found = MatchImages(*scene, options, context, &stages);
    ASSERT_THAT(found, IsOk());
    EXPECT_EQ(found->features.size(), 2u);
    EXPECT_EQ(found->matches.size(), 1u);
    EXPECT_EQ(found->matches.count({0, 2}), 1u);
    ASSERT_EQ(found->failed.size(), 1u);
    EXPECT_EQ(found->failed.begin()->first, 1u);
    EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("1.png")));
  }
  Write(folder_ / "images" / "0.png", "this one too");
  StageLog stages;
  EXPECT_THAT(MatchImages(*scene, {}, {}, &stages),
              IsError(ErrorCode::kParse, "0.png"));
}

TEST_F(CacheTest, AnEntryUnderAForeignNameIsNotTaken) {
  const auto cache = CacheFolder::Open(CachePath());
  ASSERT_THAT(cache->Write("kind", kKey, "of this key"), IsOk());
  const fs::path file = Entries().front();
  ASSERT_THAT(cache->Write("kind", {7, 7}, "of another"), IsOk());
  fs::copy_file(
      Entries().front() == file ? Entries().back() : Entries().front(), file,
      fs::copy_options::overwrite_existing);
  EXPECT_FALSE(cache->Read("kind", kKey));
}

TEST_F(CacheTest, PruningRemovesWhatWasNotUsedForLongest) {
  const auto cache = CacheFolder::Open(CachePath());
  const auto age = [&](std::uint64_t key, int hours) {
    for (const fs::path& file : Entries()) {
      if (file.string().find(ToHex({0, key})) == std::string::npos) continue;
      fs::last_write_time(
          file, fs::file_time_type::clock::now() - std::chrono::hours(hours));
    }
  };
  for (std::uint64_t key = 1; key <= 4; ++key) {
    ASSERT_THAT(cache->Write("kind", {0, key}, std::string(1000, 'x')), IsOk());
  }
  age(1, 5), age(2, 8), age(3, 6);
  EXPECT_TRUE(cache->Read("kind", {0, 2}).value());  // used: young again
  cache->Prune(3500);
  EXPECT_FALSE(cache->Read("kind", {0, 3}).value());
  EXPECT_EQ(Entries().size(), 3u);
  cache->Prune(0);  // what is of the last hour stays
  EXPECT_EQ(Entries().size(), 2u);
}

TEST_F(CacheTest, WhatAKilledRunLeftIsRemovedLater) {
  fs::create_directories(CachePath());
  const fs::path old = folder_ / "cache" / "features-00.entry.tmp77-0";
  const fs::path fresh = folder_ / "cache" / "features-00.entry.tmp78-0";
  Write(old, "half"), Write(fresh, "half");
  fs::last_write_time(old,
                      fs::file_time_type::clock::now() - std::chrono::hours(2));
  ASSERT_THAT(CacheFolder::Open(CachePath()), IsOk());
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(fresh));  // its writer may be alive
}

TEST_F(CacheTest, AFileInTheWayIsAnError) {
  Write(folder_ / "cache", "a file");
  EXPECT_THAT(CacheFolder::Open(CachePath()), IsError(ErrorCode::kIo, "cache"));
}

TEST_F(CacheTest, FeaturesAndMatchesKeepEveryBit) {
  DetectedFeatures features;
  features.features.points_px = {{0.1, 1e-300}, {-0.0, 3}};
  features.features.segments = {{{1, 2}, {3, 0.1}, 0.7}};
  features.keypoints = {{{0.1, 1e-300}, 2.5, -1}, {{-0.0, 3}, 1, 0.3}};
  features.point_descriptors.resize(2);
  features.point_descriptors[1][127] = 255;
  features.line_descriptors.resize(1);
  features.line_descriptors[0][31] = 7;
  const std::string bytes = ToBytes(features);
  const auto back = FeaturesFromBytes(bytes);
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->features == features.features);
  EXPECT_TRUE(std::signbit(back->features.points_px[1].x()));
  EXPECT_EQ(back->keypoints[1].angle_rad, 0.3);
  EXPECT_EQ(back->point_descriptors, features.point_descriptors);
  EXPECT_EQ(back->line_descriptors, features.line_descriptors);
  EXPECT_EQ(ToBytes(*back), bytes);
  EXPECT_FALSE(FeaturesFromBytes(bytes.substr(1)));
  EXPECT_FALSE(FeaturesFromBytes(bytes + '\0'));

  const PairMatches matches = {{{1, 2}, {3, 4}}, {{5, 6}}};
  const auto matches_back = MatchesFromBytes(ToBytes(matches));
  ASSERT_TRUE(matches_back);
  EXPECT_EQ(matches_back->points, matches.points);
  EXPECT_EQ(matches_back->lines, matches.lines);
}

TEST_F(CacheTest, KeysDependOnImageOptionsAndDistortion) {
  const FeatureOptions options;
  Intrinsic pinhole;
  pinhole.fx_px = pinhole.fy_px = 100;
  const auto key = FeatureKey("image", &pinhole, options);
  EXPECT_EQ(key, FeatureKey("image", &pinhole, options));
  EXPECT_NE(key, FeatureKey("imagE", &pinhole, options));
  Intrinsic other = pinhole;
  other.fx_px = 120;  // straight lines are straight at any focal length
  EXPECT_EQ(key, FeatureKey("image", &other, options));
  other.model = CameraModel::kRadialK1;
  other.distortion = {-0.1};
  const auto distorted = FeatureKey("image", &other, options);
  EXPECT_NE(key, distorted);
  other.distortion = {-0.2};
  EXPECT_NE(distorted, FeatureKey("image", &other, options));
  FeatureOptions fewer = options;
  fewer.points.max_points = 11;
  EXPECT_NE(key, FeatureKey("image", &pinhole, fewer));
  fewer = options;
  fewer.lines.min_length_ratio = 0.5;
  EXPECT_NE(key, FeatureKey("image", &pinhole, fewer));
  fewer = options;
  fewer.max_memory_gb = 1;
  EXPECT_EQ(key, FeatureKey("image", &pinhole, fewer));

  const MatchOptions matching;
  MatchOptions stricter;
  stricter.points.max_ratio = 0.5;
  EXPECT_NE(MatchKey(key, distorted, matching),
            MatchKey(distorted, key, matching));
  EXPECT_NE(MatchKey(key, distorted, matching),
            MatchKey(key, distorted, stricter));
}

TEST_F(CacheTest, AWarmCacheGivesTheSameScene) {
  AddImages();
  MeasurementOptions options;
  const Run cold = Measure();
  ASSERT_THAT(cold.scene, IsOk());
  EXPECT_THAT(cold.log, Not(Contains(HasSubstr("from the cache"))));
  // Features and matches, of tilted images too: these pairs are starved.
  EXPECT_EQ(Entries().size(), 2 * (3u + 3u));
  const Run warm = Measure();
  ASSERT_THAT(warm.scene, IsOk());
  EXPECT_TRUE(*warm.scene == *cold.scene);
  EXPECT_THAT(warm.log, Contains(HasSubstr("features: 3 of 3 from the cache")));
  EXPECT_THAT(warm.log, Contains(HasSubstr("matches: 3 of 3 from the cache")));
  EXPECT_EQ(Entries().size(), 12u);
  options.matching.points.max_ratio = 0.7;
  const Run changed = Measure(options);
  EXPECT_THAT(changed.log, Contains(HasSubstr("features: 3 of 3")));
  EXPECT_THAT(changed.log, Not(Contains(HasSubstr("matches:"))));
  EXPECT_EQ(Entries().size(), 18u);
}

TEST_F(CacheTest, AChangedImageIsDetectedAnewWithItsPairs) {
  AddImages();
  ASSERT_THAT(Measure().scene, IsOk());
  fs::copy_file(folder_ / "images/0.png", folder_ / "images/2.png",
                fs::copy_options::overwrite_existing);
  const Run run = Measure();
  // Image 2 is found by content, though under another name.
  EXPECT_THAT(run.log, Contains(HasSubstr("features: 3 of 3")));
  EXPECT_THAT(run.log, Contains(HasSubstr("matches: 1 of 3")));
}

TEST_F(CacheTest, DamagedEntriesAreComputedAnewWithAWarning) {
  AddImages();
  const Run cold = Measure();
  for (const fs::path& file : Entries()) {
    fs::resize_file(file, fs::file_size(file) / 2);
  }
  const Run repaired = Measure();
  ASSERT_THAT(repaired.scene, IsOk());
  EXPECT_TRUE(*repaired.scene == *cold.scene);
  EXPECT_THAT(repaired.log, Contains(HasSubstr("computed anew")));
  EXPECT_THAT(Measure().log, Contains(HasSubstr("features: 3 of 3")));
}

TEST_F(CacheTest, AStoppedRunIsTakenUpWhereItWas) {
  AddImages();
  const Run cold = Measure();
  fs::remove_all(CachePath());
  MeasurementOptions options;
  const Run stopped = Measure(
      options, [](const std::string& stage, std::size_t done, std::size_t) {
        return !(stage == "features" && done == 2);
      });
  EXPECT_THAT(stopped.scene, IsError(ErrorCode::kCancelled, "stopped"));
  const std::size_t left = Entries().size();
  EXPECT_GE(left, 2u);
  const Run resumed = Measure();
  EXPECT_THAT(
      resumed.log,
      Contains(HasSubstr("features: " + std::to_string(left) + " of 3")));
  EXPECT_TRUE(*resumed.scene == *cold.scene);
}

}  // namespace
}  // namespace lowlap
