#include "test_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/validation.h"
#include "tests/support/matchers.h"
#include "tests/support/random_vectors.h"

namespace lowlap::test {
namespace {

using lowlap::testing::IsOk;

struct Wall {
  Vec3 origin, right, down;  // corner and edges
  Vec3 At(double u, double v) const { return origin + u * right + v * down; }
};

constexpr double kSpacing = 1.2;

std::vector<Wall> MakeWalls(const TestSceneOptions& options) {
  const double length = kSpacing * (options.num_views - 1);
  const Vec3 span(length + 6, 0, 0);
  std::vector<Wall> walls = {{{-3, -2, 7}, span, {0, 3, 0}}};
  if (options.frontal_wall_only) return walls;
  walls.push_back({{-3, 1.5, 4}, span, {0, 0.2, 4}});               // floor
  walls.push_back({{-3, -2, 6}, span + Vec3(0, 0, 3), {0, 3, 2}});  // tilted
  walls.push_back({{-2, -1, 9}, span - Vec3(0, 0, 4), {0, 2, -2}});
  return walls;
}

class Builder {
 public:
  explicit Builder(const TestSceneOptions& options)
      : options_(options), random_(options.seed), walls_(MakeWalls(options)) {}

  TestScene Build() {
    MakeCameras();
    for (int n = 0; n < options_.num_points; ++n) AddPoint(10 + 3 * n);
    for (int n = 0; n < options_.num_lines; ++n) AddLine(5 + 2 * n);
    for (int n = 0; n + 2 < options_.num_views; ++n) AddRatio(n);
    return std::move(out_);
  }

 private:
  // Ids with gaps: nothing may take an id for an index.
  static ViewId ViewOf(int index) { return 3 + 2 * index; }
  static PoseId PoseOf(int index) { return 100 + index; }

  void MakeCameras() {
    Intrinsic intrinsic;
    intrinsic.model = options_.model;
    intrinsic.width_px = 1200;
    intrinsic.height_px = 800;
    if (options_.model != CameraModel::kSpherical) {
      intrinsic.fx_px = 800;
      intrinsic.fy_px = 806;
      intrinsic.principal_point_px = {603, 396};
    }
    intrinsic.distortion = options_.distortion;
    out_.scene.intrinsics[7] = intrinsic;
    for (int n = 0; n < options_.num_views; ++n) {
      View view;
      view.filename = std::to_string(n) + ".png";
      view.width_px = 1200;
      view.height_px = 800;
      view.intrinsic_id = 7;
      view.pose_id = PoseOf(n);
      out_.scene.views[ViewOf(n)] = view;
      out_.scene.features[ViewOf(n)] = {};
      Pose pose;
      pose.rotation = RotationFromAngleAxis(0.08 * RandomVector());
      pose.center =
          Vec3(kSpacing * n, 0.3 * (n % 2), 0) + 0.15 * RandomVector();
      out_.scene.poses[PoseOf(n)] = pose;
    }
    out_.true_poses = out_.scene.poses;
    for (int n = 0; n + 1 < options_.num_views; ++n) {
      const RigidTransform second_from_first =
          out_.scene.poses[PoseOf(n + 1)].CamFromWorld() *
          out_.scene.poses[PoseOf(n)].CamFromWorld().Inverse();
      RelativePose edge;
      edge.views = {ViewOf(n), ViewOf(n + 1)};
      edge.rotation = second_from_first.rotation;
      edge.direction = second_from_first.translation.normalized();
      out_.scene.relative_poses[edge.views] = edge;
    }
  }

  Vec3 RandomVector() {
    return {random_.Gaussian(), random_.Gaussian(), random_.Gaussian()};
  }
  Vec2 RandomPixel() {
    return {random_.Uniform(0, 1199), random_.Uniform(0, 799)};
  }
  Vec2 Noise() { return options_.noise_px * testing::GaussianVec2(random_); }

  bool Project(int view, const Vec3& point, Vec2* pixel_px) const {
    const Vec3 x = out_.true_poses.at(PoseOf(view)).CamFromWorld() * point;
    if (!(x.z() > 0.5)) return false;
    *pixel_px = out_.scene.intrinsics.at(7).Project(x);
    return pixel_px->x() >= 0 && pixel_px->y() >= 0 && pixel_px->x() <= 1199 &&
           pixel_px->y() <= 799;
  }

  // The first `limit` views from a random one on that see all of the points.
  std::vector<int> Visible(const std::vector<Vec3>& points, int limit) {
    std::vector<int> all, views;
    for (int view = 0; view < options_.num_views; ++view) {
      Vec2 pixel_px;
      if (std::all_of(points.begin(), points.end(), [&](const Vec3& point) {
            return Project(view, point, &pixel_px);
          })) {
        all.push_back(view);
      }
    }
    const int count = static_cast<int>(all.size());
    if (count < 2) return {};
    const int longest = std::min(limit, count);
    const std::size_t start = random_.Index(count - longest + 1);
    views.assign(all.begin() + start, all.begin() + start + longest);
    return views;
  }

