#include "lowlap/io/internal/binary_record.h"
#include "third_party_adapters/colmap/internal/model.h"

namespace lowlap::colmap {
namespace {

// Each function serves ByteWriter (with const data) and ByteReader.

template <class Archive, class Matrix>
void TransferMatrix(Archive& archive, Matrix& matrix) {
  BinaryRecord<Archive>(archive).Item(matrix);
}

/// The number of items, then each; `min_bytes` is the least size of an item.
template <class Archive, class Vector, class Transfer>
void TransferVector(Archive& archive, Vector& items, std::size_t min_bytes,
                    const Transfer& transfer) {
  const std::size_t size = archive.Length(items.size(), min_bytes);
  if constexpr (Archive::kReads) items.resize(size);
  for (auto& item : items) transfer(archive, item);
}

template <class Archive, class Integer>
void TransferSigned(Archive& archive, Integer& value) {
  auto bits = static_cast<std::uint32_t>(value);
  archive.Integer(bits);
  if constexpr (Archive::kReads) value = static_cast<std::int32_t>(bits);
}

template <class Archive, class Pose>
void TransferPose(Archive& archive, Pose& pose) {
  TransferMatrix(archive, pose.rotation);
  TransferMatrix(archive, pose.translation);
}

template <class Archive, class OneSensor>
void TransferSensor(Archive& archive, OneSensor& sensor) {
  TransferSigned(archive, sensor.type);
  archive.Integer(sensor.id);
}

template <class Archive, class Text>
void TransferName(Archive& archive, Text& name) {
  if constexpr (Archive::kReads) {
    for (char c; (c = archive.Take(1)[0]) != '\0';) name += c;
  } else {
    for (const char c : name) archive.Integer(static_cast<std::uint8_t>(c));
    archive.Integer(std::uint8_t{0});
  }
}

template <class Archive, class OneCamera>
void TransferCamera(Archive& archive, OneCamera& camera) {
  archive.Integer(camera.id);
  TransferSigned(archive, camera.model);
  archive.Integer(camera.width_px);
  archive.Integer(camera.height_px);
  if constexpr (Archive::kReads) {
    const auto count = ParameterCount(camera.model);
    if (!count) {
      archive.Fail("camera " + std::to_string(camera.id) + " has model " +
                       std::to_string(camera.model) + ", which is not known",
                   ErrorCode::kUnsupported);
    }
    camera.params.resize(*count);
  }
  archive.Reals(camera.params.data(), camera.params.size());
}

template <class Archive, class OneImage>
void TransferImage(Archive& archive, OneImage& image) {
  archive.Integer(image.id);
  TransferPose(archive, image.cam_from_world);
  archive.Integer(image.camera_id);
  TransferName(archive, image.name);
  TransferVector(archive, image.points, 24, [](auto& a, auto& point) {
    TransferMatrix(a, point.pixel_px);
    a.Integer(point.point3d);
  });
}

template <class Archive, class OnePoint>
void TransferPoint(Archive& archive, OnePoint& point) {
  archive.Integer(point.id);
  TransferMatrix(archive, point.position);
  for (auto& channel : point.color) archive.Integer(channel);
  archive.Real(point.error_px);
  TransferVector(archive, point.track, 8, [](auto& a, auto& element) {
    a.Integer(element.image_id);
    a.Integer(element.point_index);
  });
}

template <class Archive, class OneRig>
void TransferRig(Archive& archive, OneRig& rig) {
  archive.Integer(rig.id);
  auto count = static_cast<std::uint32_t>(rig.sensors.size());
  archive.Integer(count);
  if constexpr (Archive::kReads) {
    if (count > archive.BytesLeft() / 8) archive.Fail("the data ends early");
    rig.sensors.resize(count);
  }
  for (std::size_t n = 0; n < rig.sensors.size(); ++n) {
    auto& sensor = rig.sensors[n];
    TransferSensor(archive, sensor.sensor);
    if (n == 0) continue;  // the reference
    BinaryRecord<Archive>(archive).Optional(
        "", sensor.sensor_from_rig,
        [&](auto&, auto& pose) { TransferPose(archive, pose); });
  }
}

template <class Archive, class OneFrame>
void TransferFrame(Archive& archive, OneFrame& frame) {
  archive.Integer(frame.id);
  archive.Integer(frame.rig_id);
  TransferPose(archive, frame.rig_from_world);
  auto count = static_cast<std::uint32_t>(frame.data.size());
  archive.Integer(count);
  if constexpr (Archive::kReads) {
    if (count > archive.BytesLeft() / 16) archive.Fail("the data ends early");
    frame.data.resize(count);
  }
  for (auto& data : frame.data) {
    TransferSensor(archive, data.sensor);
    archive.Integer(data.data_id);
  }
}

template <class Archive, class OneModel>
void TransferPart(Archive& archive, OneModel& model, std::string_view name) {
  if (name == "cameras") {
    TransferVector(archive, model.cameras, 24,
                   [](auto& a, auto& camera) { TransferCamera(a, camera); });
  } else if (name == "images") {
    TransferVector(archive, model.images, 73,
                   [](auto& a, auto& image) { TransferImage(a, image); });
  } else if (name == "points3D") {
    TransferVector(archive, model.points, 51,
                   [](auto& a, auto& point) { TransferPoint(a, point); });
  } else if (name == "rigs") {
    TransferVector(archive, model.rigs, 8,
                   [](auto& a, auto& rig) { TransferRig(a, rig); });
  } else {
    TransferVector(archive, model.frames, 68,
                   [](auto& a, auto& frame) { TransferFrame(a, frame); });
  }
}

}  // namespace

void ParseBinary(std::string_view bytes, const std::string& name,
                 Model* model) {
  ByteReader reader(bytes, {}, 0);
  TransferPart(reader, *model, name);
  if (reader.BytesLeft() > 0) {
    reader.Fail("the data goes on where it should end");
  }
}

std::string FormatBinary(const Model& model, const std::string& name) {
  std::string bytes;
  ByteWriter writer(bytes);
  TransferPart(writer, model, name);
  return bytes;
}

}  // namespace lowlap::colmap
