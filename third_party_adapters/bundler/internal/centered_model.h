#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"
#include "third_party_adapters/bundler/internal/radial_camera.h"

namespace lowlap::bundler {

// What the files of Bundler, VisualSFM and BAL have in common, in our axes:
// cameras and points by their places in lists, and measurements relative to
// the principal point, which the files do not tell.

struct CenteredCamera {
  std::string name;  // of the image; empty if there is none
  /// Absent for a camera without a pose or an intrinsic.
  std::optional<Pose> pose;
  RadialCamera camera;
};

struct CenteredObservation {
  std::size_t camera = 0;
  FeatureIndex feature = kInvalidId;
  Vec2 offset_px = Vec2::Zero();  // from the principal point; y down
};

struct CenteredPoint {
  Vec3 position = Vec3::Zero();
  bool has_color = false;
  std::vector<CenteredObservation> observations;
};

struct CenteredModel {
  RadialForm form = RadialForm::kDistorts;
  std::vector<CenteredCamera> cameras;
  std::vector<CenteredPoint> points;
  /// Focal lengths and principal point of all cameras, where a file has them.
  std::optional<Intrinsic> fixed;
};

/// Ids are places in the lists; each camera is a view with an intrinsic of its
/// own. The principal point is the middle of the image (but where `fixed` says
/// it), and as no file tells its size, it is the smallest that has room for the
/// observations; `notes` says so, and how far off distortions are that our
/// model does not hold. Cameras without a pose are views alone. Errors: those
/// of ValidateScene, kInvalidScene for an observation that no image has room
/// for, and kUnsupported with the camera whose fit is not close (IsCloseFit).
Result<Scene> SceneFromModel(const CenteredModel& model, SceneNotes* notes);

/// Whether a list of cameras has places for those that are not solved.
enum class Unsolved { kKept, kLeftOut };

/// The cameras in the order of their ids and the points with their
/// observations by solved views. Where unsolved views are left out, each image
/// has a name: image and the id of its view, where it has none. Errors:
/// kInvalidScene, and kUnsupported with the intrinsic that cannot be held
/// (RadialFromIntrinsic); `notes` says how well the others are.
Result<CenteredModel> ModelFromScene(const Scene& scene, RadialForm form,
                                     Unsolved unsolved, SceneNotes* notes);

}  // namespace lowlap::bundler
