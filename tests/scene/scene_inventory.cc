#include "scene/scene_inventory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace lowlap::testing {
namespace {

class Inventory {
 public:
  Inventory(const Scene& scene, const SceneContents& contents)
      : scene_(scene), contents_(contents) {
    for (const auto& [id, view] : scene.views) {
      const auto place = static_cast<double>(place_of_view_.size());
      place_of_view_[id] = place;
    }
    AddViews();
    AddFeatures();
    AddPairs();
    AddUnrelatedPairs();
    AddTracks();
    AddStructure();
  }
  const std::vector<SceneItem>& items() const { return items_; }

 private:
  bool Holds(SceneContent content) const {
    return contents_.count(content) > 0;
  }
  template <class Numbers>
  static void Append(const Numbers& more, std::vector<double>* numbers) {
    for (int n = 0; n < more.size(); ++n) numbers->push_back(more.data()[n]);
  }
  /// Relative to the principal point where that is not held, but exists.
  void AppendPixel(ViewId view, const Vec2& pixel,
                   std::vector<double>* numbers) const {
    const bool is_relative =
        Holds(SceneContent::kIntrinsics) && !Holds(SceneContent::kFrames);
    Append(is_relative
               ? Vec2(pixel - scene_.FindIntrinsic(view)->principal_point_px)
               : pixel,
           numbers);
  }
  void AppendSegment(ViewId view, const LineSegment& segment,
                     std::vector<double>* numbers) const {
    AppendPixel(view, segment.start_px, numbers);
    AppendPixel(view, segment.end_px, numbers);
  }

  void AddViews() {
    if (Holds(SceneContent::kRootPath)) {
      items_.push_back({"root path " + scene_.root_path, {}});
    }
    if (Holds(SceneContent::kSharedPoses)) {
      std::map<PoseId, double> views;
      for (const auto& [id, view] : scene_.views) ++views[view.pose_id];
      SceneItem item{"views of a pose", {}};
      for (const auto& [pose, count] : views) item.numbers.push_back(count);
      std::sort(item.numbers.begin(), item.numbers.end());
      items_.push_back(item);
    }
    for (const auto& [id, view] : scene_.views) {
      if (Holds(SceneContent::kNames)) {
        items_.push_back({"view " + view.PathBelowRoot(), {}});
      }
      const Intrinsic* intrinsic = scene_.FindIntrinsic(id);
      if (Holds(SceneContent::kIntrinsics)) {
        items_.push_back({"focal", {intrinsic->fx_px, intrinsic->fy_px}});
      }
      if (Holds(SceneContent::kFrames)) {
        items_.push_back({"frame",
                          {static_cast<double>(intrinsic->width_px),
                           static_cast<double>(intrinsic->height_px),
                           intrinsic->principal_point_px.x(),
                           intrinsic->principal_point_px.y()}});
      }
      if (Holds(SceneContent::kPoses)) {
        const Pose* pose = scene_.FindPose(id);
        ASSERT_NE(pose, nullptr);
        SceneItem item{"pose", {}};
        Append(pose->rotation, &item.numbers);
        Append(pose->center, &item.numbers);
        items_.push_back(item);
      }
      const Pose* solved = scene_.FindPose(id);
      if (Holds(SceneContent::kCenterCovariances) && solved != nullptr &&
          solved->center_covariance) {
        SceneItem item{"covariance", {}};
        Append(*solved->center_covariance, &item.numbers);
        items_.push_back(item);
      }
      if (Holds(SceneContent::kCenterPriors) && view.center_prior) {
        SceneItem item{"prior", {}};
        Append(view.center_prior->center_in_world, &item.numbers);
        items_.push_back(item);
      }
    }
  }

  void AddFeatures() {
    for (const auto& [view, features] : scene_.features) {
      SceneItem points{"key points", {place_of_view_.at(view)}};
      SceneItem segments{"segments", {place_of_view_.at(view)}};
      for (const Vec2& pixel : features.points_px) {
        AppendPixel(view, pixel, &points.numbers);
      }
      for (const LineSegment& segment : features.segments) {
        AppendSegment(view, segment, &segments.numbers);
      }
      if (Holds(SceneContent::kKeypoints)) items_.push_back(points);
      if (Holds(SceneContent::kSegments)) items_.push_back(segments);
      if (Holds(SceneContent::kKeypointShapes)) {
        SceneItem shapes{"shapes", {place_of_view_.at(view)}};
        for (const Vec3& shape : features.point_covariances) {
          Append(shape, &shapes.numbers);
        }
        items_.push_back(shapes);
      }
      if (Holds(SceneContent::kSegmentDeviations)) {
        SceneItem deviations{"deviations", {place_of_view_.at(view)}};
        for (const LineSegment& segment : features.segments) {
          deviations.numbers.push_back(segment.stddev_px);
        }
        items_.push_back(deviations);
      }
      if (Holds(SceneContent::kRepeatedFeatures)) {
        SceneItem repeated{"repeated", {place_of_view_.at(view)}};
        for (const auto* list :
             {&features.repeated_points, &features.repeated_segments}) {
          repeated.numbers.push_back(static_cast<double>(list->size()));
          repeated.numbers.insert(repeated.numbers.end(), list->begin(),
                                  list->end());
        }
        items_.push_back(repeated);
      }
    }
  }

