#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/types.h"
#include "third_party_adapters/colmap/internal/camera.h"

namespace lowlap::colmap {

// A model of COLMAP as its files hold it: cameras, images and points3D, and
// since 3.12 rigs and frames, each in a file *.bin or *.txt of one folder.

/// x_to = rotation x_from + translation; the quaternion is w x y z.
struct FilePose {
  Vec4 rotation = Vec4(1, 0, 0, 0);
  Vec3 translation = Vec3::Zero();
};

inline constexpr std::uint64_t kNoPoint3D =
    std::numeric_limits<std::uint64_t>::max();

struct Point2D {
  Vec2 pixel_px = Vec2::Zero();  // of COLMAP
  std::uint64_t point3d = kNoPoint3D;
};

struct Image {
  std::uint32_t id = 0;
  FilePose cam_from_world;
  std::uint32_t camera_id = 0;
  std::string name;
  std::vector<Point2D> points;
};

struct TrackElement {
  std::uint32_t image_id = 0;
  std::uint32_t point_index = 0;
};

struct Point3D {
  std::uint64_t id = 0;
  Vec3 position = Vec3::Zero();
  std::array<std::uint8_t, 3> color = {255, 255, 255};
  double error_px = -1;
  std::vector<TrackElement> track;
};

/// Its type: 0 a camera, 1 an IMU, -1 none.
struct Sensor {
  std::int32_t type = 0;
  std::uint32_t id = 0;

  friend bool operator==(const Sensor& a, const Sensor& b) {
    return a.type == b.type && a.id == b.id;
  }
};

struct RigSensor {
  Sensor sensor;
  std::optional<FilePose> sensor_from_rig;  // absent if unknown
};

struct Rig {
  std::uint32_t id = 0;
  /// The first is the reference: it is the rig's own frame.
  std::vector<RigSensor> sensors;
};

struct FrameData {
  Sensor sensor;
  std::uint64_t data_id = 0;  // of a camera: the image
};

struct Frame {
  std::uint32_t id = 0;
  std::uint32_t rig_id = 0;
  FilePose rig_from_world;
  std::vector<FrameData> data;
};

struct Model {
  std::vector<Camera> cameras;
  std::vector<Image> images;
  std::vector<Point3D> points;
  std::vector<Rig> rigs;
  /// Where there are any, they say the poses, and the images do not.
  std::vector<Frame> frames;
};

enum class ModelForm { kText, kBinary };

/// Parts of a model, in the order in which COLMAP reads them, by the names of
/// their files without extension.
inline constexpr std::array<const char*, 5> kModelParts = {
    "cameras", "rigs", "frames", "images", "points3D"};

/// Adds the part called `name`. Throws a Failure with line or byte.
void ParseText(std::string_view text, const std::string& name, Model* model);
void ParseBinary(std::string_view bytes, const std::string& name, Model* model);

/// The content of a part's file; in text, numbers with the digits that restore
/// them.
std::string FormatText(const Model& model, const std::string& name);
std::string FormatBinary(const Model& model, const std::string& name);

/// The file of a part.
std::string PartPath(const std::string& folder, const std::string& name,
                     ModelForm form);

/// Whether a folder holds cameras, images and points3D in this form.
bool HasModel(const std::string& folder, ModelForm form);

/// The files of this form. Errors with the file: kNotFound, kParse with line or
/// byte, kUnsupported for an unknown camera model.
Result<Model> ReadModel(const std::string& folder, ModelForm form);

}  // namespace lowlap::colmap
