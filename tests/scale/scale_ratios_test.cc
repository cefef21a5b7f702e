#include "lowlap/scale/scale_ratios.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "lowlap/core/random.h"
#include "lowlap/geometry/rotation.h"
#include "lowlap/scale/internal/planes/planes_by_pair.h"
#include "lowlap/scale/internal/search/ratio_profile.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

// Four views in a row before a tilted wall of points and lines, all pairs.
// The scene is placed in a world that is turned and scaled as told.
struct RowOfViews {
  Scene scene;
  std::map<ViewPair, double> baselines;

  explicit RowOfViews(const Mat3& world_turn = Mat3::Identity(),
                      double world_scale = 1.0) {
    constexpr int kViews = 4, kPoints = 60, kLines = 40;
    Intrinsic intrinsic;
    intrinsic.width_px = 1200;
    intrinsic.height_px = 800;
    intrinsic.fx_px = intrinsic.fy_px = 900;
    intrinsic.principal_point_px = {600, 400};
    scene.intrinsics[0] = intrinsic;
    Random random(5);
    std::vector<RigidTransform> cams;
    for (ViewId view = 0; view < kViews; ++view) {
      scene.views[view].intrinsic_id = 0;
      scene.views[view].pose_id = view;
      const double x = 0.5 * view + 0.1 * view * view;
      cams.push_back(RigidTransform::FromRotationAndCenter(
          RotationFromAngleAxis({0, 0.02 * view, 0.01}) *
              world_turn.transpose(),
          world_scale * (world_turn * Vec3(x, 0.05 * view, 0))));
    }
    const auto on_wall = [&] {
      const double x = random.Uniform(-0.8, 3.2);
      const Vec3 point(x, random.Uniform(-1.3, 1.3), 4 + 0.4 * x);
      return Vec3(world_scale * (world_turn * point));
    };
    const auto project = [&](const RigidTransform& cam, const Vec3& x) {
      const double u = random.Gaussian(0.3);
      return Vec2(intrinsic.Project(cam * x) + Vec2(u, random.Gaussian(0.3)));
    };
    for (int n = 0; n < kPoints; ++n) {
      const Vec3 x = on_wall();
      for (ViewId view = 0; view < kViews; ++view) {
        scene.features[view].points_px.push_back(project(cams[view], x));
      }
    }
    for (int n = 0; n < kLines; ++n) {
      const Vec3 a = on_wall(), b = on_wall();
      for (ViewId view = 0; view < kViews; ++view) {
        const Vec2 start_px = project(cams[view], a);
        scene.features[view].segments.push_back(
            {start_px, project(cams[view], b), 0.3});
      }
    }
    for (ViewId i = 0; i < kViews; ++i) {
      for (ViewId j = i + 1; j < kViews; ++j) {
        const RigidTransform j_from_i = cams[j] * cams[i].Inverse();
        RelativePose pose;
        pose.views = {i, j};
        pose.rotation = j_from_i.rotation;
        pose.direction = j_from_i.translation.normalized();
        baselines[pose.views] = j_from_i.translation.norm();
        for (FeatureIndex n = 0; n < kPoints; ++n) {
          pose.point_inliers.push_back({n, n});
        }
        for (FeatureIndex n = 0; n < kLines; ++n) {
          pose.line_inliers.push_back({n, n});
        }
        scene.relative_poses[pose.views] = pose;
      }
    }
  }

  double TrueLogRatio(const ViewTriplet& views) const {
    const auto baseline = [&](ViewId a, ViewId b) {
      return baselines.at({std::min(a, b), std::max(a, b)});
    };
    return std::log(baseline(views.middle, views.last) /
                    baseline(views.first, views.middle));
  }
};

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
    EXPECT_GT(ratio.points.inliers, 20);
    EXPECT_GT(ratio.coplanar.inliers, 20);
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
  without.use_coplanar_points = false;
  const auto a = EstimateScaleRatios(row.scene, {}, {});
  const auto b = EstimateScaleRatios(row.scene, without, {});
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_TRUE(*a == *b);
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
    const NormalizedFeaturesByView features = NormalizeAllFeatures(scene);
    const ViewTriplet views{0, 1, 2};
    const bool overlap = PairsOverlap(scene, features, views);
    EXPECT_EQ(overlap, begin_px < 600);
    const auto triplet = MakeTripletView(scene, features, views, {});
    ASSERT_TRUE(triplet.has_value());
    const bool has_plane_points = !triplet->plane_points.empty();
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
  without.use_coplanar_points = false;
  const auto a = EstimateScaleRatios(scene, {}, {});
  const auto b = EstimateScaleRatios(scene, without, {});
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_TRUE(*a == *b);
}

// With lines that decide, and with nothing but places on planes.
TEST(ProfileScaleRatios, AreThoseOfTheEstimatedRatios) {
  for (const bool has_lines : {true, false}) {
    RowOfViews row;
    for (auto& [views, pose] : row.scene.relative_poses) {
      if (has_lines) continue;
      pose.line_inliers.clear();
      const FeatureIndex slot = (views.first + views.second) % 3;
      auto& points = pose.point_inliers;
      points.erase(std::remove_if(points.begin(), points.end(),
                                  [&](const FeatureMatch& match) {
                                    return match.first % 3 != slot;
                                  }),
                   points.end());
    }
    const auto ratios = EstimateScaleRatios(row.scene, {}, {});
    const auto profiles = ProfileScaleRatios(
        row.scene, FindTriplets(ViewGraph(row.scene)), {}, {});
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
    EXPECT_EQ((*a)[n].points.inliers, (*b)[n].points.inliers);
    EXPECT_EQ((*a)[n].coplanar.inliers, (*b)[n].coplanar.inliers);
  }
}

