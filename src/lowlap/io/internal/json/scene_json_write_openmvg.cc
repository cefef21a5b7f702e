#include <map>

#include "lowlap/io/internal/cereal_pointers.h"
#include "lowlap/io/internal/json/json_text.h"
#include "lowlap/io/internal/json/scene_json_sections.h"

namespace lowlap {
namespace {

// Opens {"key": id, "value": {polymorphic pointer {"data": {  and numbers the
// types and objects as cereal does: from 1, over the whole archive.
class PointerWriter {
 public:
  template <class Key>
  void Open(Key key, const std::string& type_name, std::string& text) {
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
      if (is_new) AppendMember("polymorphic_name", type_name, text);
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
  pointers.Open(id, view.center_prior ? "view_priors" : "", text);
  AppendMember("local_path", view.local_path, text);
  AppendMember("filename", view.filename, text);
  AppendMember("width", view.width_px, text);
  AppendMember("height", view.height_px, text);
  AppendMember("id_view", id, text);
  AppendMember("id_intrinsic", view.intrinsic_id, text);
  AppendMember("id_pose", view.pose_id, text);
  if (view.center_prior) {
    AppendKey("use_pose_center_prior", text);
    text += "true";
    AppendMember("center_weight", view.center_prior->weight, text);
    AppendMember("center", view.center_prior->center_in_world, text);
  }
  PointerWriter::Close(text);
}

void AppendIntrinsic(IntrinsicId id, const Intrinsic& intrinsic,
                     PointerWriter& pointers, std::string& text) {
  const bool is_spherical = intrinsic.model == CameraModel::kSpherical;
  pointers.Open(id, CameraModelName(intrinsic.model), text);
  if (is_spherical) text += "\"value0\": {";
  AppendMember("width", intrinsic.width_px, text);
  AppendMember("height", intrinsic.height_px, text);
  if (is_spherical) {
    text += "}";
  } else {
    const bool is_square = intrinsic.fx_px == intrinsic.fy_px;
    AppendMember("focal_length",
                 is_square ? intrinsic.fx_px : intrinsic.MeanFocalPx(), text);
    if (!is_square) {
      AppendMember("fx", intrinsic.fx_px, text);
      AppendMember("fy", intrinsic.fy_px, text);
    }
    AppendMember("principal_point", intrinsic.principal_point_px, text);
    if (const std::string key = DistortionKey(intrinsic.model); !key.empty()) {
      AppendMember(key, intrinsic.distortion, text);
    }
  }
  PointerWriter::Close(text);
}

void AppendPose(PoseId id, const Pose& pose, std::string& text) {
  text += "{";
  AppendMember("key", id, text);
  AppendKey("value", text);
  text += "{";
  AppendMember("rotation", pose.rotation, text);
  AppendMember("center", pose.center, text);
  text += "}}";
}

template <class LandmarkId>
void AppendLandmark(LandmarkId id, const Landmark& landmark,
                    std::string& text) {
  text += "{";
  AppendMember("key", id, text);
  AppendKey("value", text);
  text += "{";
  AppendMember("X", landmark.position, text);
  AppendKey("observations", text);
  text += "[";
  for (const PointObservation& observation : landmark.observations) {
    AppendComma(text);
    text += "{";
    AppendMember("key", observation.view, text);
    AppendKey("value", text);
    text += "{";
    AppendMember("id_feat", observation.feature, text);
    AppendMember("x", observation.pixel_px, text);
    text += "}}";
  }
  text += "]}}";
}

}  // namespace

void AppendOpenMvgSections(const Scene& scene, std::string& text) {
  PointerWriter pointers;
  const auto append_view = [&](ViewId id, const View& view, std::string& out) {
    AppendView(id, view, pointers, out);
  };
  const auto append_intrinsic = [&](IntrinsicId id, const Intrinsic& intrinsic,
                                    std::string& out) {
    AppendIntrinsic(id, intrinsic, pointers, out);
  };
  text += "\"sfm_data_version\": \"0.3\",\n\"root_path\": ";
  AppendValue(scene.root_path, text);
  AppendSection("views", scene.views, append_view, text);
  AppendSection("intrinsics", scene.intrinsics, append_intrinsic, text);
  AppendSection("extrinsics", scene.poses, AppendPose, text);
  AppendSection("structure", scene.structure, AppendLandmark<PointTrackId>,
                text);
  AppendSection("control_points", scene.control_points,
                AppendLandmark<std::uint32_t>, text);
}

}  // namespace lowlap
