#include "third_party_adapters/bundler/internal/bal.h"

#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "third_party_adapters/bundler/internal/bundle.h"
#include "third_party_adapters/internal/number_text.h"

namespace lowlap::bundler {
namespace {

struct BalObservation {
  std::uint32_t point = 0;
  CenteredObservation observation;
};

BalObservation ReadBalObservation(std::uint32_t num_cameras,
                                  std::uint32_t num_points,
                                  TokenReader* reader) {
  BalObservation result;
  result.observation.camera = reader->Next<std::uint32_t>("a camera index");
  result.point = reader->Next<std::uint32_t>("a point index");
  const Vec2 offset_px = NextVec2("a coordinate of an observation", reader);
  result.observation.offset_px = {offset_px.x(), -offset_px.y()};
  if (!reader->status()) return result;
  if (result.observation.camera >= num_cameras) {
    reader->Fail("there is no camera " +
                 std::to_string(result.observation.camera));
  } else if (result.point >= num_points) {
    reader->Fail("there is no point " + std::to_string(result.point));
  }
  return result;
}

CenteredCamera ReadBalCamera(TokenReader* reader) {
  const Vec3 angle_axis = NextVec3("a number of the rotation", reader);
  const Vec3 translation = NextVec3("a number of the translation", reader);
  const Vec3 f_k1_k2 =
      NextVec3("a focal length or distortion coefficient", reader);
  if (reader->status() && !(f_k1_k2[0] > 0)) {
    reader->Fail("the focal length of a camera is not positive");
  }
  CenteredCamera camera;
  camera.pose = PoseFromBundle(RotationFromAngleAxis(angle_axis), translation);
  camera.camera = {f_k1_k2[0], {f_k1_k2[1], f_k1_k2[2]}};
  return camera;
}

}  // namespace

bool IsBalStart(std::string_view start) {
  TokenReader reader(start, {});
  for (int n = 0; n < 3; ++n) reader.Next<std::uint32_t>("a count");
  if (!reader.AtLineEnd()) return false;
  for (int n = 0; n < 2; ++n) reader.Next<std::uint32_t>("an index");
  NextVec2("a coordinate", &reader);
  return reader.status() && reader.AtLineEnd();
}

Result<CenteredModel> ParseBal(std::string_view text, const std::string& file) {
  TokenReader reader(text, file);
  const auto num_cameras = reader.Next<std::uint32_t>("the number of cameras");
  const auto num_points = reader.Next<std::uint32_t>("the number of points");
  const auto num_observations =
      reader.Next<std::uint64_t>("the number of observations");
  std::vector<BalObservation> observations;
  for (std::uint64_t n = 0; n < num_observations && reader.status(); ++n) {
    observations.push_back(
        ReadBalObservation(num_cameras, num_points, &reader));
  }
  CenteredModel model;
  for (std::uint32_t n = 0; n < num_cameras && reader.status(); ++n) {
    model.cameras.push_back(ReadBalCamera(&reader));
  }
  for (std::uint32_t n = 0; n < num_points && reader.status(); ++n) {
    CenteredPoint point;
    point.position = NextVec3("a coordinate of a point", &reader);
    model.points.push_back(point);
  }
  if (reader.status() && !reader.AtEnd()) {
    reader.Fail("more than the points that the first line announces");
  }
  if (!reader.status()) return reader.error();
  for (const BalObservation& observation : observations) {
    model.points[observation.point].observations.push_back(
        observation.observation);
  }
  return model;
}

std::string FormatBal(const CenteredModel& model) {
  std::string observations;
  std::size_t num_observations = 0;
  for (std::size_t n = 0; n < model.points.size(); ++n) {
    for (const auto& observation : model.points[n].observations) {
      ++num_observations;
      observations += std::to_string(observation.camera) + " " +
                      std::to_string(n) + " " +
                      NumberText(Vec2(observation.offset_px.x(),
                                      -observation.offset_px.y())) +
                      "\n";
    }
  }
  std::string text = std::to_string(model.cameras.size()) + " " +
                     std::to_string(model.points.size()) + " " +
                     std::to_string(num_observations) + "\n" + observations;
  const auto add_lines = [&](const auto& numbers) {
    for (const double number : numbers) text += Format("%.17g\n", number);
  };
  for (const CenteredCamera& camera : model.cameras) {
    const RigidTransform bundle = BundleFromPose(*camera.pose);
    add_lines(AngleAxisFromRotation(bundle.rotation));
    add_lines(bundle.translation);
    add_lines(
        Vec3(camera.camera.focal_px, camera.camera.k[0], camera.camera.k[1]));
  }
  for (const CenteredPoint& point : model.points) add_lines(point.position);
  return text;
}

}  // namespace lowlap::bundler
