#include <map>
#include <utility>

#include "lowlap/io/internal/byte_archive.h"
#include "third_party_adapters/openmvg/internal/polymorphic.h"
#include "third_party_adapters/openmvg/internal/sfm_data_bin.h"

namespace lowlap::openmvg {
namespace {

class SfmDataWriter {
 public:
  std::string Write(const Scene& scene) {
    out_.Integer(std::uint8_t{1});  // little-endian
    out_.Text("0.3");
    out_.Text(scene.root_path);
    WriteCount(scene.views.size());
    for (const auto& [id, view] : scene.views) WriteView(id, view);
    WriteCount(scene.intrinsics.size());
    for (const auto& [id, intrinsic] : scene.intrinsics) {
      WriteIntrinsic(id, intrinsic);
    }
    WriteCount(scene.poses.size());
    for (const auto& [id, pose] : scene.poses) WritePose(id, pose);
    WriteLandmarks(scene.structure);
    WriteLandmarks(scene.control_points);
    return std::move(bytes_);
  }

 private:
  void WriteCount(std::size_t count) { out_.Length(count, 1); }
  void WriteReals(const double* values, std::size_t count) {
    WriteCount(count);
    out_.Reals(values, count);
  }

  void WriteTypeName(const std::string& name) {
    const auto next = static_cast<std::uint32_t>(type_ids_.size() + 1);
    const auto [entry, is_new] = type_ids_.emplace(name, next);
    if (is_new) {
      out_.Integer(entry->second | kDefines);
      out_.Text(name);
    } else {
      out_.Integer(entry->second);
    }
  }

  void WriteNewObjectId() { out_.Integer(++num_objects_ | kDefines); }

  void WriteView(ViewId id, const View& view) {
    out_.Integer(id);
    if (view.center_prior) {
      WriteTypeName("view_priors");
    } else {
      out_.Integer(kStaticType);
    }
    WriteNewObjectId();
    out_.Text(view.local_path);
    out_.Text(view.filename);
    out_.Integer(static_cast<std::uint32_t>(view.width_px));
    out_.Integer(static_cast<std::uint32_t>(view.height_px));
    out_.Integer(id);
    out_.Integer(view.intrinsic_id);
    out_.Integer(view.pose_id);
    if (view.center_prior) {
      out_.Integer(std::uint8_t{1});
      WriteReals(view.center_prior->weight.data(), 3);
      WriteReals(view.center_prior->center_in_world.data(), 3);
    }
  }

  void WriteIntrinsic(IntrinsicId id, const Intrinsic& intrinsic) {
    out_.Integer(id);
    WriteTypeName(CameraModelName(intrinsic.model));
    WriteNewObjectId();
    out_.Integer(static_cast<std::uint32_t>(intrinsic.width_px));
    out_.Integer(static_cast<std::uint32_t>(intrinsic.height_px));
    if (intrinsic.model == CameraModel::kSpherical) return;
    out_.Real(intrinsic.fx_px);
    WriteReals(intrinsic.principal_point_px.data(), 2);
    if (DistortionCount(intrinsic.model) > 0) {
      WriteReals(intrinsic.distortion.data(), intrinsic.distortion.size());
    }
  }

  void WritePose(PoseId id, const Pose& pose) {
    out_.Integer(id);
    WriteCount(3);
    for (int row = 0; row < 3; ++row) {
      const Vec3 values = pose.rotation.row(row);
      WriteReals(values.data(), 3);
    }
    WriteReals(pose.center.data(), 3);
  }

  template <class Landmarks>
  void WriteLandmarks(const Landmarks& landmarks) {
    WriteCount(landmarks.size());
    for (const auto& [id, landmark] : landmarks) {
      out_.Integer(id);
      WriteReals(landmark.position.data(), 3);
      WriteCount(landmark.observations.size());
      for (const PointObservation& observation : landmark.observations) {
        out_.Integer(observation.view);
        out_.Integer(observation.feature);
        WriteReals(observation.pixel_px.data(), 2);
      }
    }
  }

  std::string bytes_;
  lowlap::ByteWriter out_{bytes_};
  std::map<std::string, std::uint32_t> type_ids_;
  std::uint32_t num_objects_ = 0;
};

}  // namespace

std::string SerializeSfmDataBin(const Scene& scene) {
  return SfmDataWriter().Write(scene);
}

}  // namespace lowlap::openmvg
