#include "lowlap/averaging/rigidity/internal/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "averaging/rigidity/scene_with_edges.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/types.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ScaleRatio& AddRatio(ViewId first, ViewId middle, ViewId last, Scene* scene) {
  ScaleRatio ratio;
  ratio.views = {first, middle, last};
  ratio.verdict = RatioVerdict::kMeaningful;
  ratio.log10_nfa = -12;
  ratio.log_ratio_stddev = 0.01;
  ratio.kinds = {{"points", 20, 20}};
  scene->scale_ratios.push_back(ratio);
  return scene->scale_ratios.back();
}

Diagnosis DiagnosisOf(const Scene& scene) {
  const auto diagnosis = Diagnose(scene);
  EXPECT_TRUE(diagnosis) << diagnosis.error().ToString();
  return diagnosis ? *diagnosis : Diagnosis();
}

// The groups of edges whose lengths are proportional in every solution of the
// linear equations, straight from their null space.
std::set<std::set<ViewPair>> GroupsByNullSpace(const Scene& scene,
                                               std::uint64_t seed) {
  Random random(seed);
  std::map<ViewId, Vec2> center;
  for (const auto& entry : scene.views) {
    center[entry.first] = {random.Gaussian(), random.Gaussian()};
  }
  std::vector<ViewPair> edges;
  std::map<ViewPair, Eigen::Index> column;
  const Eigen::Index num_views = static_cast<Eigen::Index>(center.size());
  for (const auto& entry : scene.relative_poses) {
    column[entry.first] =
        2 * num_views + static_cast<Eigen::Index>(edges.size());
    edges.push_back(entry.first);
  }
  const Eigen::Index num_edges = static_cast<Eigen::Index>(edges.size());
  const Eigen::Index num_ratios =
      static_cast<Eigen::Index>(scene.scale_ratios.size());
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(2 * num_edges + num_ratios,
                                                    2 * num_views + num_edges);
  const auto length = [&](const ViewPair& e) {
    return (center[e.second] - center[e.first]).norm();
  };
  Eigen::Index row = 0;
  for (const ViewPair& e : edges) {
    const Vec2 direction = (center[e.second] - center[e.first]) / length(e);
    for (Eigen::Index axis = 0; axis < 2; ++axis, ++row) {
      equations(row, 2 * e.second.value() + axis) = 1;
      equations(row, 2 * e.first.value() + axis) = -1;
      equations(row, column[e]) = -direction(axis);
    }
  }
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    const auto ordered = [](ViewId a, ViewId b) {
      return ViewPair{std::min(a, b), std::max(a, b)};
    };
    const ViewPair reference = ordered(ratio.views.first, ratio.views.middle);
    const ViewPair target = ordered(ratio.views.middle, ratio.views.last);
    equations(row, column[target]) = 1;
    equations(row++, column[reference]) = -length(target) / length(reference);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(equations, Eigen::ComputeFullV);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() &&
         svd.singularValues()(rank) > 1e-10) {
    ++rank;
  }
  Eigen::MatrixXd scales =
      svd.matrixV().bottomRightCorner(num_edges, equations.cols() - rank);
  for (Eigen::Index e = 0; e < num_edges; ++e) {
    scales.row(e) /= length(edges[static_cast<std::size_t>(e)]);
  }
  std::set<std::set<ViewPair>> groups;
  for (Eigen::Index a = 0; a < num_edges; ++a) {
    std::set<ViewPair> group;
    for (Eigen::Index b = 0; b < num_edges; ++b) {
      if ((scales.row(a) - scales.row(b)).norm() < 1e-6) {
        group.insert(edges[static_cast<std::size_t>(b)]);
      }
    }
    groups.insert(std::move(group));
  }
  return groups;
}

std::set<std::set<ViewPair>> GroupsOf(const RigidityReport& report) {
  std::set<std::set<ViewPair>> groups;
  for (const RigidGroup& group : report.groups) {
    groups.emplace(group.edges.begin(), group.edges.end());
  }
  return groups;
}

