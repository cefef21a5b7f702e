#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"
#include "third_party_adapters/colmap/internal/model.h"

namespace lowlap::colmap {

/// The scene of a model: a view and a pose for every image, an intrinsic for
/// every camera that one has, POINTS2D as the points of the views, and the 3D
/// points. Ids are those of the model. Of an image in a rig, the pose is that
/// of its frame and sensor; one without a finite pose (as rotation averaging
/// leaves it) becomes a view without pose. `notes` says what is left out.
///
/// Errors: kInvalidScene where the files contradict each other, kUnsupported
/// for a camera that cannot be held exactly (ToIntrinsic), and those of
/// ValidateScene.
Result<Scene> SceneFromModel(const Model& model, SceneNotes* notes);

/// The model of what is solved in a scene: its posed views with their complete
/// points, in their order, so that matches of a database stay valid. Ids are
/// those of the scene, or one more, all of them, where the scene has an id 0:
/// COLMAP starts at 1. Rigs and frames are not made, since older versions do
/// not know them, and newer ones do without.
///
/// The numbers of a pose are rounded to 47 bits; then reading and writing it
/// again gives the same bytes. Errors: kInvalidScene, and those of
/// FromIntrinsic.
Result<Model> ModelFromScene(const Scene& scene, SceneNotes* notes);

/// What a model without them means: every camera is a rig, every image a frame.
void AddTrivialRigs(Model* model);

/// A rotation as COLMAP writes it, w x y z, and back.
Vec4 QuaternionFromRotation(const Mat3& rotation);
Mat3 RotationFromQuaternion(const Vec4& quaternion);

/// The view of an image.
View ViewOfImage(std::uint32_t image_id, std::string name,
                 std::uint32_t camera_id, const Intrinsic& intrinsic);
/// kUnsupported, with the file, for a name with one of the characters
/// `refused`, which would end it there.
Status CheckImageName(std::uint32_t image_id, const std::string& name,
                      std::string_view refused, const std::string& file);
/// What is added to the ids of views and intrinsics in COLMAP: 1 if one is 0.
std::uint32_t IdShift(const Scene& scene);

}  // namespace lowlap::colmap