  int RandomWall() { return static_cast<int>(random_.Index(walls_.size())); }

  void AddPoint(PointTrackId id) {
    std::vector<int> views;
    Vec3 point;
    while (views.size() < 2) {
      const auto& wall = walls_[RandomWall()];
      const double v = random_.Uniform();
      point = wall.At(random_.Uniform(), v);
      views = Visible({point}, options_.max_point_views);
    }
    out_.true_points[id] = point;
    Track& track = out_.scene.point_tracks[id];
    for (const int view : views) {
      Vec2 pixel_px;
      Project(view, point, &pixel_px);
      auto& features = out_.scene.features[ViewOf(view)].points_px;
      const FeatureRef ref{ViewOf(view),
                           static_cast<FeatureIndex>(features.size())};
      if (random_.Uniform() < options_.point_outliers) {
        pixel_px = RandomPixel();
        out_.outlier_points.push_back(ref);
      } else {
        pixel_px += Noise();
      }
      features.push_back(pixel_px);
      track.push_back(ref);
    }
  }

  void AddLine(LineTrackId id) {
    std::vector<int> views;
    Vec3 start, end;
    int wall = 0;
    while (views.size() < 2) {
      wall = RandomWall();
      const double u = random_.Uniform(), v = random_.Uniform();
      const double angle = random_.Uniform(0.15, kPi - 0.15);
      start = walls_[wall].At(u, v);
      const Vec3 along = std::cos(angle) * walls_[wall].right.normalized() +
                         std::sin(angle) * walls_[wall].down.normalized();
      end = start + random_.Uniform(0.6, 1.6) * along;
      views = Visible({start, end}, options_.max_line_views);
    }
    out_.true_lines[id] = PluckerLine::FromPoints(start, end);
    out_.wall_of_line[id] = wall;
    Track& track = out_.scene.line_tracks[id];
    for (const int view : views) {
      LineSegment segment;
      // The end points of a segment are not matched: each view sees its own.
      const double from = random_.Uniform(0, 0.1), to = random_.Uniform(0.9, 1);
      Project(view, start + from * (end - start), &segment.start_px);
      Project(view, start + to * (end - start), &segment.end_px);
      auto& features = out_.scene.features[ViewOf(view)].segments;
      const FeatureRef ref{ViewOf(view),
                           static_cast<FeatureIndex>(features.size())};
      if (random_.Uniform() < options_.line_outliers) {
        segment.start_px = RandomPixel();
        segment.end_px = RandomPixel();
        out_.outlier_segments.push_back(ref);
      } else {
        segment.start_px += Noise();
        segment.end_px += Noise();
      }
      features.push_back(segment);
      track.push_back(ref);
    }
  }

  const FeatureRef* Find(const Track& track, ViewId view) const {
    for (const FeatureRef& ref : track) {
      if (ref.view == view) return &ref;
    }
    return nullptr;
  }

  void AddRatio(int first) {
    if (options_.pairs_per_triplet == 0) return;
    const ViewTriplet views{ViewOf(first), ViewOf(first + 1),
                            ViewOf(first + 2)};
    std::vector<std::pair<LineTrackId, FeatureIndex>> left, right;
    for (const auto& [id, track] : out_.scene.line_tracks) {
      const FeatureRef* middle = Find(track, views.middle);
      if (middle == nullptr) continue;
      const bool in_first = Find(track, views.first) != nullptr;
      const bool in_last = Find(track, views.last) != nullptr;
      if (in_first && !in_last) left.emplace_back(id, middle->feature);
      if (in_last && !in_first) right.emplace_back(id, middle->feature);
    }
    ScaleRatio ratio;
    ratio.views = views;
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log10_nfa = -10;
    bool wrong = random_.Uniform() < options_.wrong_pairs;
    for (int tries = 0; tries < 10000 && !left.empty() && !right.empty();
         ++tries) {
      if (static_cast<int>(ratio.coplanar_inliers.size()) >=
          options_.pairs_per_triplet) {
        break;
      }
      const auto& [a, in_a] = left[random_.Index(left.size())];
      const auto& [b, in_b] = right[random_.Index(right.size())];
      if ((out_.wall_of_line[a] != out_.wall_of_line[b]) != wrong) continue;
      const CoplanarInlier inlier{in_a, in_b};
      if (std::find(ratio.coplanar_inliers.begin(),
                    ratio.coplanar_inliers.end(),
                    inlier) == ratio.coplanar_inliers.end()) {
        ratio.coplanar_inliers.push_back(inlier);
        wrong = random_.Uniform() < options_.wrong_pairs;
      }
    }
    out_.scene.scale_ratios.push_back(ratio);
  }

