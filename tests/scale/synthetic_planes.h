#pragma once

#include <algorithm>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/evidence/internal/plane_points.h"
#include "lowlap/scale/triplet_view.h"
#include "scale/synthetic_room.h"
#include "scale/synthetic_triplet.h"
#include "support/random_vectors.h"

namespace lowlap::testing {

struct SyntheticPlanesOptions {
  int num_points_per_wall = 30;  // in either pair, none in both
  int num_lines_per_wall = 0;
  int num_scattered = 0;  // points of either pair on no wall
  double noise_px = 0;
  /// The walls that (j, k) sees are others: there is no ratio.
  bool unrelated_walls = false;
};

/// Three walls side by side in front of the middle camera, each tilted its own
/// way: the left, middle and right third of the image. f = 900 px.
struct SyntheticPlanes {
  static constexpr double kFocalPx = 900;
  static constexpr double kDiagonalPx = 1298;  // of 1080 x 720
  static constexpr int kNumWalls = 3;

  TripletGeometry geometry;
  double true_log_ratio = 0;
  double baseline_i = 1;    // in metres
  std::vector<Vec3> walls;  // p, p . X = 1, in metres
  std::vector<MatchedPoint> points_ij, points_jk;
  std::vector<MatchedLine> lines_ij, lines_jk;

  /// Of the wall that a ray of the middle view meets, at unit baseline of
  /// (i, j).
  double InverseDepthIj(const Vec3& ray) const {
    const int third = static_cast<int>((ray.x() + 0.6) / 0.4);
    return baseline_i * walls[std::clamp(third, 0, kNumWalls - 1)].dot(ray);
  }
  PairPlanes PlanesIj() const {
    return FindPlanes(DepthSamples(geometry.cami_from_camj, kFocalPx, kFocalPx,
                                   points_ij, lines_ij));
  }
  PairPlanes PlanesJk() const {
    return FindPlanes(DepthSamples(geometry.camk_from_camj, kFocalPx, kFocalPx,
                                   points_jk, lines_jk));
  }
  /// Without features: its evidence is that of Kinds().
  TripletView View() const {
    TripletView view;
    view.views = {0, 1, 2};
    view.geometry = geometry;
    view.image_area_px2 = 1080 * 720;
    view.image_diagonal_px = kDiagonalPx;
    return view;
  }
  EvidenceKinds Kinds() const {
    return {std::make_shared<PlanePointsKind>(
        PlanesByPair{{{1, 0}, PlanesIj()}, {{1, 2}, PlanesJk()}})};
  }
  std::vector<PlanePoint> Points() const {
    return FindPlanePoints(geometry, PlanesIj(), PlanesJk());
  }
};

class SyntheticPlanesMaker {
 public:
  SyntheticPlanesMaker(const SyntheticPlanesOptions& options,
                       std::uint64_t seed)
      : options_(options), random_(seed) {}

  SyntheticPlanes Make() {
    SyntheticPlanes scene;
    const RigidTransform i_from_j = Neighbor(-1), k_from_j = Neighbor(1);
    const double length_i = i_from_j.translation.norm();
    const double length_k = k_from_j.translation.norm();
    scene.geometry = {i_from_j, k_from_j, SyntheticPlanes::kFocalPx,
                      SyntheticPlanes::kFocalPx, SyntheticPlanes::kFocalPx};
    scene.geometry.cami_from_camj.translation /= length_i;
    scene.geometry.camk_from_camj.translation /= length_k;
    scene.baseline_i = length_i;
    scene.true_log_ratio = std::log(length_k / length_i);
    for (int w = 0; w < SyntheticPlanes::kNumWalls; ++w) {
      scene.walls.push_back(RandomWall());
      const Vec3 other = RandomWall();
      AddWall(scene.walls[w], w, i_from_j, &scene.points_ij, &scene.lines_ij);
      AddWall(options_.unrelated_walls ? other : scene.walls[w], w, k_from_j,
              &scene.points_jk, &scene.lines_jk);
    }
    for (int n = 0; n < options_.num_scattered; ++n) {
      AddPoint(Ray(0, 3) * random_.Uniform(1.5, 6), i_from_j, &scene.points_ij);
      AddPoint(Ray(0, 3) * random_.Uniform(1.5, 6), k_from_j, &scene.points_jk);
    }
    return scene;
  }

 private:
  RigidTransform Neighbor(int side) {
    Vec3 center = UniformVec3(random_, {0.4, -0.2, -0.2}, {1.2, 0.2, 0.2});
    center.x() *= side;
    const Vec3 turn(0, -side * random_.Uniform(0, 0.1), 0.02);
    return RigidTransform::FromRotationAndCenter(RotationFromAngleAxis(turn),
                                                 center);
  }

  Vec3 RandomWall() {
    const double depth = random_.Uniform(2.5, 5);
    const double x = random_.Uniform(-0.4, 0.4);
    return Vec3(x, random_.Uniform(-0.3, 0.3), 1) / depth;
  }

  // Of the middle camera, in thirds [first, end) of the image.
  Vec3 Ray(int first, int end) {
    const double x = random_.Uniform(-0.6 + 0.4 * first, -0.6 + 0.4 * end);
    return {x, random_.Uniform(-0.4, 0.4), 1};
  }

  Vec3 Noisy(const Vec3& x) {
    const double s = options_.noise_px / SyntheticPlanes::kFocalPx;
    const double dx = random_.Gaussian(s), dy = random_.Gaussian(s);
    return x / x.z() + Vec3(dx, dy, 0);
  }

  void AddPoint(const Vec3& x, const RigidTransform& n_from_j,
                std::vector<MatchedPoint>* points) {
    const Vec3 in_middle = Noisy(x);
    points->push_back({next_feature_++, in_middle, Noisy(n_from_j * x)});
  }

  void AddWall(const Vec3& wall, int third, const RigidTransform& n_from_j,
               std::vector<MatchedPoint>* points,
               std::vector<MatchedLine>* lines) {
    const auto on_wall = [&] {
      const Vec3 ray = Ray(third, third + 1);
      return Vec3(ray / wall.dot(ray));
    };
    for (int n = 0; n < options_.num_points_per_wall; ++n) {
      AddPoint(on_wall(), n_from_j, points);
    }
    for (int n = 0; n < options_.num_lines_per_wall; ++n) {
      const Vec3 start = on_wall(), end = on_wall();
      const auto observe = [&](const RigidTransform& cam_from_j) {
        const Vec3 start_seen = Noisy(cam_from_j * start);
        return ObservedSegment{MakeSegment(start_seen, Noisy(cam_from_j * end)),
                               std::max(options_.noise_px, 0.1)};
      };
      const ObservedSegment in_middle = observe(RigidTransform());
      lines->push_back({next_feature_++, in_middle, observe(n_from_j)});
    }
  }

  SyntheticPlanesOptions options_;
  Random random_;
  FeatureIndex next_feature_ = 0;
};

inline SyntheticPlanes MakeSyntheticPlanes(
    const SyntheticPlanesOptions& options, std::uint64_t seed) {
  return SyntheticPlanesMaker(options, seed).Make();
}

}  // namespace lowlap::testing
