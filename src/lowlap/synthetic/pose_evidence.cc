#include "lowlap/synthetic/internal/pose_evidence.h"

#include <algorithm>
#include <vector>

#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/robust/internal/a_contrario.h"

namespace lowlap {
namespace {

constexpr int kSampleSize = 5;
constexpr int kModelsPerSample = 10;
constexpr double kMinThresholdPx = 0.1;
constexpr double kMaxThresholdPx = 16;

}  // namespace

double PointEvidence(const Scene& scene, const RelativePose& pose) {
  const auto [first, second] = pose.views;
  const Intrinsic& camera1 = *scene.FindIntrinsic(first);
  const Intrinsic& camera2 = *scene.FindIntrinsic(second);
  const std::vector<Vec2>& points1_px = scene.features.at(first).points_px;
  const std::vector<Vec2>& points2_px = scene.features.at(second).points_px;
  const Mat3 essential = EssentialFromPose(pose.Cam2FromCam1());
  std::vector<float> squared_px;
  for (const FeatureMatch& match : pose.point_inliers) {
    const auto x1 = camera1.Normalize(points1_px[match.first]);
    const auto x2 = camera2.Normalize(points2_px[match.second]);
    if (!x1 || !x2) continue;
    squared_px.push_back(static_cast<float>(
        camera1.MeanFocalPx() * camera2.MeanFocalPx() *
        SampsonSquared(essential, x1->homogeneous(), x2->homogeneous())));
  }
  if (squared_px.size() <= kSampleSize) return 0;
  const AContrarioLadder ladder(
      static_cast<int>(squared_px.size()), kSampleSize, kModelsPerSample,
      BackgroundLaw::Sampson(camera1.ImageArea(), camera1.ImageDiagonal()),
      kMinThresholdPx, kMaxThresholdPx);
  return std::min(0.0, ladder.Score(squared_px).log10_nfa);
}

void StatePointEvidence(Scene* scene) {
  for (auto& entry : scene->relative_poses) {
    entry.second.log10_nfa = PointEvidence(*scene, entry.second);
  }
}

}  // namespace lowlap
