#include "lowlap/report/internal/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lowlap/report/internal/base64.h"
#include "lowlap/report/internal/display_frame.h"
#include "lowlap/report/internal/page_data.h"
#include "lowlap/report/internal/page_source.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

template <class Number>
std::vector<Number> Decode(const std::string& base64) {
  std::string bytes;
  unsigned group = 0;
  int num_bits = 0;
  for (const char c : base64) {
    const std::string digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (c == '=') break;
    group = group << 6 | static_cast<unsigned>(digits.find(c));
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    bytes += static_cast<char>(group >> num_bits & 0xFF);
  }
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (numbers.empty()) return numbers;  // memcpy takes no null
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

TEST(Base64, IsThatOfTheRfc) {
  EXPECT_EQ(Base64(std::string_view("")), "");
  EXPECT_EQ(Base64(std::string_view("f")), "Zg==");
  EXPECT_EQ(Base64(std::string_view("fo")), "Zm8=");
  EXPECT_EQ(Base64(std::string_view("foo")), "Zm9v");
  EXPECT_EQ(Base64(std::string_view("\xff\xfe\xfd")), "//79");
  EXPECT_THAT(Decode<float>(Base64(std::vector<float>{1.5f, -2.0f})),
              ElementsAre(1.5f, -2.0f));
}

Scene Room(int num_views, int points_per_wall) {
  SyntheticOptions options;
  options.num_views = num_views;
  options.points_per_wall = points_per_wall;
  return TrueSolution(*Simulate(options));
}

// What a run would say of the scene.
ReportContent ContentOf(const Scene& scene) {
  ReportContent content;
  content.title = "lowlap run";
  content.figures = {{"cameras placed", "7 of 7"}};
  content.warnings = {{"of a view", {scene.views.begin()->first}}};
  for (const auto& [views, pose] : scene.relative_poses) {
    ReportPair pair;
    pair.views = views;
    pair.is_used = true;
    pair.log10_nfa = -12;
    content.pairs.push_back(pair);
  }
  ReportStage before;
  before.poses = scene.poses;
  for (const auto& [id, landmark] : scene.structure) {
    before.points[id] = landmark.position;
  }
  content.before_adjustment = before;
  ReportTruth truth;
  for (const auto& [id, view] : scene.views) {
    truth.poses[id] = *scene.FindPose(id);
    truth.position_errors[id] = 0.25;
  }
  content.truth = truth;
  return content;
}

TEST(PageData, HasAllSections) {
  Scene scene = Room(7, 60);
  const double deviation = 0.1 / ChooseDisplayFrame(scene).scale;
  for (auto& [id, pose] : scene.poses) {
    pose.center_covariance =
        Vec3(0, 1, 0.5).asDiagonal() * Mat3::Identity() * deviation * deviation;
  }
  scene.scale_ratios.push_back({});
  scene.scale_ratios.back().views = {0, 1, 2};
  scene.scale_ratios.back().verdict = RatioVerdict::kMeaningful;
  scene.scale_ratios.back().log10_nfa = -40;
  ReportContent content = ContentOf(scene);
  content.profiles[{0, 1, 2}] = {
      {-1, 0, 1}, {0, -4000, 0}, {{"lines", {0, -40, 0}}}};
  const json page = json::parse(PageData(scene, content));
  for (const char* section :
       {"title", "figures", "warnings", "views", "points", "lines",
        "coplanar_pairs", "pairs", "triplets", "residuals", "thinning"}) {
    EXPECT_TRUE(page.contains(section)) << section;
  }
  ASSERT_EQ(page["views"].size(), 7u);
  for (const json& view : page["views"]) {
    // Every camera lies within the frame, as it was before and as it is true.
    for (const char* camera : {"camera", "camera_before", "camera_true"}) {
      ASSERT_TRUE(view.contains(camera)) << camera;
      double square = 0;
      for (const double x : view[camera]["center"]) square += x * x;
      EXPECT_LT(std::sqrt(square), 1 + 1e-6) << camera;
    }
    EXPECT_EQ(view["position_error"], 0.25);
    EXPECT_NEAR(view["center_stddev"], 0.1, 1e-9);
    const auto landmarks = Decode<std::uint32_t>(view["features"]["landmarks"]);
    EXPECT_EQ(Decode<std::uint16_t>(view["features"]["points"]).size(),
              2 * landmarks.size());
    for (const std::uint32_t landmark : landmarks) {
      EXPECT_TRUE(landmark == 0xFFFFFFFF || landmark < scene.structure.size());
    }
  }
  EXPECT_EQ(Decode<float>(page["points"]["positions"]).size(),
            3 * scene.structure.size());
  EXPECT_EQ(Decode<float>(page["points"]["before"]),
            Decode<float>(page["points"]["positions"]));
  EXPECT_EQ(Decode<float>(page["lines"]["positions"]).size(),
            6 * scene.line_structure.size());
  EXPECT_TRUE(std::isnan(Decode<float>(page["lines"]["before"]).front()));
  EXPECT_EQ(page["warnings"][0]["views"], json::array({0}));
  const json& triplet = page["triplets"][0];
  EXPECT_THAT(Decode<float>(triplet["profile"]["total"]),
              ElementsAre(0, -4000, 0));
  EXPECT_TRUE(triplet.contains("true_log_ratio"));
  // The truth has no residuals but rounding, on every observation.
  const json& points = page["residuals"]["points"];
  EXPECT_GT(points["after"]["total"], 300);
  EXPECT_NEAR(points["after"]["rmse_px"].get<double>(), 0, 2);
  EXPECT_EQ(points["before"]["total"], points["after"]["total"]);
  EXPECT_LE(points["after"]["median_px"], points["after"]["rmse_px"]);
  EXPECT_EQ(points["views"].size(), 7u);
}

TEST(PageData, MatchesReferToTheFeaturesThatAreKept) {
  const Scene scene = Room(5, 100);
  PageLimits limits;
  limits.features = 300;
  limits.points = 100;
  const json page = json::parse(PageData(scene, ContentOf(scene), limits));
  EXPECT_GT(page["thinning"]["feature_stride"], 1);
  EXPECT_LE(Decode<float>(page["points"]["positions"]).size(), 300u);
  std::size_t num_matches = 0;
  for (const json& pair : page["pairs"]) {
    const auto places = Decode<std::uint32_t>(pair["points"]);
    num_matches += places.size() / 2;
    for (std::size_t n = 0; n < places.size(); ++n) {
      const json& view = page["views"][pair["views"][n % 2].get<int>()];
      ASSERT_LT(places[n],
                Decode<std::uint16_t>(view["features"]["points"]).size() / 2);
    }
  }
  EXPECT_GT(num_matches, 20u);
}

TEST(PageData, KeepsThePairsInUseAndTheRatiosOfMostEvidence) {
  Scene scene = Room(6, 20);
  for (std::uint32_t n = 0; n < 4; ++n) {
    ScaleRatio ratio;
    ratio.views = {n, n + 1, n + 2};
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log10_nfa = n % 2 == 0 ? -5 : -50;
    scene.scale_ratios.push_back(ratio);
  }
  ReportContent content = ContentOf(scene);
  for (std::size_t n = 0; n < content.pairs.size(); ++n) {
    content.pairs[n].is_used = n == 1;
    content.pairs[n].log10_nfa = n == 3 ? -99 : -9;
  }
  PageLimits limits;
  limits.pairs = 2;
  limits.triplets = 2;
  const json page = json::parse(PageData(scene, content, limits));
  ASSERT_EQ(page["pairs"].size(), 2u);
  EXPECT_EQ(page["pairs"][0]["used"], true);
  EXPECT_EQ(page["pairs"][1]["log10_nfa"], -99);
  EXPECT_EQ(page["thinning"]["num_pairs"], content.pairs.size());
  EXPECT_EQ(page["thinning"]["num_used_pairs"], 1);
  ASSERT_EQ(page["triplets"].size(), 2u);
  EXPECT_EQ(page["triplets"][0]["views"], json({1, 2, 3}));
  EXPECT_EQ(page["triplets"][1]["views"], json({3, 4, 5}));
  EXPECT_EQ(page["thinning"]["num_meaningful"], scene.scale_ratios.size());

  // One with a profile is one that matters.
  content.profiles = {{{2, 3, 4}, {}}};
  const json asked = json::parse(PageData(scene, content, limits));
  ASSERT_EQ(asked["triplets"].size(), 2u);
  EXPECT_EQ(asked["triplets"][0]["views"], json({2, 3, 4}));
}

TEST(PageData, IsSafeInAScriptElement) {
  Scene scene = Room(3, 20);
  scene.views.begin()->second.filename =
      "</script><script>bad()</script><!-- \xff \"quoted\".jpg";
  ReportContent content = ContentOf(scene);
  content.title = "a <b> & c";
  content.warnings.push_back({"</ScRiPt>", {}});
  content.notes.push_back("1 < 2");
  const std::string data = PageData(scene, content);
  EXPECT_THAT(data, Not(HasSubstr("<")));
  const json page = json::parse(data);
  EXPECT_THAT(page["views"][0]["name"].get<std::string>(),
              HasSubstr("</script><script>bad()</script><!-- "));
  EXPECT_EQ(page["title"], "a <b> & c");
  EXPECT_EQ(page["notes"], json::array({"1 < 2"}));

  const std::string html = FormatReport(scene, content);
  EXPECT_THAT(html, HasSubstr("<title>a &lt;b&gt; &amp; c</title>"));
  EXPECT_THAT(html, Not(HasSubstr("bad()</script>")));
}

TEST(PageData, OfAnEmptySceneParses) {
  const json page = json::parse(PageData(Scene(), ReportContent()));
  EXPECT_TRUE(page["views"].empty());
  EXPECT_EQ(page["residuals"]["points"]["after"]["total"], 0);
}

TEST(PageData, ShowsTheSolutionBeforeTheAdjustmentInItsGauge) {
  const Scene scene = Room(5, 50);
  ReportContent content = ContentOf(scene);
  // The same solution, twice as large and elsewhere.
  ReportStage& before = *content.before_adjustment;
  for (auto& [id, pose] : before.poses) {
    pose.center = 2 * pose.center + Vec3(1, 2, 3);
  }
  for (auto& [id, point] : before.points) point = 2 * point + Vec3(1, 2, 3);
  const json page = json::parse(PageData(scene, content));
  const auto after = Decode<float>(page["points"]["positions"]);
  const auto aligned = Decode<float>(page["points"]["before"]);
  ASSERT_EQ(after.size(), aligned.size());
  for (std::size_t n = 0; n < after.size(); ++n) {
    EXPECT_NEAR(after[n], aligned[n], 1e-5);
  }
}

// Where noise moves centres on a line, they do not tell how the scene turned.
TEST(PageData, CamerasOnALineAreAlignedByTheirRotations) {
  Scene scene = Room(5, 50);
  int place = 0;
  for (auto& entry : scene.poses) {
    ++place;
    entry.second.center = Vec3(place, 0.001 * (place / 2 % 2), 0);
  }
  ReportContent content = ContentOf(scene);
  place = 0;
  for (auto& entry : content.before_adjustment->poses) {
    ++place;
    entry.second.center = Vec3(place, 0.001 * (place % 2), 0.001 * (place % 3));
  }
  const json page = json::parse(PageData(scene, content));
  const auto after = Decode<float>(page["points"]["positions"]);
  const auto aligned = Decode<float>(page["points"]["before"]);
  ASSERT_EQ(after.size(), aligned.size());
  for (std::size_t n = 0; n < after.size(); ++n) {
    EXPECT_NEAR(after[n], aligned[n], 0.05);
  }
}

// The size that a page of usual photographs has at most.
TEST(FormatReport, StaysSmall) {
  Scene scene = Room(30, 0);
  // Every view sees six thousand points, each of them seen by four neighbours.
  for (std::uint32_t n = 0; n < 50000; ++n) {
    const double angle = 0.7 * n;
    Landmark& landmark = scene.structure[n];
    landmark.position = Vec3(std::cos(angle), std::sin(angle), 1e-4 * n);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const ViewId view = (n + k) % 30;
      ViewFeatures& features = scene.features[view];
      const auto feature = static_cast<FeatureIndex>(features.points_px.size());
      features.points_px.emplace_back(n % 1201, n % 797);
      landmark.observations.push_back(
          {view, feature, features.points_px.back()});
      scene.point_tracks[n].push_back({view, feature});
    }
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = k + 1; l < 4; ++l) {
        const PointObservation& a = landmark.observations[k];
        const PointObservation& b = landmark.observations[l];
        RelativePose& pose = scene.relative_poses[{std::min(a.view, b.view),
                                                   std::max(a.view, b.view)}];
        pose.point_inliers.push_back(a.view < b.view
                                         ? FeatureMatch{a.feature, b.feature}
                                         : FeatureMatch{b.feature, a.feature});
      }
    }
  }
  for (auto& [views, pose] : scene.relative_poses) pose.views = views;
  ReportContent content = ContentOf(scene);
  for (const auto& [id, view] : scene.views) {
    content.photographs[id] = std::string(45000, 'x');
    content.detected[id].points_px.assign(20000, Vec2(5, 5));
    content.detected[id].segments.resize(3000);
  }
  for (std::uint32_t n = 0; n < 1000; ++n) {
    ScaleRatio ratio;
    ratio.views = {n % 30, (n + 1) % 30, (n + 2 + n / 30) % 30};
    ratio.verdict = RatioVerdict::kMeaningful;
    scene.scale_ratios.push_back(ratio);
    const std::vector<double> values(80, -5.0);
    content.profiles[ratio.views] = {
        values,
        values,
        {{"points", values}, {"lines", values}, {"coplanar", values}}};
  }
  const std::string page = FormatReport(scene, content);
  EXPECT_LT(page.size(), 15e6);
  EXPECT_GT(page.size(), 4e6);
}

TEST(FormatReport, HoldsAllThatThePageNeeds) {
  const std::string page = FormatReport(Room(3, 10), ReportContent());
  EXPECT_THAT(page, HasSubstr("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr(std::string(kPageSource.style.substr(0, 60))));
  EXPECT_THAT(page, HasSubstr(std::string(kPageSource.script.substr(0, 60))));
  // Nothing is fetched.
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("<link rel=\"stylesheet\"")));
}

}  // namespace
}  // namespace lowlap
