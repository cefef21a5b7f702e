#include <map>

#include "lowlap/io/internal/cereal_pointers.h"
#include "lowlap/io/internal/json/json_text.h"
#include "lowlap/io/internal/json/scene_json_sections.h"

namespace lowlap {
namespace {

void AppendMember(std::string_view name, std::uint32_t value,
                  std::string& text) {
  AppendKey(name, text);
  AppendInteger(value, text);
}

void AppendMember(std::string_view name, int value, std::string& text) {
  AppendMember(name, static_cast<std::uint32_t>(value), text);
}

// Opens {"key": id, "value": {polymorphic pointer {"data": {  and numbers the
// types and objects as cereal does: from 1, over the whole archive.
class PointerWriter {
 public:
  void Open(std::uint32_t key, const std::string& type_name,
            std::string& text) {
    text += "{";
    AppendMember("key", key, text);
    AppendKey("value", text);
    text += "{";
    if (type_name.empty()) {
      AppendMember("polymorphic_id", CerealPointers::kStaticType, text);
    } else {
      const auto [entry, is_new] = type_ids_.try_emplace(
          type_name, static_cast<std::uint32_t>(type_ids_.size() + 1));
      AppendMember("polymorphic_id",
                   entry->second | (is_new ? CerealPointers::kDefines : 0),
                   text);
      if (is_new) {
        AppendKey("polymorphic_name", text);
        AppendString(type_name, text);
      }
    }
    AppendKey("ptr_wrapper", text);
    text += "{";
    AppendMember("id", ++object_count_ | CerealPointers::kDefines, text);
    AppendKey("data", text);
    text += "{";
  }

  static void Close(std::string& text) { text += "}}}}"; }

 private:
  std::map<std::string, std::uint32_t> type_ids_;
  std::uint32_t object_count_ = 0;
};

void AppendView(ViewId id, const View& view, PointerWriter& pointers,
                std::string& text) {
  pointers.Open(id.value(), view.center_prior ? "view_priors" : "", text);
  AppendKey("local_path", text);
  AppendString(view.local_path, text);
  AppendKey("filename", text);
  AppendString(view.filename, text);
  AppendMember("width", view.width_px, text);
  AppendMember("height", view.height_px, text);
  AppendMember("id_view", id.value(), text);
  AppendMember("id_intrinsic", view.intrinsic_id.value(), text);
  AppendMember("id_pose", view.pose_id.value(), text);
  if (view.center_prior) {
    AppendKey("use_pose_center_prior", text);
    text += "true";
    AppendKey("center_weight", text);
    AppendVector(view.center_prior->weight, text);
    AppendKey("center", text);
    AppendVector(view.center_prior->center_in_world, text);
  }
  PointerWriter::Close(text);
}

void AppendIntrinsic(IntrinsicId id, const Intrinsic& intrinsic,
                     PointerWriter& pointers, std::string& text) {
  const bool is_spherical = intrinsic.model == CameraModel::kSpherical;
  pointers.Open(id.value(), CameraModelName(intrinsic.model), text);
  if (is_spherical) text += "\"value0\": {";
  AppendMember("width", intrinsic.width_px, text);
  AppendMember("height", intrinsic.height_px, text);
  if (is_spherical) {
    text += "}";
  } else {
    const bool is_square = intrinsic.fx_px == intrinsic.fy_px;
    AppendKey("focal_length", text);
    AppendReal(is_square ? intrinsic.fx_px : intrinsic.MeanFocalPx(), text);
    if (!is_square) {
      AppendKey("fx", text);
      AppendReal(intrinsic.fx_px, text);
      AppendKey("fy", text);
      AppendReal(intrinsic.fy_px, text);
    }
    AppendKey("principal_point", text);
    AppendVector(intrinsic.principal_point_px, text);
    if (const std::string key = DistortionKey(intrinsic.model); !key.empty()) {
      AppendKey(key, text);
      AppendVector(Eigen::Map<const Eigen::VectorXd>(
                       intrinsic.distortion.data(),
                       static_cast<Eigen::Index>(intrinsic.distortion.size())),
                   text);
    }
  }
  PointerWriter::Close(text);
}

void AppendPose(PoseId id, const Pose& pose, std::string& text) {
  text += "{";
  AppendMember("key", id.value(), text);
  AppendKey("value", text);
  text += "{";
  AppendKey("rotation", text);
  AppendMatrix(pose.rotation, text);
  AppendKey("center", text);
  AppendVector(pose.center, text);
  text += "}}";
}

void AppendLandmark(std::uint32_t id, const Landmark& landmark,
                    std::string& text) {
  text += "{";
  AppendMember("key", id, text);
  AppendKey("value", text);
  text += "{";
  AppendKey("X", text);
  AppendVector(landmark.position, text);
  AppendKey("observations", text);
  text += "[";
  for (const PointObservation& observation : landmark.observations) {
    AppendComma(text);
    text += "{";
    AppendMember("key", observation.view.value(), text);
    AppendKey("value", text);
    text += "{";
    AppendMember("id_feat", observation.feature, text);
    AppendKey("x", text);
    AppendVector(observation.pixel_px, text);
    text += "}}";
  }
  text += "]}}";
}

}  // namespace

void AppendOpenMvgSections(const Scene& scene, std::string& text) {
  PointerWriter pointers;
  const auto append_view = [&](const auto& entry, std::string& out) {
    AppendView(entry.first, entry.second, pointers, out);
  };
  const auto append_intrinsic = [&](const auto& entry, std::string& out) {
    AppendIntrinsic(entry.first, entry.second, pointers, out);
  };
  const auto append_pose = [](const auto& entry, std::string& out) {
    AppendPose(entry.first, entry.second, out);
  };
  const auto append_landmark = [](const auto& entry, std::string& out) {
    AppendLandmark(static_cast<std::uint32_t>(entry.first), entry.second, out);
  };

  text += "\"sfm_data_version\": \"0.3\",\n\"root_path\": ";
  AppendString(scene.root_path, text);
  text += ",\n";
  AppendSection("views", scene.views, append_view, text);
  text += ",\n";
  AppendSection("intrinsics", scene.intrinsics, append_intrinsic, text);
  text += ",\n";
  AppendSection("extrinsics", scene.poses, append_pose, text);
  text += ",\n";
  AppendSection("structure", scene.structure, append_landmark, text);
  text += ",\n";
  AppendSection("control_points", scene.control_points, append_landmark, text);
}

}  // namespace lowlap