Scene RandomScene(std::uint64_t seed) {
  Random random(seed);
  const std::uint32_t num_views = 4 + random.Index(8);
  const double density = random.Uniform(0.15, 0.6);
  const double share_of_ratios = random.Uniform(0.0, 0.4);
  std::vector<ViewPair> edges;
  for (std::uint32_t a = 0; a < num_views; ++a) {
    for (std::uint32_t b = a + 1; b < num_views; ++b) {
      if (random.Uniform() < density) edges.push_back({a, b});
    }
  }
  Scene scene = SceneWithEdges(num_views, edges);
  for (const ViewPair& a : edges) {
    for (const ViewPair& b : edges) {
      if (!(a < b) || random.Uniform() >= share_of_ratios) continue;
      if (a.first == b.first) AddRatio(a.second, a.first, b.second, &scene);
      if (a.second == b.first) AddRatio(a.first, a.second, b.second, &scene);
      if (a.second == b.second) AddRatio(a.first, a.second, b.first, &scene);
    }
  }
  return scene;
}

TEST(Diagnose, AgreesWithTheNullSpaceOnRandomGraphs) {
  int num_rigid = 0, num_split = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Scene scene = RandomScene(seed);
    if (scene.relative_poses.empty()) continue;
    const Diagnosis diagnosis = DiagnosisOf(scene);
    EXPECT_EQ(GroupsOf(diagnosis.by_ratios), GroupsByNullSpace(scene, seed))
        << "graph " << seed;
    Scene without = scene;
    without.scale_ratios.clear();
    EXPECT_EQ(GroupsOf(diagnosis.by_directions),
              GroupsByNullSpace(without, seed + 1000))
        << "graph " << seed;
    ++(diagnosis.by_ratios.groups.size() == 1 ? num_rigid : num_split);
  }
  EXPECT_GT(num_rigid, 80);
  EXPECT_GT(num_split, 80);
}

// The hinges are the cameras whose ratios the null space cannot do without.
TEST(Diagnose, HingesAreWhatTheNullSpaceFallsApartWithout) {
  int num_hinges = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const Scene scene = RandomScene(seed);
    if (scene.relative_poses.empty()) continue;
    const Diagnosis diagnosis = DiagnosisOf(scene);
    const auto whole = GroupsByNullSpace(scene, seed);
    std::set<ViewId> expected, found;
    for (const auto& [camera, view] : scene.views) {
      Scene without = scene;
      without.scale_ratios.clear();
      // Ratios within what directions hold do not matter at all.
      for (const ScaleRatio& ratio : scene.scale_ratios) {
        if (ratio.views.middle != camera) without.scale_ratios.push_back(ratio);
      }
      if (GroupsByNullSpace(without, seed) != whole) expected.insert(camera);
    }
    for (const ScaleArticulation& hinge : diagnosis.articulation_views)
      found.insert(hinge.view);
    EXPECT_EQ(found, expected) << "graph " << seed;
    num_hinges += static_cast<int>(found.size());
  }
  EXPECT_GT(num_hinges, 50);
}

TEST(Diagnose, PartsThatShareTwoViewsNeedNoRatio) {
  // Triangle 0-1-2, and the strip of triangles 0-3-4-5-6-1, share views 0 and 1
  // and no edge.
  const Diagnosis diagnosis = DiagnosisOf(SceneWithEdges(7, {{0, 1},
                                                             {0, 2},
                                                             {1, 2},
                                                             {0, 3},
                                                             {0, 4},
                                                             {3, 4},
                                                             {3, 5},
                                                             {4, 5},
                                                             {4, 6},
                                                             {5, 6},
                                                             {1, 5},
                                                             {1, 6}}));
  EXPECT_EQ(diagnosis.by_directions.groups.size(), 1u);
  EXPECT_TRUE(diagnosis.IsFirm());
}

TEST(Diagnose, ATriangleWithoutARatioFloats) {
  Scene scene = SceneWithEdges(6, kTwoTriangles);
  scene.relative_poses[{2, 4}].point_inliers.resize(9);
  ScaleRatio& rejected = AddRatio(1, 2, 4, &scene);
  rejected.verdict = RatioVerdict::kNotMeaningful;
  rejected.log10_nfa = 0.5;
  const Diagnosis diagnosis = DiagnosisOf(scene);
  EXPECT_FALSE(diagnosis.IsFirm());
  EXPECT_THAT(diagnosis.articulation_views, IsEmpty());
  ASSERT_EQ(diagnosis.floating.size(), 2u);
  const FloatingPart& part = diagnosis.floating[0];
  EXPECT_THAT(part.views, ElementsAre(2, 3, 4));
  EXPECT_EQ(part.meets_in, 2u);
  EXPECT_EQ(part.near_part, 4u);
  ASSERT_TRUE(part.rejected_ratio);
  EXPECT_EQ(*part.rejected_ratio, 0u);
  // A view without any relative pose.
  EXPECT_THAT(diagnosis.floating[1].views, ElementsAre(5));
  EXPECT_EQ(diagnosis.floating[1].meets_in, kInvalidId);
  EXPECT_EQ(diagnosis.floating[1].near_part, 5u);
}

