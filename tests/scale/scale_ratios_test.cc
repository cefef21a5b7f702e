#include "lowlap/scale/scale_ratios.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/evidence/internal/coplanar_lines.h"
#include "lowlap/scale/evidence/internal/plane_points.h"
#include "lowlap/scale/internal/planes/planes_by_pair.h"
#include "lowlap/scale/internal/search/ratio_profile.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/validation.h"
#include "lowlap/scene/view_graph.h"
#include "scale/row_of_views.h"

namespace lowlap {
namespace {

using testing::RowOfViews;

TEST(EstimateScaleRatios, FindsTheRatioOfEveryTriplet) {
  const RowOfViews row;
  const Result<std::vector<ScaleRatio>> ratios =
      EstimateScaleRatios(row.scene, {}, {});
  ASSERT_TRUE(ratios.has_value()) << ratios.error().ToString();
  ASSERT_EQ(ratios->size(), 12u);
  for (const ScaleRatio& ratio : *ratios) {
    EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
    EXPECT_NEAR(ratio.log_ratio, row.TrueLogRatio(ratio.views),
                4 * ratio.log_ratio_stddev);
    EXPECT_LT(ratio.log_ratio_stddev, 0.01);
    EXPECT_GT(ratio.FindKind("points")->inliers, 20);
    EXPECT_GT(ratio.FindKind("coplanar")->inliers, 20);
  }
}

TEST(EstimateScaleRatios, AreTheSameForAnyNumberOfThreads) {
  const RowOfViews row;
  RunContext one, two;
  one.num_threads = 1;
  two.num_threads = 2;
  const auto a = EstimateScaleRatios(row.scene, {}, one);
  const auto b = EstimateScaleRatios(row.scene, {}, two);
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_TRUE(*a == *b);
}

TEST(EstimateScaleRatios, PlanePointsHaveNoSayWhereOthersDecide) {
  const RowOfViews row;
  ScaleOptions without;
  without.without = {"plane_points"};
  const auto a = EstimateScaleRatios(row.scene, {}, {});
  const auto b = EstimateScaleRatios(row.scene, without, {});
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_TRUE(*a == *b);
}

// Where `x2` of view 2 would be if the baseline of views 1 and 2 were
// `factor` times as long: on the epipolar line of `x1`.
Vec2 AlongEpipolarLine(const RowOfViews& row, const Vec2& x1_px,
                       const Vec2& x2_px, double factor) {
  const Intrinsic& intrinsic = row.scene.intrinsics.at(0);
  const RelativePose& pose = row.scene.relative_poses.at({1, 2});
  const Vec3 x1 = *intrinsic.Bearing(x1_px), x2 = *intrinsic.Bearing(x2_px);
  const Vec3 ray = pose.rotation * x1;
  const Vec3 step = row.baselines.at({1, 2}) * pose.direction;
  const Vec3 across = x2.cross(ray);
  const double depth = -x2.cross(step).dot(across) / across.squaredNorm();
  return intrinsic.Project(depth * ray + factor * step);
}

// Three quarters of what is seen are matched to copies farther along.
Scene WithCopies(const RowOfViews& row, double factor) {
  Scene scene = row.scene;
  const ViewFeatures& seen1 = row.scene.features.at(1);
  ViewFeatures& seen2 = scene.features.at(2);
  for (FeatureIndex n = 0; n < 45; ++n) {
    seen2.points_px[n] =
        AlongEpipolarLine(row, seen1.points_px[n], seen2.points_px[n], factor);
  }
  for (FeatureIndex n = 0; n < 30; ++n) {
    const LineSegment& segment = seen1.segments[n];
    LineSegment& copy = seen2.segments[n];
    copy.start_px =
        AlongEpipolarLine(row, segment.start_px, copy.start_px, factor);
    copy.end_px = AlongEpipolarLine(row, segment.end_px, copy.end_px, factor);
  }
  return scene;
}

void SayWhatRepeats(Scene* scene) {
  ViewFeatures& features = scene->features.at(1);
  for (FeatureIndex n = 0; n < 45; ++n) features.repeated_points.push_back(n);
  for (FeatureIndex n = 0; n < 30; ++n) features.repeated_segments.push_back(n);
}

TEST(EstimateScaleRatios, HearWhatDoesNotRepeat) {
  const RowOfViews row;
  const ViewTriplet views{0, 1, 2};
  const double factor = 1.6;
  Scene scene = WithCopies(row, factor);
  const auto copies = EstimateScaleRatios(scene, {views}, {}, {});
  ASSERT_TRUE(copies.has_value());
  EXPECT_NEAR(copies->front().log_ratio,
              row.TrueLogRatio(views) + std::log(factor), 0.02);

  SayWhatRepeats(&scene);
  const auto heard = EstimateScaleRatios(scene, {views}, {}, {});
  ASSERT_TRUE(heard.has_value());
  const ScaleRatio& ratio = heard->front();
  EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
  EXPECT_NEAR(ratio.log_ratio, row.TrueLogRatio(views), 0.02);
  ASSERT_TRUE(ratio.second_mode.has_value());
  EXPECT_EQ(ratio.second_mode->log_ratio, copies->front().log_ratio);
}

TEST(EstimateScaleRatios, OfCopiesAloneAreNotMeaningful) {
  Scene scene = RowOfViews().scene;
  const auto before = EstimateScaleRatios(scene, {}, {});
  ViewFeatures& features = scene.features.at(1);
  features.repeated_points.resize(features.points_px.size());
  std::iota(features.repeated_points.begin(), features.repeated_points.end(),
            FeatureIndex{0});
  features.repeated_segments.resize(features.segments.size());
  std::iota(features.repeated_segments.begin(),
            features.repeated_segments.end(), FeatureIndex{0});
  const auto after = EstimateScaleRatios(scene, {}, {});
  ASSERT_TRUE(before.has_value() && after.has_value());
  ASSERT_EQ(before->size(), after->size());
  int num_of_copies = 0;
  for (std::size_t n = 0; n < before->size(); ++n) {
    const ScaleRatio &all = (*before)[n], &ratio = (*after)[n];
    EXPECT_EQ(all.verdict, RatioVerdict::kMeaningful);
    EXPECT_EQ(ratio.log_ratio, all.log_ratio);
    const ViewTriplet& views = ratio.views;
    if (views.first == 1u || views.middle == 1u || views.last == 1u) {
      EXPECT_EQ(ratio.verdict, RatioVerdict::kNotMeaningful);
      EXPECT_GE(ratio.log10_nfa, 0);
      ++num_of_copies;
    } else {
      EXPECT_TRUE(ratio == all);
    }
  }
  EXPECT_GE(num_of_copies, 1);
}

TEST(EstimateScaleRatios, KeepWhatRepeatsWhereItAgrees) {
  const RowOfViews row;
  Scene scene = row.scene;
  const auto before = EstimateScaleRatios(scene, {}, {});
  SayWhatRepeats(&scene);
  const auto after = EstimateScaleRatios(scene, {}, {});
  ASSERT_TRUE(before.has_value() && after.has_value());
  EXPECT_TRUE(*before == *after);
}

// Views 0, 1, 2 and two pairs, which match points of the middle view alone: the
// first those left of 600 pixels, the second those right of `begin_px`.
Scene TwoPairs(double begin_px) {
  Scene scene = RowOfViews().scene;
  RelativePose first = *scene.FindRelativePose(0, 1);
  RelativePose last = *scene.FindRelativePose(1, 2);
  const std::vector<Vec2>& in_middle = scene.features.at(1).points_px;
  for (RelativePose* pose : {&first, &last}) {
    pose->line_inliers.clear();
    pose->point_inliers.clear();
  }
  for (FeatureIndex n = 0; n < in_middle.size(); ++n) {
    const double x = in_middle[n].x();
    if (x < 600 && n % 2 == 0) first.point_inliers.push_back({n, n});
    if (x > begin_px && n % 2 == 1) last.point_inliers.push_back({n, n});
  }
  scene.relative_poses = {{first.views, first}, {last.views, last}};
  return scene;
}

TEST(PairsOverlap, WhereverThereArePlanePoints) {
  int num_apart = 0, num_with_plane_points = 0;
  for (const double begin_px : {-100.0, 200.0, 400.0, 600.0, 700.0}) {
    const Scene scene = TwoPairs(begin_px);
    const SceneFeatures features(scene);
    const ViewTriplet views{0, 1, 2};
    const bool overlap = PairsOverlap(features, views);
    EXPECT_EQ(overlap, begin_px < 600);
    const auto triplet = MakeTripletView(features, views);
    ASSERT_TRUE(triplet.has_value());
    const auto kind = PlanePointsKind().Prepare(features, {views}, {});
    ASSERT_TRUE(kind.has_value());
    const bool has_plane_points = (*kind)->Gather(*triplet)->size() > 0;
    EXPECT_TRUE(overlap || !has_plane_points);
    num_with_plane_points += has_plane_points;
    num_apart += !overlap;
  }
  EXPECT_GE(num_with_plane_points, 2);
  EXPECT_EQ(num_apart, 2);
}

TEST(EstimateScaleRatios, PairsThatDoNotOverlapPayForNoSecondTest) {
  const Scene scene = TwoPairs(600);
  ScaleOptions without;
  without.without = {"plane_points"};
  const auto a = EstimateScaleRatios(scene, {}, {});
  const auto b = EstimateScaleRatios(scene, without, {});
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_TRUE(*a == *b);
}

// No line, and no point in two pairs: nothing but places on planes is left.
void KeepPlacesOnPlanes(Scene* scene) {
  for (auto& [views, pose] : scene->relative_poses) {
    pose.line_inliers.clear();
    const FeatureIndex slot = (views.first.value() + views.second.value()) % 3;
    auto& points = pose.point_inliers;
    points.erase(std::remove_if(points.begin(), points.end(),
                                [&](const FeatureMatch& match) {
                                  return match.first % 3 != slot;
                                }),
                 points.end());
  }
}

// What repeats is left out in all rounds, and the others hear it in all.
TEST(EstimateScaleRatios, HearWhatDoesNotRepeatInAllRounds) {
  Scene scene = RowOfViews().scene;
  KeepPlacesOnPlanes(&scene);
  const auto before = EstimateScaleRatios(scene, {}, {});
  for (auto& entry : scene.features) entry.second.repeated_points = {0, 1, 2};
  const auto after = EstimateScaleRatios(scene, {}, {});
  for (auto& entry : scene.features) {
    std::vector<FeatureIndex>& repeated = entry.second.repeated_points;
    repeated.resize(entry.second.points_px.size());
    std::iota(repeated.begin(), repeated.end(), FeatureIndex{0});
  }
  const auto of_copies = EstimateScaleRatios(scene, {}, {});
  ASSERT_TRUE(before.has_value() && after.has_value() && of_copies.has_value());
  int num_meaningful = 0;
  for (std::size_t n = 0; n < before->size(); ++n) {
    num_meaningful += (*before)[n].verdict == RatioVerdict::kMeaningful;
    EXPECT_EQ((*after)[n].verdict, (*before)[n].verdict);
    EXPECT_NE((*of_copies)[n].verdict, RatioVerdict::kMeaningful);
  }
  EXPECT_GT(num_meaningful, 0);
}

// With lines that decide, and with nothing but places on planes.
TEST(ProfileScaleRatios, AreThoseOfTheEstimatedRatios) {
  for (const bool has_lines : {true, false}) {
    RowOfViews row;
    if (!has_lines) KeepPlacesOnPlanes(&row.scene);
    const auto ratios = EstimateScaleRatios(row.scene, {}, {});
    const auto profiles =
        ProfileScaleRatios(row.scene, FindTriplets(ViewGraph(row.scene)),
                           MakeScaleEstimator({})->kinds(), {});
    ASSERT_TRUE(ratios.has_value() && profiles.has_value());
    ASSERT_EQ(profiles->size(), ratios->size());
    int with_nodes = 0;
    for (std::size_t n = 0; n < ratios->size(); ++n) {
      const RatioProfile& profile = (*profiles)[n];
      EXPECT_TRUE(profile.ratio == (*ratios)[n]);
      if (profile.nodes.empty()) continue;
      ++with_nodes;
      if ((*ratios)[n].verdict != RatioVerdict::kMeaningful) continue;
      EXPECT_NEAR(profile.mode.nfa.log10_nfa, (*ratios)[n].log10_nfa, 1e-9);
    }
    EXPECT_GT(with_nodes, 0) << has_lines;

    // A sketch asks the same kinds, and evaluates the same NFA.
    const auto sketches = SketchScaleRatios(
        row.scene, *ratios, MakeScaleEstimator({})->kinds(), {});
    ASSERT_TRUE(sketches.has_value());
    for (std::size_t n = 0; n < ratios->size(); ++n) {
      const RatioProfile& sketch = (*sketches)[n];
      const std::vector<RatioOptimum>& nodes = (*profiles)[n].nodes;
      EXPECT_EQ(sketch.kinds, (*profiles)[n].kinds);
      EXPECT_LE(sketch.nodes.size(), nodes.size());
      EXPECT_EQ(sketch.nodes.empty(), nodes.empty());
      if (nodes.empty()) continue;
      EXPECT_EQ(sketch.nodes.front().log_ratio, nodes.front().log_ratio);
      EXPECT_EQ(sketch.nodes.front().nfa.log10_nfa,
                nodes.front().nfa.log10_nfa);
      EXPECT_EQ(sketch.nodes.back().nfa.log10_nfa, nodes.back().nfa.log10_nfa);
    }
  }
}

TEST(EstimateScaleRatios, DoNotDependOnTheWorldFrame) {
  const RowOfViews row;
  const RowOfViews turned(RotationFromAngleAxis({0.7, -1.1, 0.4}), 250.0);
  const auto a = EstimateScaleRatios(row.scene, {}, {});
  const auto b = EstimateScaleRatios(turned.scene, {}, {});
  ASSERT_TRUE(a.has_value() && b.has_value());
  for (std::size_t n = 0; n < a->size(); ++n) {
    EXPECT_NEAR((*a)[n].log_ratio, (*b)[n].log_ratio, 1e-6);
    EXPECT_NEAR((*a)[n].log10_nfa, (*b)[n].log10_nfa, 1e-6);
    EXPECT_EQ((*a)[n].NumInliers(), (*b)[n].NumInliers());
  }
}

TEST(EstimateScaleRatios, WorkWhenNoFeatureIsSeenThrice) {
  RowOfViews row;
  // Every feature goes to one pair only.
  for (auto& [views, pose] : row.scene.relative_poses) {
    const FeatureIndex slot = (views.first.value() + views.second.value()) % 3;
    const auto elsewhere = [&](const FeatureMatch& match) {
      return match.first % 3 != slot;
    };
    auto& points = pose.point_inliers;
    points.erase(std::remove_if(points.begin(), points.end(), elsewhere),
                 points.end());
    auto& lines = pose.line_inliers;
    lines.erase(std::remove_if(lines.begin(), lines.end(), elsewhere),
                lines.end());
  }
  // 0-1 and 1-2 use slots 1 and 0.
  const auto triplet = MakeTripletView(SceneFeatures(row.scene), {0, 1, 2});
  ASSERT_TRUE(triplet.has_value());
  EXPECT_TRUE(triplet->points.empty());
  EXPECT_TRUE(triplet->lines.empty());
  EXPECT_GT(CoplanarLinesKind().Gather(*triplet)->size(), 30);
  const auto ratios = EstimateScaleRatios(row.scene, {}, {});
  ASSERT_TRUE(ratios.has_value());
  EXPECT_EQ((*ratios)[0].verdict, RatioVerdict::kMeaningful);
  EXPECT_NEAR((*ratios)[0].log_ratio, row.TrueLogRatio((*ratios)[0].views),
              0.02);
}

TEST(EstimateScaleRatios, CanBeCancelled) {
  const RowOfViews row;
  RunContext context;
  context.progress = [](const std::string&, std::size_t done, std::size_t) {
    return done < 3;
  };
  const auto ratios = EstimateScaleRatios(row.scene, {}, context);
  ASSERT_FALSE(ratios.has_value());
  EXPECT_EQ(ratios.error().code, ErrorCode::kCancelled);
}

TEST(EstimateScaleRatios, TakeWhateverAValidSceneHolds) {
  RowOfViews row;
  for (auto& [views, pose] : row.scene.relative_poses) {
    pose.direction *= 1 + 9e-7;
    pose.rotation *= 1 + 3e-7;
  }
  ASSERT_TRUE(ValidateScene(row.scene));
  const auto ratios = EstimateScaleRatios(row.scene, {}, {});
  ASSERT_TRUE(ratios) << ratios.error().ToString();
  for (const ScaleRatio& ratio : *ratios) {
    EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
  }
}

TEST(ScaleRatios, ViewsWithoutIntrinsicsHaveNoRatios) {
  RowOfViews row;
  row.scene.views[3].intrinsic_id = kInvalidId;
  ScaleOptions options;
  const auto ratios = EstimateScaleRatios(row.scene, options, RunContext());
  ASSERT_TRUE(ratios) << ratios.error().ToString();
  ASSERT_EQ(ratios->size(), FindTriplets(ViewGraph(row.scene)).size());
  for (const ScaleRatio& ratio : *ratios) {
    const bool has_last = ratio.views.middle == 3 || ratio.views.last == 3;
    EXPECT_EQ(ratio.verdict, has_last ? RatioVerdict::kNoCandidates
                                      : RatioVerdict::kMeaningful);
  }
}

}  // namespace
}  // namespace lowlap
