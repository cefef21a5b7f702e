#include "lowlap/evaluation/internal/line_match_errors.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lowlap/scene/features.h"

namespace lowlap {
namespace {

using EdgeSet = std::set<std::size_t>;

// What the truth says of one view.
struct JudgedView {
  int image = 0;
  Pose pose;
  NormalizedFeatures features;
  std::vector<EdgeSet> on;    // per segment: edges on which it lies
  std::vector<EdgeSet> near;  // edges near which it lies
};

bool Intersect(const EdgeSet& a, const EdgeSet& b) {
  return std::any_of(a.begin(), a.end(),
                     [&](std::size_t e) { return b.count(e) > 0; });
}

// Whether the epipolar lines of the end points of `first` cut the line of
// `second` outside of it or behind a camera. A line near an epipolar plane is
// not judged.
bool IsExcluded(const NormalizedSegment& first, const NormalizedSegment& second,
                const RigidTransform& cam2_from_cam1) {
  constexpr double kMinSine = 0.03;
  if (!first.IsValid() || !second.IsValid()) return false;
  const Vec3 plane = cam2_from_cam1.rotation.transpose() * second.normal;
  const double offset = -second.normal.dot(cam2_from_cam1.translation);
  if (plane.cross(first.normal).norm() < kMinSine ||
      std::abs(offset) < kMinSine * cam2_from_cam1.translation.norm()) {
    return false;
  }
  const Vec2 along = (second.end - second.start).head<2>();
  double at[2];
  const Vec3* const ends[2] = {&first.start, &first.end};
  for (int n = 0; n < 2; ++n) {
    const double depth = offset / plane.dot(*ends[n]);
    const Vec3 point = cam2_from_cam1 * (depth * *ends[n]);
    if (!(depth > 0) || !(point.z() > 0)) return true;
    at[n] = along.dot(point.hnormalized() - second.start.head<2>()) /
            along.squaredNorm();
  }
  const double slack = 0.1;
  return std::max(at[0], at[1]) < -slack || std::min(at[0], at[1]) > 1 + slack;
}

void Judge(const JudgedView& first, const JudgedView& second,
           const std::vector<TrueEdge>& edges,
           const std::vector<FeatureMatch>& matches, LineMatchCounts* counts) {
  const RigidTransform cam2_from_cam1 =
      second.pose.CamFromWorld() * first.pose.CamFromWorld().Inverse();
  // Edges of the one that the other image shows, and the other is not near.
  const auto misses = [&](const EdgeSet& on, const EdgeSet& near, int image) {
    return std::any_of(on.begin(), on.end(),
                       [&](std::size_t e) {
                         return edges[e].images.count(image) > 0;
                       }) &&
           !Intersect(on, near);
  };
  EdgeSet matched;
  for (const FeatureMatch& match : matches) {
    if (match.first >= first.on.size() || match.second >= second.on.size()) {
      continue;
    }
    ++counts->num_matches;
    const EdgeSet& on1 = first.on[match.first];
    const EdgeSet& on2 = second.on[match.second];
    if (Intersect(on1, on2)) {
      ++counts->num_right;
      std::set_intersection(on1.begin(), on1.end(), on2.begin(), on2.end(),
                            std::inserter(matched, matched.end()));
    } else if ((!on1.empty() && !on2.empty()) ||
               misses(on1, second.near[match.second], second.image) ||
               misses(on2, first.near[match.first], first.image)) {
      ++counts->num_wrong;
    } else {
      ++counts->num_unknown;
      counts->num_excluded +=
          IsExcluded(first.features.segments[match.first],
                     second.features.segments[match.second], cam2_from_cam1);
    }
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].images.count(first.image) == 0 ||
        edges[e].images.count(second.image) == 0) {
      continue;
    }
    ++counts->num_common_edges;
    counts->num_matched_edges += static_cast<int>(matched.count(e));
  }
}

void Add(const LineMatchCounts& part, LineMatchCounts* total) {
  total->num_matches += part.num_matches;
  total->num_right += part.num_right;
  total->num_wrong += part.num_wrong;
  total->num_unknown += part.num_unknown;
  total->num_excluded += part.num_excluded;
  total->num_common_edges += part.num_common_edges;
  total->num_matched_edges += part.num_matched_edges;
}

double Share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0;
}

}  // namespace

double LineMatchCounts::Precision() const {
  return Share(num_right, num_right + num_wrong);
}

double LineMatchCounts::Recall() const {
  return Share(num_matched_edges, num_common_edges);
}

Result<LineMatchEvaluation> EvaluateLineMatches(
    const Scene& scene, const GroundTruth& truth,
    const std::vector<TrueEdge>& edges, const std::vector<ViewPair>& pairs,
    const EdgeAssignmentRule& rule) {
  EdgeAssignmentRule near = rule;
  near.max_angle_deg *= 2;
  near.max_distance_px *= 2;
  std::map<ViewId, JudgedView> views;
  for (const auto& [id, view] : scene.views) {
    const auto pose = truth.find(id);
    const std::optional<int> image = ImageNumber(view);
    const Intrinsic* intrinsic = scene.FindIntrinsic(id);
    if (pose == truth.end() || !image || intrinsic == nullptr) continue;
    JudgedView& judged = views[id];
    judged.image = *image;
    judged.pose = pose->second;
    const auto features = scene.features.find(id);
    if (features == scene.features.end()) continue;
    const std::vector<LineSegment>& segments = features->second.segments;
    judged.features = NormalizeFeatures(features->second, *intrinsic);
    judged.on =
        AssignEdges(segments, edges, *image, pose->second, *intrinsic, rule);
    judged.near =
        AssignEdges(segments, edges, *image, pose->second, *intrinsic, near);
  }
  LineMatchEvaluation evaluation;
  for (const ViewPair& pair : pairs) {
    const auto first = views.find(pair.first);
    const auto second = views.find(pair.second);
    if (first == views.end() || second == views.end()) {
      ++evaluation.num_without_truth;
      continue;
    }
    PairLineMatches result;
    result.views = pair;
    const auto pose = scene.relative_poses.find(pair);
    result.has_relative_pose = pose != scene.relative_poses.end();
    Judge(first->second, second->second, edges,
          result.has_relative_pose ? pose->second.line_inliers
                                   : std::vector<FeatureMatch>{},
          &result.counts);
    Add(result.counts, &evaluation.total);
    evaluation.pairs.push_back(result);
  }
  if (evaluation.pairs.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     "no pair of views has true poses and numbered images");
  }
  return evaluation;
}

}  // namespace lowlap
