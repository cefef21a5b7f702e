#include "third_party_adapters/onedsfm/internal/bundle_file.h"

#include "lowlap/core/internal/token_reader.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap::onedsfm {

Result<std::map<ViewId, Pose>> ParseBundlePoses(std::string_view text,
                                                const std::string& file) {
  TokenReader reader(text, file);
  if (text.substr(0, 1) == "#") reader.RestOfLine();
  const auto num_cameras = reader.Next<std::uint32_t>("the number of cameras");
  reader.Next<std::size_t>("the number of points");
  std::map<ViewId, Pose> poses;
  for (ViewId n = 0; n < num_cameras && reader.status(); ++n) {
    const auto focal = reader.Next<double>("a focal length");
    reader.Next<double>("a distortion coefficient");
    reader.Next<double>("a distortion coefficient");
    Mat3 rotation;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        rotation(r, c) = reader.Next<double>("a number of the rotation");
      }
    }
    Vec3 translation;
    for (int r = 0; r < 3; ++r) {
      translation(r) = reader.Next<double>("a number of the translation");
    }
    if (!reader.status()) break;
    if (focal == 0 && rotation.isZero(0)) continue;
    const Mat3 nearest = NearestRotation(rotation);
    if (!((nearest - rotation).cwiseAbs().maxCoeff() < 1e-3)) {
      reader.Fail("the matrix of camera " + std::to_string(n.value()) +
                  " is no rotation");
      break;
    }
    const Vec3 axes(1, -1, -1);
    poses[n] = {axes.asDiagonal() * nearest,
                -(nearest.transpose() * translation)};
  }
  if (!reader.status()) return reader.error();
  return poses;
}

}  // namespace lowlap::onedsfm
