#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/openmvg_vectors.h"
#include "adapters/temporary_folder.h"
#include "third_party_adapters/openmvg/internal/import.h"
#include "third_party_adapters/openmvg/internal/sfm_data_bin.h"

namespace lowlap::openmvg {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The project of kTwoViewsHex: images sub/b.jpg (view 1) and a.jpg (view 0),
/// 10 features each.
class OpenMvgImport : public ::testing::Test {
 protected:
  OpenMvgImport() {
    listing_ = folder_.Write("listing/sfm_data.bin", FromHex(kTwoViewsHex));
    std::string features_a, features_b;
    for (int n = 0; n < 10; ++n) {
      features_a += std::to_string(n) + " 0.5 1 0\n";
      features_b += std::to_string(n) + " 7.25 1 0\n";
    }
    folder_.Write("matches/a.feat", features_a);
    folder_.Write("matches/b.feat", features_b);
    folder_.Write("matches/matches.e.txt", "0 1\n2\n3 4\n5 9\n");
  }

  Result<ImportedProject> Import(const ImportOptions& options = {}) const {
    return ImportProject(listing_, folder_.Path("matches"), options);
  }

  TemporaryFolder folder_;
  std::string listing_;
};

TEST_F(OpenMvgImport, GivesViewsFeaturesAndMatchesButNoPoses) {
  const auto project = Import();
  ASSERT_TRUE(project.has_value()) << project.error().ToString();
  const Scene& scene = project->scene;
  EXPECT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(scene.intrinsics.size(), 1u);
  EXPECT_EQ(scene.root_path, "/data/images");
  EXPECT_TRUE(scene.poses.empty());
  EXPECT_TRUE(scene.structure.empty());
  ASSERT_EQ(scene.features.at(0).points_px.size(), 10u);
  EXPECT_EQ(scene.features.at(0).points_px[3], Vec2(3, 0.5));
  EXPECT_EQ(scene.features.at(1).points_px[4], Vec2(4, 7.25));
  ASSERT_EQ(project->matches.size(), 1u);
  EXPECT_THAT(project->matches.at({0, 1}),
              ElementsAre(FeatureMatch{3, 4}, FeatureMatch{5, 9}));
  EXPECT_EQ(project->num_dropped_pairs, 0);
  EXPECT_EQ(project->match_file, folder_.Path("matches/matches.e.txt"));
}

TEST_F(OpenMvgImport, LooksForTheMatchFileInTheOrderOfTheHost) {
  const auto used = [&] {
    const auto project = Import();
    EXPECT_TRUE(project.has_value());
    return std::filesystem::path(project->match_file).filename().string();
  };
  std::filesystem::remove(folder_.Path("matches/matches.e.txt"));
  for (const char* name :
       {"matches.putative.bin", "matches.putative.txt", "matches.e.bin",
        "matches.e.txt", "matches.f.bin", "matches.f.txt"}) {
    const bool is_text = std::string(name).find(".txt") != std::string::npos;
    folder_.Write(std::string("matches/") + name,
                  is_text ? "0 1\n1\n1 1\n"
                          : FromHex("01"
                                    "0100000000000000"
                                    "00000000"
                                    "01000000"
                                    "0100000000000000"
                                    "01000000"
                                    "01000000"));
    EXPECT_EQ(used(), name);
  }
  ImportOptions options;
  options.match_file = "matches.e.bin";
  EXPECT_EQ(Import(options)->match_file, folder_.Path("matches/matches.e.bin"));
  options.match_file = folder_.Write("other.txt", "0 1\n0\n");
  EXPECT_TRUE(Import(options)->matches.at({0, 1}).empty());
}

TEST_F(OpenMvgImport, PairsOfUnknownViewsAreDroppedAndCounted) {
  folder_.Write("matches/matches.e.txt",
                "0 1\n1\n3 4\n0 7\n1\n99 99\n7 8\n0\n");
  const auto project = Import();
  ASSERT_TRUE(project.has_value()) << project.error().ToString();
  EXPECT_EQ(project->matches.size(), 1u);
  EXPECT_EQ(project->num_dropped_pairs, 2);
}

TEST_F(OpenMvgImport, AnIndexBeyondTheFeaturesIsNamed) {
  folder_.Write("matches/matches.e.txt", "0 1\n2\n3 4\n5 10\n");
  const auto project = Import();
  ASSERT_FALSE(project.has_value());
  EXPECT_EQ(project.error().code, ErrorCode::kInvalidScene);
  EXPECT_EQ(project.error().file, folder_.Path("matches/matches.e.txt"));
  EXPECT_EQ(project.error().place, "pair (0, 1), match 1");
  EXPECT_THAT(project.error().message,
              HasSubstr("feature 10 does not exist: view 1 has 10"));
}

TEST_F(OpenMvgImport, MissingFilesAreNamed) {
  const auto missing = [&] {
    const auto project = Import();
    EXPECT_FALSE(project.has_value());
    EXPECT_EQ(project.error().code, ErrorCode::kNotFound);
    return project.error().file;
  };
  std::filesystem::remove(folder_.Path("matches/b.feat"));
  EXPECT_EQ(missing(), folder_.Path("matches/b.feat"));
  std::filesystem::remove(folder_.Path("matches/matches.e.txt"));
  EXPECT_EQ(missing(), folder_.Path("matches"));
  std::filesystem::remove(listing_);
  EXPECT_EQ(missing(), listing_);
}

TEST_F(OpenMvgImport, ImagesThatShareAFeatureFileAreAnError) {
  Scene scene = *ParseSfmDataBin(FromHex(kTwoViewsHex));
  scene.views.at(1).filename = "a.png";
  folder_.Write("listing/sfm_data.bin", SerializeSfmDataBin(scene));
  const auto project = Import();
  ASSERT_FALSE(project.has_value());
  EXPECT_EQ(project.error().code, ErrorCode::kInvalidScene);
  EXPECT_EQ(project.error().file, folder_.Path("matches/a.feat"));
}

}  // namespace
}  // namespace lowlap::openmvg
