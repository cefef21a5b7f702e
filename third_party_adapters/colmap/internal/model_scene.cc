#include "third_party_adapters/colmap/internal/model_scene.h"

#include <algorithm>
#include <map>
#include <unordered_set>
#include <utility>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/io/internal/failure.h"
#include "third_party_adapters/internal/landmarks.h"

namespace lowlap::colmap {
namespace {

[[noreturn]] void Fail(ErrorCode code, std::string message) {
  throw Failure{Error{code, std::move(message), {}, {}}};
}
[[noreturn]] void FailInvalid(std::string message) {
  Fail(ErrorCode::kInvalidScene, std::move(message));
}

std::string Numbered(const char* what, std::uint64_t id) {
  return std::string(what) + " " + std::to_string(id);
}

RigidTransform TransformOf(const FilePose& pose) {
  return {RotationFromQuaternion(pose.rotation), pose.translation};
}

bool IsPose(const FilePose& pose) {
  return pose.rotation.allFinite() && pose.rotation.norm() > 0 &&
         pose.translation.allFinite();
}

constexpr std::int32_t kCameraSensor = 0;

/// Poses of images by id, as frames and rigs say them.
std::map<std::uint32_t, RigidTransform> FramePoses(const Model& model) {
  std::map<std::uint32_t, const Rig*> rigs;
  for (const Rig& rig : model.rigs) rigs[rig.id] = &rig;
  std::map<std::uint32_t, RigidTransform> poses;
  for (const Frame& frame : model.frames) {
    const auto rig = rigs.find(frame.rig_id);
    if (rig == rigs.end()) {
      FailInvalid(Numbered("frame", frame.id) + " has rig " +
                  std::to_string(frame.rig_id) + ", which is not there");
    }
    if (!IsPose(frame.rig_from_world)) continue;
    for (const FrameData& data : frame.data) {
      if (data.sensor.type != kCameraSensor) continue;
      const auto& sensors = rig->second->sensors;
      const auto sensor = std::find_if(
          sensors.begin(), sensors.end(),
          [&](const RigSensor& s) { return s.sensor == data.sensor; });
      if (sensor == sensors.end()) {
        FailInvalid(Numbered("frame", frame.id) + " has camera " +
                    std::to_string(data.sensor.id) + ", which rig " +
                    std::to_string(frame.rig_id) + " has not");
      }
      RigidTransform cam_from_rig;
      if (sensor != sensors.begin()) {
        if (!sensor->sensor_from_rig || !IsPose(*sensor->sensor_from_rig)) {
          continue;
        }
        cam_from_rig = TransformOf(*sensor->sensor_from_rig);
      }
      poses[static_cast<std::uint32_t>(data.data_id)] =
          cam_from_rig * TransformOf(frame.rig_from_world);
    }
  }
  return poses;
}

void AddImages(const Model& model, Scene* scene, SceneNotes* notes) {
  std::map<std::uint32_t, const Camera*> cameras;
  for (const Camera& camera : model.cameras) {
    if (!cameras.emplace(camera.id, &camera).second) {
      FailInvalid(Numbered("camera", camera.id) + " is listed twice");
    }
  }
  const bool has_frames = !model.frames.empty();
  const auto frame_poses = FramePoses(model);
  std::size_t num_unposed = 0;
  for (const Image& image : model.images) {
    const auto camera = cameras.find(image.camera_id);
    if (camera == cameras.end()) {
      FailInvalid(Numbered("image", image.id) + " has camera " +
                  std::to_string(image.camera_id) + ", which is not there");
    }
    if (scene->intrinsics.count(image.camera_id) == 0) {
      auto intrinsic = ToIntrinsic(*camera->second);
      if (!intrinsic) throw Failure{std::move(intrinsic.error())};
      scene->intrinsics[image.camera_id] = std::move(*intrinsic);
    }
    const Intrinsic& intrinsic = scene->intrinsics.at(image.camera_id);
    if (!scene->views
             .emplace(image.id, ViewOfImage(image.id, image.name,
                                            image.camera_id, intrinsic))
             .second) {
      FailInvalid(Numbered("image", image.id) + " is listed twice");
    }
    std::optional<RigidTransform> pose;
    if (!has_frames) {
      if (IsPose(image.cam_from_world)) {
        pose = TransformOf(image.cam_from_world);
      }
    } else if (const auto found = frame_poses.find(image.id);
               found != frame_poses.end()) {
      pose = found->second;
    }
    if (pose) {
      scene->poses[image.id] = {pose->rotation, pose->Center()};
    } else {
      ++num_unposed;
    }
    if (image.points.empty()) continue;
    auto& points_px = scene->features[image.id].points_px;
    for (const Point2D& point : image.points) {
      points_px.emplace_back(point.pixel_px - PixelShift(intrinsic));
    }
  }
  AddNote(num_unposed, "images have no complete pose and are views without one",
          notes);
  const bool in_rigs =
      std::any_of(model.rigs.begin(), model.rigs.end(),
                  [](const Rig& rig) { return rig.sensors.size() > 1; });
  if (in_rigs) {
    notes->push_back(
        "cameras of a rig are taken one by one: that they are rigid is lost");
  }
}

// A text that was cut between two lines looks whole.
void CheckPointsAreThere(const Model& model) {
  std::unordered_set<std::uint64_t> ids;
  for (const Point3D& point : model.points) ids.insert(point.id);
  for (const Image& image : model.images) {
    for (std::size_t n = 0; n < image.points.size(); ++n) {
      const std::uint64_t id = image.points[n].point3d;
      if (id == kNoPoint3D || ids.count(id) > 0) continue;
      FailInvalid(Numbered("image", image.id) + ": its point " +
                  std::to_string(n) + " belongs to point " +
                  std::to_string(id) + ", which is not there");
    }
  }
}

void AddPoints(const Model& model, Scene* scene, SceneNotes* notes) {
  std::map<ViewId, const Image*> images;
  for (const Image& image : model.images) images[image.id] = &image;
  LandmarkSorter sorter;
  std::size_t num_colored = 0;
  for (const Point3D& point : model.points) {
    if (point.id >= kInvalidId) {
      Fail(ErrorCode::kUnsupported,
           Numbered("point", point.id) + ": ids of more than 32 bits");
    }
    if (point.color != Point3D{}.color) ++num_colored;
    Landmark landmark;
    landmark.position = point.position;
    for (const TrackElement& element : point.track) {
      const auto image = images.find(element.image_id);
      const auto fails = [&](const char* why) {
        FailInvalid(Numbered("point", point.id) + ": its track has point " +
                    std::to_string(element.point_index) + " of image " +
                    std::to_string(element.image_id) + why);
      };
      if (image == images.end() ||
          element.point_index >= image->second->points.size()) {
        fails(", which is not there");
      }
      const std::uint64_t back =
          image->second->points[element.point_index].point3d;
      if (back != kNoPoint3D && back != point.id) {
        fails(", which belongs to another point");
      }
      landmark.observations.push_back({element.image_id, element.point_index,
                                       scene->features.at(element.image_id)
                                           .points_px[element.point_index]});
    }
    if (!sorter.Sort(&landmark)) continue;
    const auto id = static_cast<std::uint32_t>(point.id);
    if (!scene->structure.emplace(id, std::move(landmark)).second) {
      FailInvalid(Numbered("point", point.id) + " is listed twice");
    }
  }
  CheckPointsAreThere(model);
  sorter.Note(notes);
  AddNote(num_colored, "colours of points were left out", notes);
}

}  // namespace

Vec4 QuaternionFromRotation(const Mat3& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  return {q.w(), q.x(), q.y(), q.z()};
}

Mat3 RotationFromQuaternion(const Vec4& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3])
      .normalized()
      .toRotationMatrix();
}

View ViewOfImage(std::uint32_t image_id, std::string name,
                 std::uint32_t camera_id, const Intrinsic& intrinsic) {
  View view;
  view.filename = std::move(name);
  view.width_px = intrinsic.width_px;
  view.height_px = intrinsic.height_px;
  view.intrinsic_id = camera_id;
  view.pose_id = image_id;
  return view;
}

Result<Scene> SceneFromModel(const Model& model, SceneNotes* notes) {
  return CaughtScene(
      [&] {
        Scene scene;
        AddImages(model, &scene, notes);
        AddPoints(model, &scene, notes);
        return scene;
      },
      {});
}

void AddTrivialRigs(Model* model) {
  model->rigs.clear();
  model->frames.clear();
  for (const Camera& camera : model->cameras) {
    model->rigs.push_back({camera.id, {{{kCameraSensor, camera.id}, {}}}});
  }
  for (const Image& image : model->images) {
    model->frames.push_back({image.id,
                             image.camera_id,
                             image.cam_from_world,
                             {{{kCameraSensor, image.camera_id}, image.id}}});
  }
}

}  // namespace lowlap::colmap
