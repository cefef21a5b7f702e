// The other half of model_scene.h: from a scene to a model.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/failure.h"
#include "third_party_adapters/colmap/internal/model_scene.h"
#include "third_party_adapters/internal/image_name.h"
#include "third_party_adapters/internal/landmarks.h"

namespace lowlap::colmap {
namespace {

double Rounded(double value, double unit) {
  return std::nearbyint(value / unit) * unit + 0.0;  // 0 has one sign
}

// A pose is rounded to multiples of 2^-47: of 1 for the quaternion, of the next
// power of two for the translation. Reading and writing moves a quaternion by
// up to 2^-50 and a translation by up to 2^-48.5 of its largest number (a
// million random poses), less than half of that.
constexpr int kPoseBits = 47;

FilePose RoundedPose(const Pose& pose) {
  FilePose file;
  file.rotation = QuaternionFromRotation(pose.rotation);
  file.translation = pose.CamFromWorld().translation;
  int exponent = 0;
  std::frexp(file.translation.cwiseAbs().maxCoeff(), &exponent);
  for (double& value : file.rotation) {
    value = Rounded(value, std::ldexp(1.0, -kPoseBits));
  }
  // Of the two signs, that which makes the first number positive.
  const auto first = std::find_if(file.rotation.begin(), file.rotation.end(),
                                  [](double value) { return value != 0; });
  if (*first < 0) file.rotation *= -1;
  for (double& value : file.translation) {
    value = Rounded(value, std::ldexp(1.0, exponent - kPoseBits));
  }
  return file;
}

// A pose that is the same after reading and rounding it again. The first
// rounding gives it but for one pose in eighty, where normalising the rounded
// quaternion moves a number to the next multiple. One in a million goes back
// and forth between two poses; the number of rounds is odd, so that the next
// export, which starts from the other, ends at the same.
FilePose StablePose(const Pose& pose) {
  FilePose file = RoundedPose(pose);
  for (int n = 0; n < 9; ++n) {
    const Mat3 rotation = RotationFromQuaternion(file.rotation);
    const FilePose again = RoundedPose(
        {rotation, RigidTransform{rotation, file.translation}.Center()});
    if (again.rotation == file.rotation &&
        again.translation == file.translation) {
      break;
    }
    file = again;
  }
  return file;
}

class Exporter {
 public:
  Exporter(const Scene& scene, SceneNotes* notes)
      : scene_(scene), notes_(*notes), shift_(IdShift(scene)) {}

  Model Export() {
    CheckIds();
    AddImages();
    AddPoints();
    return std::move(model_);
  }

 private:
  // The largest id is reserved, and the shift may reach it.
  void CheckIds() const {
    const auto check = [&](const char* what, std::uint32_t largest) {
      if (shift_ > 0 && largest + shift_ >= kInvalidId) {
        throw Failure{Error{ErrorCode::kUnsupported,
                            "its id, counted from one, is reserved",
                            {},
                            what + std::to_string(largest)}};
      }
    };
    if (!scene_.views.empty()) {
      check("view ", scene_.views.rbegin()->first.value());
    }
    if (!scene_.intrinsics.empty()) {
      check("intrinsic ", scene_.intrinsics.rbegin()->first.value());
    }
  }

  void AddImages() {
    std::size_t num_unposed = 0;
    for (const auto& [id, view] : scene_.views) {
      const Pose* pose = scene_.FindPose(id);
      const Intrinsic* intrinsic = scene_.FindIntrinsic(id);
      if (pose == nullptr || intrinsic == nullptr) {
        ++num_unposed;
        continue;
      }
      const std::uint32_t camera_id = view.intrinsic_id.value() + shift_;
      if (cameras_.count(camera_id) == 0) {
        auto camera = FromIntrinsic(*intrinsic, camera_id);
        if (!camera) {
          camera.error().place =
              "intrinsic " + std::to_string(view.intrinsic_id.value());
          throw Failure{std::move(camera.error())};
        }
        cameras_[camera_id] = *ToIntrinsic(*camera);
        model_.cameras.push_back(std::move(*camera));
      }
      Image image;
      image.id = id.value() + shift_;
      image.cam_from_world = StablePose(*pose);
      image.camera_id = camera_id;
      image.name = ImageName(id, view);
      if (const auto features = scene_.features.find(id);
          features != scene_.features.end()) {
        for (const Vec2& pixel : features->second.points_px) {
          image.points.push_back({pixel + PixelShift(*intrinsic), kNoPoint3D});
        }
      }
      image_of_[id] = model_.images.size();
      model_.images.push_back(std::move(image));
    }
    std::sort(model_.cameras.begin(), model_.cameras.end(),
              [](const Camera& a, const Camera& b) { return a.id < b.id; });
    AddNote(num_unposed, "views without a pose or an intrinsic were left out",
            &notes_);
  }

