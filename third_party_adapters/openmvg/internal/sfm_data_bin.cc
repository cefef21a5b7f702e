#include "third_party_adapters/openmvg/internal/sfm_data_bin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/openmvg/internal/archive_reader.h"
#include "third_party_adapters/openmvg/internal/polymorphic.h"

namespace lowlap::openmvg {
namespace {

/// Reads one file; the ids of types and objects run over the whole archive.
class SfmDataReader {
 public:
  SfmDataReader(std::string_view bytes, const std::string& file)
      : in_(bytes, file) {}

  Scene Read() {
    const std::size_t place = in_.offset();
    version_ = in_.String();
    if (version_ != "0.1" && version_ != "0.2" && version_ != "0.3") {
      in_.FailAt(place,
                 "sfm_data version \"" + version_.substr(0, 16) +
                     "\" is unknown (known: 0.1, 0.2, 0.3)",
                 ErrorCode::kUnsupported);
    }
    scene_.root_path = in_.String();
    ReadMap(scene_.views, 44, [this](ViewId id) { return ReadView(id); });
    ReadMap(scene_.intrinsics, 12,
            [this](IntrinsicId) { return ReadIntrinsic(); });
    // OpenMVG can write a file without one of the parts.
    if (scene_.intrinsics.empty()) {
      for (auto& [id, view] : scene_.views) view.intrinsic_id = kInvalidId;
    }
    ReadMap(scene_.poses, 140, [this](PoseId) { return ReadPose(); });
    ReadMap(scene_.structure, 44,
            [this](PointTrackId) { return ReadLandmark(); });
    if (version_ != "0.1") {
      ReadMap(scene_.control_points, 44,
              [this](std::uint32_t) { return ReadLandmark(); });
    }
    return std::move(scene_);
  }

 private:
  template <class Map, class ReadValue>
  void ReadMap(Map& map, std::size_t min_item_bytes,
               const ReadValue& read_value) {
    const std::size_t count = in_.Count(min_item_bytes);
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t place = in_.offset();
      const std::uint32_t id = in_.U32();
      auto value = read_value(id);
      if (!map.emplace(id, std::move(value)).second) {
        in_.FailAt(place, "id " + std::to_string(id) + " is repeated",
                   ErrorCode::kInvalidScene);
      }
    }
  }

  /// Name of a pointer's type; `static_type` where it is the pointer's own.
  std::string ReadTypeName(const std::string& static_type) {
    const std::size_t place = in_.offset();
    const std::uint32_t id = in_.U32();
    if (id == kStaticType) return static_type;
    if (id & kDefines) return type_names_[id & ~kDefines] = in_.String();
    const auto known = type_names_.find(id);
    if (known != type_names_.end()) return known->second;
    in_.FailAt(place, id == 0 ? "a null pointer"
                              : "type " + std::to_string(id) +
                                    " is used before it is named");
  }

  /// True if the object follows, false if it is the one met before as `id`.
  bool ReadObjectId(std::uint32_t& id) {
    id = in_.U32();
    const bool defines = (id & kDefines) != 0;
    id &= ~kDefines;
    return defines;
  }

  View ReadView(ViewId id) {
    View view;
    // Before version 0.3 views were not polymorphic.
    const std::size_t type_place = in_.offset();
    const std::string type = version_ == "0.3" ? ReadTypeName("view") : "view";
    if (type != "view" && type != "view_priors") {
      in_.FailAt(type_place, "view type \"" + type + "\" is unknown",
                 ErrorCode::kUnsupported);
    }
    const std::size_t object_place = in_.offset();
    std::uint32_t object = 0;
    if (!ReadObjectId(object)) {
      in_.FailAt(object_place, "the view has no content of its own");
    }
    view.local_path = in_.String();
    view.filename = in_.String();
    view.width_px = ReadSize();
    view.height_px = ReadSize();
    const std::size_t id_place = in_.offset();
    const ViewId own_id = in_.U32();
    if (own_id != id) {
      in_.FailAt(id_place,
                 "id_view " + std::to_string(own_id.value()) +
                     " differs from the key " + std::to_string(id.value()),
                 ErrorCode::kInvalidScene);
    }
    view.intrinsic_id = in_.U32();
    view.pose_id = in_.U32();
    if (type == "view_priors") {
      const std::size_t flag_place = in_.offset();
      if (in_.Scalar<std::uint8_t>() != 1) {
        // OpenMVG writes nothing at all for a prior that is not used, and then
        // cannot read its own file.
        in_.FailAt(flag_place, "view_priors without a centre prior");
      }
      CenterPrior prior;
      in_.Doubles(prior.weight.data(), 3);
      in_.Doubles(prior.center_in_world.data(), 3);
      view.center_prior = prior;
    }
    return view;
  }

