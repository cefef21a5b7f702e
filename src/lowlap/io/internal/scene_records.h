#pragma once

#include "lowlap/io/internal/transfer.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

// The bytes of every record of the binary form (sfm_data/FORMAT.md). They are
// function objects, to be handed to the templates of transfer.h for writing and
// for reading.

inline constexpr auto kTransferView = [](auto& archive, auto& view) {
  archive.Text(view.local_path);
  archive.Text(view.filename);
  archive.Count(view.width_px);
  archive.Count(view.height_px);
  archive.Integer(view.intrinsic_id);
  archive.Integer(view.pose_id);
  TransferOptional(archive, view.center_prior, [](auto& a, auto& prior) {
    a.Reals(prior.weight.data(), 3);
    a.Reals(prior.center_in_world.data(), 3);
  });
};

inline constexpr auto kTransferIntrinsic = [](auto& archive, auto& intrinsic) {
  TransferEnum(archive, intrinsic.model, CameraModel::kSpherical);
  archive.Count(intrinsic.width_px);
  archive.Count(intrinsic.height_px);
  archive.Real(intrinsic.fx_px);
  archive.Real(intrinsic.fy_px);
  archive.Reals(intrinsic.principal_point_px.data(), 2);
  TransferVector(archive, intrinsic.distortion, sizeof(double),
                 [](auto& a, auto& coefficient) { a.Real(coefficient); });
};

inline constexpr auto kTransferPose = [](auto& archive, auto& pose) {
  TransferMatrix(archive, pose.rotation);
  archive.Reals(pose.center.data(), 3);
};

inline constexpr auto kTransferLandmark = [](auto& archive, auto& landmark) {
  archive.Reals(landmark.position.data(), 3);
  TransferVector(archive, landmark.observations, 24,
                 [](auto& a, auto& observation) {
                   a.Integer(observation.view);
                   a.Integer(observation.feature);
                   a.Reals(observation.pixel_px.data(), 2);
                 });
};

inline constexpr auto kTransferFeatures = [](auto& archive, auto& features) {
  TransferVector(archive, features.points_px, 16,
                 [](auto& a, auto& point) { a.Reals(point.data(), 2); });
  TransferVector(archive, features.point_covariances, 24,
                 [](auto& a, auto& shape) { a.Reals(shape.data(), 3); });
  TransferVector(archive, features.segments, 40, [](auto& a, auto& segment) {
    a.Reals(segment.start_px.data(), 2);
    a.Reals(segment.end_px.data(), 2);
    a.Real(segment.stddev_px);
  });
};

inline constexpr auto kTransferMatch = [](auto& archive, auto& match) {
  archive.Integer(match.first);
  archive.Integer(match.second);
};

inline constexpr std::size_t kRelativePoseMinBytes = 8 + 14 * 8 + 1 + 3 * 8;
inline constexpr std::size_t kAlternativeMinBytes = 13 * 8 + 1;

inline constexpr auto kTransferCovariance = [](auto& archive,
                                               auto& covariance) {
  TransferMatrix(archive, covariance);
};

inline constexpr auto kTransferAlternative = [](auto& archive, auto& motion) {
  TransferMatrix(archive, motion.rotation);
  archive.Reals(motion.direction.data(), 3);
  archive.Real(motion.log10_nfa);
  TransferOptional(archive, motion.covariance, kTransferCovariance);
};

inline constexpr auto kTransferRelativePose = [](auto& archive, auto& edge) {
  archive.Integer(edge.views.first);
  archive.Integer(edge.views.second);
  TransferMatrix(archive, edge.rotation);
  archive.Reals(edge.direction.data(), 3);
  archive.Real(edge.log10_nfa);
  archive.Real(edge.point_threshold_px);
  TransferOptional(archive, edge.covariance, kTransferCovariance);
  TransferVector(archive, edge.point_inliers, 8, kTransferMatch);
  TransferVector(archive, edge.line_inliers, 8, kTransferMatch);
  TransferVector(archive, edge.alternatives, kAlternativeMinBytes,
                 kTransferAlternative);
};

/// The number of relative poses, then each; their pairs of views ascend.
template <class Archive, class Map>
void TransferRelativePoses(Archive& archive, Map& map) {
  std::size_t size = archive.Length(map.size(), kRelativePoseMinBytes);
  if constexpr (Archive::kReads) {
    for (; size > 0; --size) {
      RelativePose edge;
      kTransferRelativePose(archive, edge);
      if (!map.empty() && !(map.rbegin()->first < edge.views)) {
        archive.Fail("pairs of views must ascend");
      }
      const ViewPair views = edge.views;
      map.emplace_hint(map.end(), views, std::move(edge));
    }
  } else {
    for (auto& [views, edge] : map) kTransferRelativePose(archive, edge);
  }
}

inline constexpr auto kTransferTrack = [](auto& archive, auto& track) {
  TransferVector(archive, track, 8, [](auto& a, auto& ref) {
    a.Integer(ref.view);
    a.Integer(ref.feature);
  });
};

inline constexpr auto kTransferLine = [](auto& archive, auto& landmark) {
  archive.Reals(landmark.line.direction.data(), 3);
  archive.Reals(landmark.line.moment.data(), 3);
  archive.Reals(landmark.start.data(), 3);
  archive.Reals(landmark.end.data(), 3);
  kTransferTrack(archive, landmark.observations);
};

}  // namespace lowlap
