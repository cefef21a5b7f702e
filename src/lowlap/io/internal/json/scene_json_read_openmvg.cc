#include <algorithm>
#include <cmath>

#include "lowlap/io/internal/cereal_pointers.h"
#include "lowlap/io/internal/json/scene_json_sections.h"

namespace lowlap {
namespace {

View ReadView(const JsonValue& key, const CerealPointers::Object& object,
              const JsonValue& pointer) {
  const bool has_priors = object.type_name == "view_priors";
  if (!has_priors && !object.type_name.empty()) {
    pointer.Fail("view type \"" + object.type_name + "\" is not known",
                 ErrorCode::kUnsupported);
  }
  const JsonValue& data = object.data;
  View view;
  view.local_path = data.At("local_path").String();
  view.filename = data.At("filename").String();
  view.width_px = data.At("width").Count();
  view.height_px = data.At("height").Count();
  const JsonValue id_view = data.At("id_view");
  if (id_view.Id() != key.Id()) {
    id_view.Fail("must equal the key " + std::to_string(key.Id()),
                 ErrorCode::kInvalidScene);
  }
  view.intrinsic_id = data.At("id_intrinsic").Id();
  view.pose_id = data.At("id_pose").Id();
  // OpenMVG writes nothing for a prior that is not in use.
  const auto use_prior = data.Find("use_pose_center_prior");
  if (has_priors && use_prior && use_prior->Bool()) {
    view.center_prior = CenterPrior{data.At("center_weight").Vector<3>(),
                                    data.At("center").Vector<3>()};
  }
  return view;
}

Intrinsic ReadIntrinsic(const CerealPointers::Object& object,
                        const JsonValue& pointer) {
  const std::optional<CameraModel> model =
      CameraModelFromName(object.type_name);
  if (!model) {
    pointer.Fail("camera model \"" + object.type_name + "\" is not known",
                 ErrorCode::kUnsupported);
  }
  Intrinsic intrinsic;
  intrinsic.model = *model;
  const JsonValue data = *model == CameraModel::kSpherical
                             ? object.data.At("value0")
                             : object.data;
  intrinsic.width_px = data.At("width").Count();
  intrinsic.height_px = data.At("height").Count();
  if (*model == CameraModel::kSpherical) return intrinsic;

  const JsonValue focal = data.At("focal_length");
  intrinsic.fx_px = intrinsic.fy_px = focal.Real();
  const auto fx = data.Find("fx"), fy = data.Find("fy");
  if (fx || fy) {
    intrinsic.fx_px = data.At("fx").Real();
    intrinsic.fy_px = data.At("fy").Real();
    // Whoever changes one and not the other must not be guessed at.
    constexpr double kRelativeTolerance = 1e-6;
    if (!(std::abs(intrinsic.MeanFocalPx() - focal.Real()) <=
          kRelativeTolerance * std::abs(focal.Real()))) {
      focal.Fail("must be the geometric mean of fx and fy",
                 ErrorCode::kInvalidScene);
    }
  }
  intrinsic.principal_point_px = data.At("principal_point").Vector<2>();
  if (const std::string key = DistortionKey(*model); !key.empty()) {
    const JsonValue coefficients = data.At(key);
    for (const JsonValue coefficient : coefficients.Elements()) {
      intrinsic.distortion.push_back(coefficient.Real());
    }
    const int count = static_cast<int>(intrinsic.distortion.size());
    if (count != DistortionCount(*model)) {
      coefficients.Fail("must have " + std::to_string(DistortionCount(*model)) +
                        " elements, not " + std::to_string(count));
    }
  }
  return intrinsic;
}

Landmark ReadLandmark(const JsonValue& value) {
  Landmark landmark;
  landmark.position = value.At("X").Vector<3>();
  const JsonValue observations = value.At("observations");
  for (const JsonValue entry : observations.Elements()) {
    const JsonValue observation = entry.At("value");
    landmark.observations.push_back({entry.At("key").Id(),
                                     observation.At("id_feat").Id(),
                                     observation.At("x").Vector<2>()});
  }
  // OpenMVG keeps them in a hash map, in any order.
  std::sort(landmark.observations.begin(), landmark.observations.end(),
            [](const PointObservation& a, const PointObservation& b) {
              return a.view < b.view;
            });
  return landmark;
}

template <class Map>
void ReadLandmarks(const JsonValue& list, Map& landmarks) {
  for (const JsonValue entry : list.Elements()) {
    Insert(landmarks, entry.At("key"), ReadLandmark(entry.At("value")));
  }
}

}  // namespace

std::string DistortionKey(CameraModel model) {
  switch (model) {
    case CameraModel::kRadialK1:
      return "disto_k1";
    case CameraModel::kRadialK3:
      return "disto_k3";
    case CameraModel::kBrownT2:
      return "disto_t2";
    case CameraModel::kFisheye:
      return "fisheye";
    case CameraModel::kPinhole:
    case CameraModel::kSpherical:
      break;
  }
  return {};
}

Scene ReadOpenMvgSections(const JsonValue& root) {
  Scene scene;
  const JsonValue version_value = root.At("sfm_data_version");
  const std::string& version = version_value.String();
  if (version != "0.1" && version != "0.2" && version != "0.3") {
    version_value.Fail(
        "version \"" + version + "\" is not one of 0.1, 0.2 and 0.3",
        ErrorCode::kUnsupported);
  }
  scene.root_path = root.At("root_path").String();

  CerealPointers pointers;  // the ids count on from views to intrinsics
  for (const JsonValue entry : root.At("views").Elements()) {
    const JsonValue key = entry.At("key"), value = entry.At("value");
    if (version == "0.3") value.At("polymorphic_id");
    Insert(scene.views, key, ReadView(key, pointers.Resolve(value), value));
  }
  for (const JsonValue entry : root.At("intrinsics").Elements()) {
    const JsonValue value = entry.At("value");
    value.At("polymorphic_id");
    Insert(scene.intrinsics, entry.At("key"),
           ReadIntrinsic(pointers.Resolve(value), value));
  }
  // OpenMVG can write a file without one of the parts.
  if (scene.intrinsics.empty()) {
    for (auto& [id, view] : scene.views) view.intrinsic_id = kInvalidId;
  }
  for (const JsonValue entry : root.At("extrinsics").Elements()) {
    const JsonValue value = entry.At("value");
    Insert(scene.poses, entry.At("key"),
           Pose{value.At("rotation").Matrix<3, 3>(),
                value.At("center").Vector<3>()});
  }
  ReadLandmarks(root.At("structure"), scene.structure);
  if (version != "0.1") {
    ReadLandmarks(root.At("control_points"), scene.control_points);
  }
  return scene;
}

}  // namespace lowlap
