#include "third_party_adapters/bundler/internal/nvm.h"

#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/bundler/internal/image_list.h"
#include "third_party_adapters/bundler/internal/point_text.h"
#include "third_party_adapters/internal/number_text.h"

namespace lowlap::bundler {
namespace {

constexpr double kNvmYSign = 1;

enum class NvmRotation { kQuaternion, kMatrix };

/// The first line; sets what it says of all cameras.
NvmRotation ReadNvmHeader(TokenReader* reader, CenteredModel* model) {
  const std::string_view word = reader->Word("NVM_V3");
  if (word != "NVM_V3" && word != "NVM_V3_R9T") {
    reader->Fail("the file does not start with NVM_V3 or NVM_V3_R9T");
  }
  if (!reader->AtLineEnd()) {
    if (reader->Word("FixedK") != "FixedK") {
      reader->Fail("FixedK or nothing is expected after NVM_V3");
    }
    Intrinsic& fixed = model->fixed.emplace();
    fixed.fx_px = reader->Next<double>("a focal length");
    fixed.principal_point_px.x() = reader->Next<double>("a principal point");
    fixed.fy_px = reader->Next<double>("a focal length");
    fixed.principal_point_px.y() = reader->Next<double>("a principal point");
    reader->Next<double>("a distortion coefficient");  // the cameras repeat it
    if (reader->status() && !(fixed.fx_px > 0 && fixed.fy_px > 0)) {
      reader->Fail("the focal lengths of FixedK are not positive");
    }
  }
  return word == "NVM_V3" ? NvmRotation::kQuaternion : NvmRotation::kMatrix;
}

CenteredCamera ReadNvmCamera(NvmRotation form, TokenReader* reader) {
  CenteredCamera camera;
  camera.name = std::string(reader->Word("the name of an image"));
  const std::string whose = "image '" + Escaped(camera.name) + "'";
  camera.camera.focal_px = reader->Next<double>("a focal length");
  Pose& pose = camera.pose.emplace();
  if (form == NvmRotation::kQuaternion) {
    Vec4 wxyz;
    for (double& q : wxyz) q = reader->Next<double>("a quaternion");
    pose.rotation = CheckedRotation(wxyz, whose, reader);
    pose.center = NextVec3("a centre", reader);
  } else {
    pose.rotation = NextRotation(whose, reader);
    const Vec3 translation = NextVec3("a translation", reader);
    pose.center = RigidTransform{pose.rotation, translation}.Center();
  }
  camera.camera.k[0] = reader->Next<double>("a distortion coefficient");
  reader->Next<double>("the 0 that ends a camera");
  if (reader->status() && !(camera.camera.focal_px > 0)) {
    reader->Fail("the focal length of " + whose + " is not positive");
  }
  return camera;
}

/// Whether measurements count from the corner of the image.
bool CountsFromCorner(const CenteredModel& model) {
  bool has_any = false;
  for (const CenteredPoint& point : model.points) {
    for (const CenteredObservation& observation : point.observations) {
      has_any = true;
      // Half a pixel: the corner, where the first pixel's centre is 0.
      if (observation.offset_px.minCoeff() < -0.5) return false;
    }
  }
  return has_any;
}

}  // namespace

Result<CenteredModel> ParseNvm(std::string_view text, const std::string& file,
                               SceneNotes* notes) {
  TokenReader reader(text, file);
  CenteredModel model;
  model.form = RadialForm::kUndistorts;
  const NvmRotation form = ReadNvmHeader(&reader, &model);
  const auto num_cameras = reader.Next<std::uint32_t>("the number of cameras");
  for (std::uint32_t n = 0; n < num_cameras && reader.status(); ++n) {
    model.cameras.push_back(ReadNvmCamera(form, &reader));
  }
  const auto num_points = reader.Next<std::uint32_t>("the number of points");
  for (std::uint32_t n = 0; n < num_points && reader.status(); ++n) {
    model.points.push_back(NextPoint(model.cameras.size(), kNvmYSign, &reader));
  }
  // More models may follow, the last without cameras, then anything.
  if (reader.status() && !reader.AtEnd() &&
      reader.Next<std::uint32_t>("the number of cameras of a model") > 0) {
    notes->push_back("further models of the file were left out");
  }
  if (!reader.status()) return reader.error();
  if (!CountsFromCorner(model)) return model;
  if (!model.fixed) {
    return MakeError(ErrorCode::kUnsupported,
                     "measurements count from the corner of the image (none is "
                     "negative), and no FixedK says the principal point",
                     file);
  }
  for (CenteredPoint& point : model.points) {
    for (CenteredObservation& observation : point.observations) {
      observation.offset_px -= model.fixed->principal_point_px;
    }
  }
  return model;
}

Result<std::string> FormatNvm(const CenteredModel& model) {
  std::string text = "NVM_V3\n\n" + std::to_string(model.cameras.size()) + "\n";
  for (const CenteredCamera& camera : model.cameras) {
    LOWLAP_RETURN_IF_ERROR(CheckListedName(camera.name));
    text += camera.name + Format(" %.17g ", camera.camera.focal_px) +
            NumberText(QuaternionOf(camera.pose->rotation)) + " " +
            NumberText(camera.pose->center) +
            Format(" %.17g 0\n", camera.camera.k[0]);
  }
  text += "\n" + std::to_string(model.points.size()) + "\n";
  for (const CenteredPoint& point : model.points) {
    text += PointText(point, kNvmYSign);
  }
  return text + "\n0\n";
}

}  // namespace lowlap::bundler