  const TestSceneOptions options_;
  Random random_;
  std::vector<Wall> walls_;
  TestScene out_;
};

}  // namespace

TestScene MakeTestScene(const TestSceneOptions& options) {
  return Builder(options).Build();
}

void PerturbPoses(double angle_rad, double distance, std::uint64_t seed,
                  Scene* scene) {
  Random random(seed);
  const auto vector = [&] { return testing::GaussianVec3(random); };
  for (auto& [id, pose] : scene->poses) {
    pose.rotation = RotationFromAngleAxis(angle_rad * vector()) * pose.rotation;
    pose.center += distance * vector();
  }
}

void PerturbScales(double log_stddev, std::uint64_t seed, Scene* scene) {
  Random random(seed);
  Vec3 old_previous, new_previous;
  bool first = true;
  for (auto& [id, pose] : scene->poses) {
    const Vec3 old_center = pose.center;
    if (!first) {
      pose.center = new_previous + std::exp(random.Gaussian(log_stddev)) *
                                       (old_center - old_previous);
    }
    first = false;
    old_previous = old_center;
    new_previous = pose.center;
  }
}

void AddCommonErrors(double stddev_px, std::uint64_t seed, Scene* scene) {
  constexpr double kPartPx = 80;
  Random random(seed);
  for (auto& [view, features] : scene->features) {
    std::map<std::pair<double, double>, Vec2> errors;
    for (Vec2& point : features.points_px) {
      const std::pair<double, double> part(std::floor(point.x() / kPartPx),
                                           std::floor(point.y() / kPartPx));
      const Vec2 drawn = testing::GaussianVec2(random, stddev_px);
      point += errors.emplace(part, drawn).first->second;
    }
  }
}

PoseErrors ComparePoses(const std::map<PoseId, Pose>& truth,
                        const Scene& scene) {
  std::vector<Vec3> source, target;
  for (const auto& [id, pose] : truth) {
    source.push_back(scene.poses.at(id).center);
    target.push_back(pose.center);
  }
  const Similarity similarity = AlignPoints(source, target).value();
  PoseErrors errors;
  for (std::size_t n = 0; n < source.size(); ++n) {
    const double error = (similarity * source[n] - target[n]).norm();
    errors.mean_center += error / static_cast<double>(source.size());
    errors.max_center = std::max(errors.max_center, error);
  }
  // Between neighbours: the alignment of almost collinear centres leaves the
  // rotation about their line open.
  for (auto it = truth.begin(); std::next(it) != truth.end(); ++it) {
    const auto next = std::next(it);
    const Mat3 solved = scene.poses.at(next->first).rotation *
                        scene.poses.at(it->first).rotation.transpose();
    const Mat3 expected =
        next->second.rotation * it->second.rotation.transpose();
    errors.max_rotation_rad = std::max(errors.max_rotation_rad,
                                       RotationAngleBetween(solved, expected));
  }
  return errors;
}

std::map<PoseId, Vec3> CenterErrors(const TestScene& test) {
  std::vector<Vec3> solved, truth;
  for (const auto& [id, pose] : test.scene.poses) {
    solved.push_back(pose.center);
    truth.push_back(test.true_poses.at(id).center);
  }
  const Similarity solved_from_truth = AlignPoints(truth, solved).value();
  std::map<PoseId, Vec3> errors;
  for (const auto& [id, pose] : test.scene.poses) {
    errors[id] =
        pose.center - solved_from_truth * test.true_poses.at(id).center;
  }
  return errors;
}

double NormalisedCenterError(const TestScene& test) {
  const std::map<PoseId, Vec3> errors = CenterErrors(test);
  double sum = 0;
  for (const auto& [id, error] : errors) {
    sum += error.squaredNorm() /
           test.scene.poses.at(id).center_covariance->trace();
  }
  return sum / static_cast<double>(errors.size());
}

AdjustmentSummary BuildAndAdjust(Scene* scene,
                                 const AdjustmentOptions& options) {
  EXPECT_THAT(BuildStructure(scene, {}, {}), IsOk());
  const Result<AdjustmentSummary> summary = AdjustScene(scene, options, {});
  EXPECT_THAT(summary, IsOk());
  EXPECT_THAT(ValidateScene(*scene), IsOk());
  return summary.value_or(AdjustmentSummary{});
}

Scene Transformed(const Scene& scene, const Similarity& similarity) {
  Scene out = scene;
  for (auto& [id, pose] : out.poses) {
    pose.center = similarity * pose.center;
    pose.rotation = pose.rotation * similarity.rotation.transpose();
  }
  for (auto& [id, landmark] : out.structure) {
    landmark.position = similarity * landmark.position;
  }
  for (auto& [id, line] : out.line_structure) {
    line.start = similarity * line.start;
    line.end = similarity * line.end;
    line.line = PluckerLine::FromPoints(line.start, line.end);
  }
  return out;
}

}  // namespace lowlap::test
