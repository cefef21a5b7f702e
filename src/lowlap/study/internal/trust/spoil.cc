#include "lowlap/study/internal/trust/spoil.h"

#include <Eigen/Geometry>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/pipeline/internal/measure/relative_poses.h"
#include "lowlap/synthetic/internal/pose_evidence.h"

namespace lowlap {
namespace {

template <class Feature>
void Shuffle(Random* random, std::vector<Feature>* features) {
  for (std::size_t n = features->size(); n > 1; --n) {
    std::swap((*features)[n - 1],
              (*features)[random->Index(static_cast<std::uint32_t>(n))]);
  }
}

Vec3 AnyDirection(Random* random) {
  return Vec3{random->Gaussian(), random->Gaussian(), random->Gaussian()}
      .normalized();
}

Vec2 AnyPixel(const View& view, Random* random) {
  return {random->Uniform(0, view.width_px),
          random->Uniform(0, view.height_px)};
}

FeatureIndex AddPoint(const Vec2& pixel_px, double noise_px, Random* random,
                      ViewFeatures* features) {
  features->points_px.emplace_back(
      pixel_px + Vec2{random->Gaussian(noise_px), random->Gaussian(noise_px)});
  return static_cast<FeatureIndex>(features->points_px.size() - 1);
}

}  // namespace

void ShuffleFeatures(Random* random, Scene* scene) {
  for (auto& [view, features] : scene->features) {
    Shuffle(random, &features.points_px);
    Shuffle(random, &features.segments);
  }
  StatePointEvidence(scene);
}

void DrawFeatures(Random* random, Scene* scene) {
  for (auto& [id, features] : scene->features) {
    const View& view = scene->views.at(id);
    for (Vec2& point : features.points_px) point = AnyPixel(view, random);
    for (LineSegment& segment : features.segments) {
      segment.start_px = AnyPixel(view, random);
      segment.end_px = AnyPixel(view, random);
    }
  }
  StatePointEvidence(scene);
}

void AddLookAlikes(int num_points, double noise_px, Random* random,
                   Scene* scene) {
  if (scene->relative_poses.empty()) return;
  const auto count = static_cast<std::uint32_t>(scene->relative_poses.size());
  RelativePose& pose =
      std::next(scene->relative_poses.begin(), random->Index(count))->second;
  const auto [first, second] = pose.views;
  // Both look at one place, at five times the distance of the two.
  const Vec3 center2 = AnyDirection(random);
  pose.rotation = Eigen::Quaterniond::FromTwoVectors(
                      5 * Vec3::UnitZ() - center2, Vec3::UnitZ())
                      .toRotationMatrix();
  pose.direction = -(pose.rotation * center2);
  pose.covariance.reset();
  pose.point_inliers.clear();
  pose.line_inliers.clear();
  const Intrinsic& camera1 = *scene->FindIntrinsic(first);
  const Intrinsic& camera2 = *scene->FindIntrinsic(second);
  const View& image2 = scene->views.at(second);
  std::uint32_t track = scene->point_tracks.empty()
                            ? 0
                            : scene->point_tracks.rbegin()->first.value() + 1;
  for (int draw = 0; draw < 100 * num_points; ++draw) {
    if (static_cast<int>(pose.point_inliers.size()) == num_points) break;
    const Vec2 seen1 = AnyPixel(scene->views.at(first), random);
    const Vec3 point = random->Uniform(2, 8) * *camera1.Bearing(seen1);
    const Vec3 in_second = pose.Cam2FromCam1() * point;
    if (in_second.z() < 0.1) continue;
    const Vec2 seen2 = camera2.Project(in_second);
    if (seen2.x() < 0 || seen2.x() >= image2.width_px || seen2.y() < 0 ||
        seen2.y() >= image2.height_px) {
      continue;
    }
    const FeatureMatch match = {
        AddPoint(seen1, noise_px, random, &scene->features[first]),
        AddPoint(seen2, noise_px, random, &scene->features[second])};
    pose.point_inliers.push_back(match);
    scene->point_tracks[PointTrackId(track++)] = {{first, match.first},
                                                  {second, match.second}};
  }
  pose.log10_nfa = PointEvidence(*scene, pose);
}

Status MatchAnew(const std::map<ViewId, DetectedFeatures>& detected,
                 const RunContext& context, Scene* scene) {
  std::vector<ViewPair> pairs;
  for (auto i = scene->views.begin(); i != scene->views.end(); ++i) {
    for (auto j = std::next(i); j != scene->views.end(); ++j) {
      pairs.push_back({i->first, j->first});
    }
  }
  LOWLAP_ASSIGN_OR_RETURN(
      const auto matches,
      MatchFeatures(detected, pairs, MatchOptions(), context));
  const auto reports = EstimateRelativePoses(scene, matches, &detected,
                                             RelativePoseOptions(), context);
  return reports ? Status() : tl::unexpected<Error>(reports.error());
}

Status EstimatePosesAnew(const RunContext& context, Scene* scene) {
  std::map<ViewPair, PairMatches> matches;
  for (const auto& [views, pose] : scene->relative_poses) {
    matches[views] = {pose.point_inliers, pose.line_inliers};
  }
  const auto reports = EstimateRelativePoses(scene, matches, nullptr,
                                             RelativePoseOptions(), context);
  return reports ? Status() : tl::unexpected<Error>(reports.error());
}

}  // namespace lowlap
