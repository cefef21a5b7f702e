#include "lowlap/io/scene_content.h"

#include <algorithm>
#include <map>

namespace lowlap {
namespace {

/// The sum of `size(value)` over the values of a map.
template <class Map, class Size>
std::size_t Sum(const Map& map, const Size& size) {
  std::size_t sum = 0;
  for (const auto& entry : map) sum += size(entry.second);
  return sum;
}

/// Poses that several views have in common.
std::size_t CountSharedPoses(const Scene& scene) {
  std::map<PoseId, std::size_t> views;
  for (const auto& entry : scene.views) ++views[entry.second.pose_id];
  views.erase(kInvalidId);
  return Sum(views, [](std::size_t count) { return count > 1; });
}

std::size_t CountUnlikeDefault(const std::vector<LineSegment>& segments) {
  return static_cast<std::size_t>(
      std::count_if(segments.begin(), segments.end(), [](const auto& segment) {
        return segment.stddev_px != LineSegment().stddev_px;
      }));
}

bool HasEvidence(const RelativePose& pose) {
  return pose.log10_nfa != 0 || pose.point_threshold_px != 0;
}

std::string Joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : ", ") + part;
  }
  return text;
}

}  // namespace

const std::vector<ContentKind>& ContentKinds() {
  using Content = SceneContent;
  static const std::vector<ContentKind> kinds = {
      {Content::kRootPath, "image folder",
       [](const Scene& scene) -> std::size_t {
         return scene.root_path.empty() ? 0 : 1;
       }},
      {Content::kNames, "names",
       [](const Scene& scene) {
         return Sum(scene.views,
                    [](const View& view) { return !view.filename.empty(); });
       }},
      {Content::kIntrinsics, "intrinsics",
       [](const Scene& scene) { return scene.intrinsics.size(); }},
      {Content::kFrames, "image sizes and principal points",
       [](const Scene& scene) { return scene.intrinsics.size(); }},
      {Content::kDistortions, "distortions",
       [](const Scene& scene) {
         return Sum(scene.intrinsics,
                    [](const Intrinsic& i) { return i.HasDistortion(); });
       }},
      {Content::kGivenIntrinsics, "given intrinsics",
       [](const Scene& scene) { return scene.given_intrinsics.size(); }},
      {Content::kPoses, "poses",
       [](const Scene& scene) { return scene.poses.size(); }},
      {Content::kSharedPoses, "shared poses", CountSharedPoses},
      {Content::kCenterCovariances, "covariances of centres",
       [](const Scene& scene) {
         return Sum(scene.poses, [](const Pose& pose) {
           return pose.center_covariance.has_value();
         });
       }},
      {Content::kCenterPriors, "measured centres",
       [](const Scene& scene) {
         return Sum(scene.views, [](const View& view) {
           return view.center_prior.has_value();
         });
       }},
      {Content::kKeypoints, "key points",
       [](const Scene& scene) {
         return Sum(scene.features, [](const ViewFeatures& features) {
           return features.points_px.size();
         });
       }},
      {Content::kKeypointShapes, "shapes of key point errors",
       [](const Scene& scene) {
         return Sum(scene.features, [](const ViewFeatures& features) {
           return features.point_covariances.size();
         });
       }},
      {Content::kSegments, "segments",
       [](const Scene& scene) {
         return Sum(scene.features, [](const ViewFeatures& features) {
           return features.segments.size();
         });
       }},
      {Content::kSegmentDeviations, "standard deviations of segments",
       [](const Scene& scene) {
         return Sum(scene.features, [](const ViewFeatures& features) {
           return CountUnlikeDefault(features.segments);
         });
       }},
      {Content::kRepeatedFeatures, "marks of features that repeat",
       [](const Scene& scene) {
         return Sum(scene.features, [](const ViewFeatures& features) {
           return features.repeated_points.size() +
                  features.repeated_segments.size();
         });
       }},
      {Content::kRelativePoses, "relative poses",
       [](const Scene& scene) { return scene.relative_poses.size(); }},
      {Content::kUnrelatedPairs, "pairs compared in vain",
       [](const Scene& scene) { return scene.unrelated_pairs.size(); }},
      {Content::kPoseEvidence, "NFAs of relative poses",
       [](const Scene& scene) {
         return Sum(scene.relative_poses, HasEvidence);
       }},
      {Content::kPoseWeaknesses, "weaknesses of relative poses",
       [](const Scene& scene) {
         return Sum(scene.relative_poses, [](const RelativePose& pose) {
           return pose.weakness.has_value();
         });
       }},
      {Content::kPoseCovariances, "covariances of relative poses",
       [](const Scene& scene) {
         return Sum(scene.relative_poses, [](const RelativePose& pose) {
           return pose.covariance.has_value();
         });
       }},
      {Content::kAlternatives, "alternatives of relative poses",
       [](const Scene& scene) {
         return Sum(scene.relative_poses, [](const RelativePose& pose) {
           return pose.alternatives.size();
         });
       }},
      {Content::kPointMatches, "point matches",
       [](const Scene& scene) {
         return Sum(scene.relative_poses, [](const RelativePose& pose) {
           return pose.point_inliers.size();
         });
       }},
      {Content::kLineMatches, "line matches",
       [](const Scene& scene) {
         return Sum(scene.relative_poses, [](const RelativePose& pose) {
           return pose.line_inliers.size();
         });
       }},
      {Content::kPointTracks, "point tracks",
       [](const Scene& scene) { return scene.point_tracks.size(); }},
      {Content::kLineTracks, "line tracks",
       [](const Scene& scene) { return scene.line_tracks.size(); }},
      {Content::kRatios, "ratios",
       [](const Scene& scene) { return scene.scale_ratios.size(); }},
      {Content::kPoints, "points",
       [](const Scene& scene) { return scene.structure.size(); }},
      {Content::kObservations, "observations of points",
       [](const Scene& scene) {
         return Sum(scene.structure, [](const Landmark& landmark) {
           return landmark.observations.size();
         });
       }},
      {Content::kLines, "lines",
       [](const Scene& scene) { return scene.line_structure.size(); }},
      {Content::kLineObservations, "observations of lines",
       [](const Scene& scene) {
         return Sum(scene.line_structure, [](const LineLandmark& line) {
           return line.observations.size();
         });
       }},
      {Content::kCoplanarPairs, "coplanar pairs",
       [](const Scene& scene) { return scene.coplanar_pairs.size(); }},
      {Content::kControlPoints, "control points",
       [](const Scene& scene) { return scene.control_points.size(); }},
  };
  return kinds;
}

SceneContents AllContents() {
  SceneContents all;
  for (const ContentKind& kind : ContentKinds()) all.insert(kind.content);
  return all;
}

std::string DescribeContents(const SceneContents& contents) {
  if (contents == AllContents()) return "everything";
  std::vector<std::string> names;
  for (const ContentKind& kind : ContentKinds()) {
    if (contents.count(kind.content) > 0) names.push_back(kind.name);
  }
  return Joined(names);
}

std::string DescribeLoss(const Scene& scene, const SceneContents& contents) {
  std::vector<std::string> losses;
  for (const ContentKind& kind : ContentKinds()) {
    if (contents.count(kind.content) > 0) continue;
    if (const std::size_t count = kind.count(scene); count > 0) {
      losses.push_back(std::to_string(count) + " " + kind.name);
    }
  }
  return Joined(losses);
}

}  // namespace lowlap
