#include "third_party_adapters/bundler/internal/bundle.h"

#include <utility>

#include "third_party_adapters/bundler/internal/point_text.h"
#include "third_party_adapters/internal/number_text.h"

namespace lowlap::bundler {
namespace {

// Of the camera axes, to ours and back; y and z turn round.
const Vec3 kFlip(1, -1, -1);
constexpr double kBundleYSign = -1;

struct BundleCounts {
  std::uint32_t cameras = 0;
  std::uint32_t points = 0;
};

BundleCounts ReadHeader(std::string_view text, TokenReader* reader) {
  if (text.substr(0, 1) == "#") reader->RestOfLine();
  BundleCounts counts;
  counts.cameras = reader->Next<std::uint32_t>("the number of cameras");
  counts.points = reader->Next<std::uint32_t>("the number of points");
  return counts;
}

CenteredCamera ReadBundleCamera(std::size_t index, TokenReader* reader) {
  CenteredCamera result;
  const Vec3 f_k1_k2 =
      NextVec3("a focal length or distortion coefficient", reader);
  Mat3 rotation;
  for (int row = 0; row < 3; ++row) {
    rotation.row(row) = NextVec3("a number of the rotation", reader);
  }
  const Vec3 translation = NextVec3("a number of the translation", reader);
  if (!reader->status() || (f_k1_k2[0] == 0 && rotation.isZero(0))) {
    return result;
  }
  const std::string name = "camera " + std::to_string(index);
  if (!(f_k1_k2[0] > 0)) {
    reader->Fail("the focal length of " + name + " is not positive");
  }
  result.pose =
      PoseFromBundle(CheckedRotation(rotation, name, reader), translation);
  result.camera = {f_k1_k2[0], {f_k1_k2[1], f_k1_k2[2]}};
  return result;
}

}  // namespace

Pose PoseFromBundle(const Mat3& rotation, const Vec3& translation) {
  return {kFlip.asDiagonal() * rotation,
          RigidTransform{rotation, translation}.Center()};
}

RigidTransform BundleFromPose(const Pose& pose) {
  return RigidTransform::FromRotationAndCenter(
      kFlip.asDiagonal() * pose.rotation, pose.center);
}

Result<CenteredModel> ParseBundle(std::string_view text,
                                  const std::string& file) {
  TokenReader reader(text, file);
  const BundleCounts counts = ReadHeader(text, &reader);
  CenteredModel model;
  for (std::uint32_t n = 0; n < counts.cameras && reader.status(); ++n) {
    model.cameras.push_back(ReadBundleCamera(n, &reader));
  }
  for (std::uint32_t n = 0; n < counts.points && reader.status(); ++n) {
    model.points.push_back(
        NextPoint(model.cameras.size(), kBundleYSign, &reader));
  }
  if (reader.status() && !reader.AtEnd()) {
    reader.Fail("more than the points that the file announces");
  }
  if (!reader.status()) return reader.error();
  return model;
}

Result<std::map<ViewId, Pose>> ParseBundlePoses(std::string_view text,
                                                const std::string& file) {
  TokenReader reader(text, file);
  const BundleCounts counts = ReadHeader(text, &reader);
  std::map<ViewId, Pose> poses;
  for (std::uint32_t n = 0; n < counts.cameras && reader.status(); ++n) {
    const CenteredCamera camera = ReadBundleCamera(n, &reader);
    if (camera.pose) poses[n] = *camera.pose;
  }
  if (!reader.status()) return reader.error();
  return poses;
}

std::string FormatBundle(const CenteredModel& model) {
  std::string text = "# Bundle file v0.3\n" +
                     std::to_string(model.cameras.size()) + " " +
                     std::to_string(model.points.size()) + "\n";
  for (const CenteredCamera& camera : model.cameras) {
    if (!camera.pose) {
      for (int row = 0; row < 5; ++row) text += "0 0 0\n";
      continue;
    }
    const RigidTransform bundle = BundleFromPose(*camera.pose);
    text += NumberText(Vec3(camera.camera.focal_px, camera.camera.k[0],
                            camera.camera.k[1])) +
            "\n" + RowsText(bundle.rotation) + NumberText(bundle.translation) +
            "\n";
  }
  for (const CenteredPoint& point : model.points) {
    text += PointText(point, kBundleYSign);
  }
  return text;
}

}  // namespace lowlap::bundler