  Intrinsic ReadIntrinsic() {
    const std::size_t type_place = in_.offset();
    const std::string type = ReadTypeName("intrinsic");
    const std::size_t object_place = in_.offset();
    std::uint32_t object = 0;
    if (!ReadObjectId(object)) {
      const auto known = intrinsics_.find(object);
      if (known != intrinsics_.end()) return known->second;
      in_.FailAt(object_place, "object " + std::to_string(object) +
                                   " is used before it is defined");
    }
    const std::optional<CameraModel> model = CameraModelFromName(type);
    if (!model) {
      in_.FailAt(type_place,
                 "camera model \"" + type.substr(0, 40) + "\" is unknown",
                 ErrorCode::kUnsupported);
    }
    Intrinsic intrinsic;
    intrinsic.model = *model;
    intrinsic.width_px = ReadSize();
    intrinsic.height_px = ReadSize();
    if (*model != CameraModel::kSpherical) {
      intrinsic.fx_px = intrinsic.fy_px = ReadDouble();
      in_.Doubles(intrinsic.principal_point_px.data(), 2);
      intrinsic.distortion.resize(
          static_cast<std::size_t>(DistortionCount(*model)));
      if (!intrinsic.distortion.empty()) {
        in_.Doubles(intrinsic.distortion.data(), intrinsic.distortion.size());
      }
    }
    return intrinsics_[object] = intrinsic;
  }

  Pose ReadPose() {
    Pose pose;
    const std::size_t place = in_.offset();
    const std::uint64_t rows = in_.Scalar<std::uint64_t>();
    if (rows != 3) {
      in_.FailAt(place, "a rotation has 3 rows, not " + std::to_string(rows));
    }
    for (int row = 0; row < 3; ++row) {
      Vec3 values = Vec3::Zero();
      in_.Doubles(values.data(), 3);
      pose.rotation.row(row) = values.transpose();
    }
    in_.Doubles(pose.center.data(), 3);
    return pose;
  }

  Landmark ReadLandmark() {
    Landmark landmark;
    in_.Doubles(landmark.position.data(), 3);
    const std::size_t count = in_.Count(32);
    landmark.observations.reserve(count);
    for (std::size_t n = 0; n < count; ++n) {
      PointObservation observation;
      observation.view = in_.U32();
      observation.feature = in_.U32();
      in_.Doubles(observation.pixel_px.data(), 2);
      landmark.observations.push_back(observation);
    }
    std::stable_sort(
        landmark.observations.begin(), landmark.observations.end(),
        [](const auto& a, const auto& b) { return a.view < b.view; });
    return landmark;
  }

  int ReadSize() {
    const std::size_t place = in_.offset();
    const std::uint32_t size = in_.U32();
    if (size > std::numeric_limits<std::int32_t>::max()) {
      in_.FailAt(place, "an image size of " + std::to_string(size));
    }
    return static_cast<int>(size);
  }

  double ReadDouble() {
    const std::size_t place = in_.offset();
    const double value = in_.Scalar<double>();
    if (!std::isfinite(value)) {
      in_.FailAt(place, "the number is not finite");
    }
    return value;
  }

  ArchiveReader in_;
  std::string version_;
  std::map<std::uint32_t, std::string> type_names_;
  std::map<std::uint32_t, Intrinsic> intrinsics_;  // by object id
  Scene scene_;
};

}  // namespace

Result<Scene> ParseSfmDataBin(std::string_view bytes, const std::string& file) {
  return Caught([&] { return SfmDataReader(bytes, file).Read(); });
}

Result<Scene> ReadSfmDataBin(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
  return CaughtScene([&] { return SfmDataReader(bytes, path).Read(); }, path);
}

}  // namespace lowlap::openmvg