  void AddPoints() {
    const std::uint32_t shift = scene_.structure.count(0) > 0 ? 1 : 0;
    for (const auto& [id, landmark] : SolvedLandmarks(scene_, &notes_)) {
      Point3D point;
      point.id = std::uint64_t{id.value()} + shift;
      point.position = landmark.position;
      double sum_px = 0;
      for (const PointObservation& observation : landmark.observations) {
        Image& image = model_.images[image_of_.at(observation.view)];
        point.track.push_back({image.id, Place(observation, point.id, &image)});
        sum_px += ErrorPx(image, image.points[point.track.back().point_index],
                          landmark.position);
      }
      point.error_px =
          sum_px / static_cast<double>(landmark.observations.size());
      model_.points.push_back(std::move(point));
    }
  }

  // The index of an observation in POINTS2D: of its feature, if the scene has
  // that and no other landmark took it, else at the end.
  std::uint32_t Place(const PointObservation& observation,
                      std::uint64_t point3d, Image* image) const {
    const Point2D point = {
        observation.pixel_px +
            PixelShift(*scene_.FindIntrinsic(observation.view)),
        point3d};
    const auto features = scene_.features.find(observation.view);
    const std::uint32_t index = observation.feature;
    if (features != scene_.features.end() &&
        index < features->second.points_px.size() &&
        image->points[index].point3d == kNoPoint3D) {
      image->points[index] = point;
      return index;
    }
    image->points.push_back(point);
    return static_cast<std::uint32_t>(image->points.size() - 1);
  }

  // By the numbers that are written, as COLMAP computes it.
  double ErrorPx(const Image& image, const Point2D& point,
                 const Vec3& position) const {
    const Intrinsic& intrinsic = cameras_.at(image.camera_id);
    const RigidTransform cam_from_world = {
        RotationFromQuaternion(image.cam_from_world.rotation),
        image.cam_from_world.translation};
    return (intrinsic.Project(cam_from_world * position) +
            PixelShift(intrinsic) - point.pixel_px)
        .norm();
  }

  const Scene& scene_;
  SceneNotes& notes_;
  const std::uint32_t shift_;
  Model model_;
  std::map<ViewId, std::size_t> image_of_;
  std::map<std::uint32_t, Intrinsic> cameras_;  // as written
};

}  // namespace

Status CheckImageName(std::uint32_t image_id, const std::string& name,
                      std::string_view refused, const std::string& file) {
  const std::size_t place = name.find_first_of(refused);
  if (place == std::string::npos) return {};
  const char c = name[place];
  const char* what = c == '\0'                ? "NUL"
                     : c == '\n' || c == '\r' ? "line end"
                                              : "blank";
  return MakeError(ErrorCode::kUnsupported,
                   "the name '" + Escaped(name) + "' has a " + what +
                       ", which this format does not allow",
                   file, "image " + std::to_string(image_id));
}

std::uint32_t IdShift(const Scene& scene) {
  return scene.views.count(0) > 0 || scene.intrinsics.count(0) > 0 ? 1 : 0;
}

Result<Model> ModelFromScene(const Scene& scene, SceneNotes* notes) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  return Caught([&] { return Exporter(scene, notes).Export(); });
}

}  // namespace lowlap::colmap