TEST(EstimateScaleRatios, WorkWhenNoFeatureIsSeenThrice) {
  RowOfViews row;
  // Every feature goes to one pair only.
  for (auto& [views, pose] : row.scene.relative_poses) {
    const FeatureIndex slot = (views.first + views.second) % 3;
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
  const NormalizedFeaturesByView features = NormalizeAllFeatures(row.scene);
  const auto triplet = MakeTripletView(row.scene, features, {0, 1, 2}, {});
  ASSERT_TRUE(triplet.has_value());
  EXPECT_TRUE(triplet->points.empty());
  EXPECT_TRUE(triplet->lines.empty());
  EXPECT_GT(triplet->coplanar.pairs.size(), 30u);
  const auto ratios = EstimateScaleRatios(row.scene, {}, {});
  ASSERT_TRUE(ratios.has_value());
  EXPECT_EQ((*ratios)[0].verdict, RatioVerdict::kMeaningful);
  EXPECT_NEAR((*ratios)[0].log_ratio, row.TrueLogRatio((*ratios)[0].views),
              0.02);
}

TEST(MakeTripletView, ChainsThroughTheFeaturesOfTheMiddleView) {
  const RowOfViews row;
  Scene scene = row.scene;
  scene.relative_poses.at({0, 2}).point_inliers = {{4, 7}, {5, 8}, {6, 9}};
  scene.relative_poses.at({2, 3}).point_inliers = {{9, 1}, {7, 2}, {7, 3}};
  const NormalizedFeaturesByView features = NormalizeAllFeatures(scene);
  const auto triplet = MakeTripletView(scene, features, {0, 2, 3}, {});
  ASSERT_TRUE(triplet.has_value());
  ASSERT_EQ(triplet->points.size(), 3u);
  EXPECT_EQ(triplet->points[0].point_in_middle, 7u);
  EXPECT_EQ(triplet->points[0].in_i, features.at(0).points[4]);
  EXPECT_EQ(triplet->points[0].in_k, features.at(3).points[2]);
  EXPECT_EQ(triplet->points[1].in_k, features.at(3).points[3]);
  EXPECT_EQ(triplet->points[2].point_in_middle, 9u);
  EXPECT_EQ(triplet->points[2].in_k, features.at(3).points[1]);
  // The middle view may be the first of an edge.
  const auto reversed = MakeTripletView(scene, features, {2, 0, 1}, {});
  ASSERT_TRUE(reversed.has_value());
  EXPECT_EQ(reversed->points.size(), 3u);
  EXPECT_EQ(reversed->points[0].in_i, features.at(2).points[7]);
}

TEST(MakeTripletView, PerturbsThePosesByTheirCovariances) {
  RowOfViews row;
  const NormalizedFeaturesByView features = NormalizeAllFeatures(row.scene);
  EXPECT_TRUE(MakeTripletView(row.scene, features, {0, 1, 2}, {})
                  ->pose_perturbations.empty());
  row.scene.relative_poses.at({1, 2}).covariance =
      1e-6 * Eigen::Matrix<double, 5, 5>::Identity();
  const auto triplet = MakeTripletView(row.scene, features, {0, 1, 2}, {});
  ASSERT_EQ(triplet->pose_perturbations.size(), 5u);
  for (const TripletGeometry& moved : triplet->pose_perturbations) {
    EXPECT_EQ(moved.cami_from_camj.rotation,
              triplet->geometry.cami_from_camj.rotation);
    const double turned =
        RotationAngleBetween(moved.camk_from_camj.rotation,
                             triplet->geometry.camk_from_camj.rotation);
    const double tilted =
        AngleBetween(moved.camk_from_camj.translation,
                     triplet->geometry.camk_from_camj.translation);
    EXPECT_NEAR(std::hypot(turned, tilted), 1e-3, 1e-6);
  }
}

TEST(MakeTripletView, MissingPartsAreErrors) {
  const RowOfViews row;
  NormalizedFeaturesByView features = NormalizeAllFeatures(row.scene);
  EXPECT_EQ(MakeTripletView(row.scene, features, {0, 1, 9}, {}).error().code,
            ErrorCode::kInvalidArgument);
  Scene scene = row.scene;
  scene.relative_poses.at({0, 1}).point_inliers.push_back({0, 1000});
  EXPECT_EQ(MakeTripletView(scene, features, {0, 1, 2}, {}).error().code,
            ErrorCode::kInvalidScene);
  EXPECT_FALSE(EstimateScaleRatios(scene, {}, {}).has_value());
  scene = row.scene;
  scene.views[1].intrinsic_id = kInvalidId;
  EXPECT_EQ(MakeTripletView(scene, features, {0, 1, 2}, {}).error().code,
            ErrorCode::kInvalidArgument);
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