// Views 5 to 7 hang together in 6, where no ratio is, and on nothing else.
TEST(Diagnose, WhatIsJoinedToNothingIsOnePart) {
  std::vector<ViewPair> edges = kTwoTriangles;
  edges.push_back({5, 6});
  edges.push_back({6, 7});
  Scene scene = SceneWithEdges(8, edges);
  AddRatio(1, 2, 3, &scene);
  const Diagnosis diagnosis = DiagnosisOf(scene);
  ASSERT_EQ(diagnosis.floating.size(), 2u);
  EXPECT_THAT(diagnosis.floating[0].views, ElementsAre(5, 6, 7));
  EXPECT_EQ(diagnosis.floating[0].meets_in, kInvalidId);
  EXPECT_EQ(diagnosis.floating[0].near_group, 4u);
  EXPECT_EQ(diagnosis.floating[0].near_part, 5u);
  EXPECT_THAT(diagnosis.floating[1].views, ElementsAre(6, 7));
  EXPECT_EQ(diagnosis.floating[1].meets_in, 6u);
  EXPECT_EQ(diagnosis.floating[1].near_group, 5u);
  EXPECT_EQ(diagnosis.floating[1].near_part, 7u);
}

TEST(Diagnose, ARatioMakesAHingeOfTheSharedCamera) {
  Scene scene = SceneWithEdges(5, kTwoTriangles);
  AddRatio(0, 2, 1, &scene);  // within a triangle: no news
  AddRatio(1, 2, 3, &scene);
  AddRatio(0, 2, 4, &scene).log10_nfa = -40;
  const Diagnosis diagnosis = DiagnosisOf(scene);
  EXPECT_TRUE(diagnosis.IsFirm());
  EXPECT_THAT(diagnosis.floating, IsEmpty());
  ASSERT_EQ(diagnosis.articulation_views.size(), 1u);
  const ScaleArticulation& hinge = diagnosis.articulation_views[0];
  EXPECT_EQ(hinge.view, 2u);
  EXPECT_THAT(hinge.parts, ElementsAre(ElementsAre(0, 1), ElementsAre(3, 4)));
  EXPECT_THAT(hinge.ratios, ElementsAre(2, 1));
  EXPECT_FALSE(hinge.is_weak);
}

TEST(Diagnose, WeakRatiosAreNamed) {
  for (int reason = 0; reason < 4; ++reason) {
    Scene scene = SceneWithEdges(5, kTwoTriangles);
    ScaleRatio& weak = AddRatio(1, 2, 3, &scene);
    if (reason == 0) weak.kinds[0].inliers = 3;
    if (reason == 1) weak.log10_nfa = -1;
    if (reason == 2) weak.log_ratio_stddev = 0.3;
    if (reason == 3) weak.kinds[0].candidates = 2 * weak.kinds[0].inliers;
    Diagnosis diagnosis = DiagnosisOf(scene);
    EXPECT_FALSE(diagnosis.IsFirm()) << reason;
    EXPECT_EQ(diagnosis.by_ratios.groups.size(), 1u);
    EXPECT_THAT(diagnosis.weak_ratios, ElementsAre(0));
    ASSERT_EQ(diagnosis.articulation_views.size(), 1u);
    EXPECT_TRUE(diagnosis.articulation_views[0].is_weak);
    // A strong one beside it takes its place.
    AddRatio(0, 2, 4, &scene);
    diagnosis = DiagnosisOf(scene);
    EXPECT_TRUE(diagnosis.IsFirm()) << reason;
    EXPECT_THAT(diagnosis.weak_ratios, IsEmpty());
    EXPECT_FALSE(diagnosis.articulation_views[0].is_weak);
  }
}