  void AddUnrelatedPairs() {
    if (!Holds(SceneContent::kUnrelatedPairs)) return;
    for (const auto& [first, second] : scene_.unrelated_pairs) {
      items_.push_back(
          {"unrelated", {place_of_view_.at(first), place_of_view_.at(second)}});
    }
  }

  void AddMatches(const char* what, const RelativePose& pose,
                  std::vector<FeatureMatch> matches) {
    if (matches.empty()) return;
    std::sort(matches.begin(), matches.end());
    SceneItem item{what,
                   {place_of_view_.at(pose.views.first),
                    place_of_view_.at(pose.views.second)}};
    for (const FeatureMatch& match : matches) {
      item.numbers.push_back(match.first);
      item.numbers.push_back(match.second);
    }
    items_.push_back(item);
  }

  void AddEvidence(const RelativePose& pose) {
    if (Holds(SceneContent::kPoseEvidence)) {
      items_.push_back({"NFA", {pose.log10_nfa, pose.point_threshold_px}});
    }
    if (Holds(SceneContent::kPoseWeaknesses) && pose.weakness) {
      items_.push_back({PoseWeaknessName(*pose.weakness), {}});
    }
    if (Holds(SceneContent::kPoseCovariances) && pose.covariance) {
      SceneItem item{"covariance of a relative pose", {}};
      Append(*pose.covariance, &item.numbers);
      items_.push_back(item);
    }
    if (!Holds(SceneContent::kAlternatives)) return;
    for (const AlternativeMotion& motion : pose.alternatives) {
      SceneItem item{"alternative", {motion.log10_nfa}};
      Append(motion.rotation, &item.numbers);
      Append(motion.direction, &item.numbers);
      items_.push_back(item);
    }
  }

  void AddPairs() {
    for (const auto& [views, pose] : scene_.relative_poses) {
      if (Holds(SceneContent::kRelativePoses)) {
        SceneItem item{"relative pose", {}};
        Append(pose.rotation, &item.numbers);
        Append(pose.direction, &item.numbers);
        items_.push_back(item);
      }
      AddEvidence(pose);
      if (Holds(SceneContent::kPointMatches)) {
        AddMatches("point matches", pose, pose.point_inliers);
      }
      if (Holds(SceneContent::kLineMatches)) {
        AddMatches("line matches", pose, pose.line_inliers);
      }
    }
    if (!Holds(SceneContent::kRatios)) return;
    for (const ScaleRatio& ratio : scene_.scale_ratios) {
      items_.push_back({"ratio", {ratio.log_ratio, ratio.log_ratio_stddev}});
    }
  }

  void AddTracks() {
    if (Holds(SceneContent::kPointTracks)) {
      for (const auto& [id, track] : scene_.point_tracks) {
        SceneItem item{"point track", {}};
        for (const FeatureRef& feature : track) {
          item.numbers.push_back(place_of_view_.at(feature.view));
          item.numbers.push_back(feature.feature);
        }
        items_.push_back(item);
      }
    }
    if (!Holds(SceneContent::kLineTracks)) return;
    for (const auto& [id, track] : scene_.line_tracks) {
      SceneItem item{"line track", {}};
      for (const FeatureRef& feature : track) {
        item.numbers.push_back(place_of_view_.at(feature.view));
        AppendSegment(
            feature.view,
            scene_.features.at(feature.view).segments[feature.feature],
            &item.numbers);
      }
      items_.push_back(item);
    }
  }

  void AddStructure() {
    for (const auto& [id, landmark] : scene_.structure) {
      SceneItem point{"point", {}};
      Append(landmark.position, &point.numbers);
      if (Holds(SceneContent::kPoints)) items_.push_back(point);
      if (!Holds(SceneContent::kObservations)) continue;
      SceneItem seen{"observations", {}};
      for (const PointObservation& observation : landmark.observations) {
        seen.numbers.push_back(place_of_view_.at(observation.view));
        AppendPixel(observation.view, observation.pixel_px, &seen.numbers);
      }
      items_.push_back(seen);
    }
    if (Holds(SceneContent::kLines)) {
      for (const auto& [id, line] : scene_.line_structure) {
        SceneItem item{"line", {}};
        Append(line.start, &item.numbers);
        Append(line.end, &item.numbers);
        Append(line.line.direction, &item.numbers);
        Append(line.line.moment, &item.numbers);
        items_.push_back(item);
      }
    }
    if (Holds(SceneContent::kLineObservations)) {
      for (const auto& [id, line] : scene_.line_structure) {
        items_.push_back(
            {"line seen", {static_cast<double>(line.observations.size())}});
      }
    }
    if (Holds(SceneContent::kCoplanarPairs)) {
      items_.push_back(
          {"coplanar pairs", {double(scene_.coplanar_pairs.size())}});
    }
    if (Holds(SceneContent::kControlPoints)) {
      items_.push_back(
          {"control points", {double(scene_.control_points.size())}});
    }
  }

  const Scene& scene_;
  const SceneContents& contents_;
  std::map<ViewId, double> place_of_view_;
  std::vector<SceneItem> items_;
};

}  // namespace

std::vector<SceneItem> InventoryOf(const Scene& scene,
                                   const SceneContents& contents) {
  return Inventory(scene, contents).items();
}

}  // namespace lowlap::testing
