#include <map>

#include "third_party_adapters/openmvg/internal/archive_writer.h"
#include "third_party_adapters/openmvg/internal/polymorphic.h"
#include "third_party_adapters/openmvg/sfm_data_bin.h"

namespace lowlap::openmvg {
namespace {

class SfmDataWriter {
 public:
  std::string Write(const Scene& scene) {
    out_.String("0.3");
    out_.String(scene.root_path);
    out_.Count(scene.views.size());
    for (const auto& [id, view] : scene.views) WriteView(id, view);
    out_.Count(scene.intrinsics.size());
    for (const auto& [id, intrinsic] : scene.intrinsics) {
      WriteIntrinsic(id, intrinsic);
    }
    out_.Count(scene.poses.size());
    for (const auto& [id, pose] : scene.poses) WritePose(id, pose);
    WriteLandmarks(scene.structure);
    WriteLandmarks(scene.control_points);
    return out_.TakeBytes();
  }

 private:
  void WriteTypeName(const std::string& name) {
    const auto next = static_cast<std::uint32_t>(type_ids_.size() + 1);
    const auto [entry, is_new] = type_ids_.emplace(name, next);
    if (is_new) {
      out_.U32(entry->second | internal::kDefines);
      out_.String(name);
    } else {
      out_.U32(entry->second);
    }
  }

  void WriteNewObjectId() { out_.U32(++num_objects_ | internal::kDefines); }

  void WriteView(ViewId id, const View& view) {
    out_.U32(id);
    if (view.center_prior) {
      WriteTypeName("view_priors");
    } else {
      out_.U32(internal::kStaticType);
    }
    WriteNewObjectId();
    out_.String(view.local_path);
    out_.String(view.filename);
    out_.U32(static_cast<std::uint32_t>(view.width_px));
    out_.U32(static_cast<std::uint32_t>(view.height_px));
    out_.U32(id);
    out_.U32(view.intrinsic_id);
    out_.U32(view.pose_id);
    if (view.center_prior) {
      out_.Scalar<std::uint8_t>(1);
      out_.Doubles(view.center_prior->weight.data(), 3);
      out_.Doubles(view.center_prior->center_in_world.data(), 3);
    }
  }

  void WriteIntrinsic(IntrinsicId id, const Intrinsic& intrinsic) {
    out_.U32(id);
    WriteTypeName(CameraModelName(intrinsic.model));
    WriteNewObjectId();
    out_.U32(static_cast<std::uint32_t>(intrinsic.width_px));
    out_.U32(static_cast<std::uint32_t>(intrinsic.height_px));
    if (intrinsic.model == CameraModel::kSpherical) return;
    out_.Scalar(intrinsic.fx_px);
    out_.Doubles(intrinsic.principal_point_px.data(), 2);
    if (DistortionCount(intrinsic.model) > 0) {
      out_.Doubles(intrinsic.distortion.data(), intrinsic.distortion.size());
    }
  }

  void WritePose(PoseId id, const Pose& pose) {
    out_.U32(id);
    out_.Count(3);
    for (int row = 0; row < 3; ++row) {
      const Vec3 values = pose.rotation.row(row);
      out_.Doubles(values.data(), 3);
    }
    out_.Doubles(pose.center.data(), 3);
  }

  void WriteLandmarks(const std::map<std::uint32_t, Landmark>& landmarks) {
    out_.Count(landmarks.size());
    for (const auto& [id, landmark] : landmarks) {
      out_.U32(id);
      out_.Doubles(landmark.position.data(), 3);
      out_.Count(landmark.observations.size());
      for (const PointObservation& observation : landmark.observations) {
        out_.U32(observation.view);
        out_.U32(observation.feature);
        out_.Doubles(observation.pixel_px.data(), 2);
      }
    }
  }

  internal::ArchiveWriter out_;
  std::map<std::string, std::uint32_t> type_ids_;
  std::uint32_t num_objects_ = 0;
};

}  // namespace

std::string SerializeSfmDataBin(const Scene& scene) {
  return SfmDataWriter().Write(scene);
}

}  // namespace lowlap::openmvg