TEST(Diagnose, AChainHingesOnEveryInnerCamera) {
  std::vector<ViewPair> edges;
  for (std::uint32_t view = 0; view < 7; ++view) {
    edges.push_back({view, view + 1});
  }
  Scene scene = SceneWithEdges(8, edges);
  for (std::uint32_t view = 1; view < 7; ++view) {
    AddRatio(view - 1, view, view + 1, &scene);
  }
  const Diagnosis diagnosis = DiagnosisOf(scene);
  EXPECT_TRUE(diagnosis.IsFirm());
  ASSERT_EQ(diagnosis.articulation_views.size(), 6u);
  EXPECT_EQ(diagnosis.articulation_views[2].view, 3u);
  EXPECT_THAT(diagnosis.articulation_views[2].parts,
              ElementsAre(ElementsAre(4, 5, 6, 7), ElementsAre(0, 1, 2)));
}

TEST(Diagnose, ARingOfRatiosHasNoHinge) {
  // Without any one ratio, the chain of the others still holds the ring.
  std::vector<ViewPair> edges;
  for (std::uint32_t view = 0; view + 1 < 6; ++view) {
    edges.push_back({view, view + 1});
  }
  edges.push_back({0, 5});
  Scene scene = SceneWithEdges(6, edges);
  for (std::uint32_t view = 1; view < 5; ++view) {
    AddRatio(view - 1, view, view + 1, &scene);
  }
  AddRatio(1, 0, 5, &scene);
  AddRatio(0, 5, 4, &scene);
  EXPECT_THAT(DiagnosisOf(scene).articulation_views, IsEmpty());
}

TEST(Diagnose, ALongChainTakesNoTime) {
  constexpr std::uint32_t kViews = 800;
  std::vector<ViewPair> edges;
  for (std::uint32_t view = 0; view + 1 < kViews; ++view) {
    edges.push_back({view, view + 1});
  }
  Scene scene = SceneWithEdges(kViews, edges);
  for (std::uint32_t view = 1; view + 1 < kViews; ++view) {
    if (view != 300) AddRatio(view - 1, view, view + 1, &scene);
  }
  const Diagnosis diagnosis = DiagnosisOf(scene);
  ASSERT_EQ(diagnosis.floating.size(), 1u);
  EXPECT_EQ(diagnosis.floating[0].meets_in, 300u);
  EXPECT_EQ(diagnosis.articulation_views.size(), 797u);
}

TEST(Diagnose, NothingAndErrors) {
  EXPECT_FALSE(DiagnosisOf(Scene()).IsFirm());
  Scene scene = SceneWithEdges(3, {{0, 1}, {1, 2}});
  AddRatio(1, 0, 2, &scene);
  const auto diagnosis = Diagnose(scene);
  ASSERT_FALSE(diagnosis);
  EXPECT_EQ(diagnosis.error().code, ErrorCode::kInvalidScene);
  DiagnosisOptions options;
  options.max_stddev = 0;
  EXPECT_FALSE(Diagnose(Scene(), options));
}

TEST(PredictTripletAveraging, GroupsThatMeetInOneCameraAreGlued) {
  // Two triplets that share view 2, a third apart, and view 8 in none.
  Scene scene = SceneWithEdges(9, {{0, 1},
                                   {0, 2},
                                   {1, 2},
                                   {2, 3},
                                   {2, 4},
                                   {3, 4},
                                   {4, 8},
                                   {5, 6},
                                   {5, 7},
                                   {6, 7}});
  for (std::uint32_t id = 0; id < 90; ++id) {
    const std::uint32_t a = std::vector<std::uint32_t>{0, 2, 5}[id % 3];
    scene.point_tracks[id] = {{a, id}, {a + 1, id}, {a + 2, id}};
  }
  const TripletPrediction prediction = PredictTripletAveraging(scene);
  EXPECT_THAT(prediction.kept, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(prediction.lost, ElementsAre(5, 6, 7, 8));
  EXPECT_TRUE(prediction.IsGlued());
  ASSERT_EQ(prediction.articulation_views.size(), 1u);
  EXPECT_EQ(prediction.articulation_views[0].view, 2u);
  EXPECT_THAT(prediction.articulation_views[0].groups, ElementsAre(0, 1));
}

}  // namespace
}  // namespace lowlap
