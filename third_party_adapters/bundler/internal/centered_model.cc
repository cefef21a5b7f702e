#include "third_party_adapters/bundler/internal/centered_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/internal/image_name.h"
#include "third_party_adapters/internal/landmarks.h"

namespace lowlap::bundler {
namespace {

// Larger images are mistakes.
constexpr double kMaxHalfSizePx = 1e6;

/// Size and principal point of an image whose observations lie up to
/// `reach_px` off the principal point.
void SetFrame(const std::optional<Intrinsic>& fixed, const Vec2& reach_px,
              Intrinsic* intrinsic) {
  Vec2 half = reach_px;
  if (fixed) half = half.cwiseMax(fixed->principal_point_px);
  // With nothing to go by, a usual angle of view.
  if (half.isZero(0)) half.setConstant(0.5 * intrinsic->fx_px);
  half = half.array().ceil().min(kMaxHalfSizePx);
  intrinsic->width_px = 2 * static_cast<int>(half.x()) + 1;
  intrinsic->height_px = 2 * static_cast<int>(half.y()) + 1;
  intrinsic->principal_point_px = fixed ? fixed->principal_point_px : half;
}

/// How far off the principal point a camera observes.
struct Reach {
  Vec2 per_axis_px = Vec2::Zero();
  double radius_px = 0;
};

Result<std::vector<Reach>> ReachOfCameras(const CenteredModel& model) {
  std::vector<Reach> reaches(model.cameras.size());
  for (const CenteredPoint& point : model.points) {
    for (const CenteredObservation& observation : point.observations) {
      const Vec2 offset_px = observation.offset_px.cwiseAbs();
      if (!(offset_px.maxCoeff() <= kMaxHalfSizePx)) {
        return MakeError(
            ErrorCode::kInvalidScene,
            "camera " + std::to_string(observation.camera) +
                Format(" observes a point at %g, %g px, where no "
                       "image is",
                       observation.offset_px.x(), observation.offset_px.y()));
      }
      Reach& reach = reaches[observation.camera];
      reach.per_axis_px = reach.per_axis_px.cwiseMax(offset_px);
      reach.radius_px = std::max(reach.radius_px, offset_px.norm());
    }
  }
  return reaches;
}

/// Counts the fits of cameras that are further off than is worth a word.
class FitCounter {
 public:
  explicit FitCounter(double min_error_px) : min_error_px_(min_error_px) {}

  void Add(double error_px) {
    if (error_px > min_error_px_) ++count_;
    worst_px_ = std::max(worst_px_, error_px);
  }
  void Note(const std::string& what, SceneNotes* notes) const {
    AddNote(count_, what + Format(", to %.2g px", worst_px_), notes);
  }

 private:
  double min_error_px_;
  std::size_t count_ = 0;
  double worst_px_ = 0;
};

/// The intrinsic of a camera with a pose.
Result<Intrinsic> IntrinsicOfCamera(const CenteredModel& model, std::size_t n,
                                    const Reach& reach, FitCounter* fits) {
  RadialCamera camera = model.cameras[n].camera;
  if (model.fixed) {
    camera.focal_px = std::min(model.fixed->fx_px, model.fixed->fy_px);
  }
  IntrinsicFit fit = IntrinsicFromRadial(camera, model.form,
                                         reach.radius_px / camera.focal_px);
  Intrinsic& intrinsic = fit.intrinsic;
  if (model.fixed) {
    intrinsic.fx_px = model.fixed->fx_px;
    intrinsic.fy_px = model.fixed->fy_px;
  }
  SetFrame(model.fixed, reach.per_axis_px, &intrinsic);
  if (!IsCloseFit(fit.error_px, intrinsic)) {
    return MakeError(
        ErrorCode::kUnsupported,
        Format("the inverse of its distortion (%g) cannot be approximated well "
               "by k1, k2, k3 as far out as it observes points, %.2g focal "
               "lengths",
               camera.k[0], reach.radius_px / camera.focal_px),
        {},
        "camera " + std::to_string(n) + ", image '" +
            Escaped(model.cameras[n].name) + "'");
  }
  fits->Add(fit.error_px);
  return intrinsic;
}

void AddModelPoints(const CenteredModel& model, Scene* scene,
                    SceneNotes* notes) {
  LandmarkSorter sorter;
  std::size_t num_colored = 0, num_unsolved = 0;
  for (std::size_t n = 0; n < model.points.size(); ++n) {
    const CenteredPoint& point = model.points[n];
    if (point.has_color) ++num_colored;
    Landmark landmark;
    landmark.position = point.position;
    for (const CenteredObservation& observation : point.observations) {
      const auto view = static_cast<std::uint32_t>(observation.camera);
      const Intrinsic* intrinsic = scene->FindIntrinsic(view);
      if (intrinsic == nullptr) {
        ++num_unsolved;
        continue;
      }
      landmark.observations.push_back(
          {view, observation.feature,
           intrinsic->principal_point_px + observation.offset_px});
    }
    if (sorter.Sort(&landmark)) {
      scene->structure[static_cast<std::uint32_t>(n)] = std::move(landmark);
    }
  }
  AddNote(num_unsolved, "observations by cameras without a pose were left out",
          notes);
  sorter.Note(notes);
  AddNote(num_colored, "colours of points were left out", notes);
}

/// RadialFromIntrinsic of every intrinsic that solved views have.
Result<std::map<IntrinsicId, RadialCamera>> RadialCameras(const Scene& scene,
                                                          RadialForm form,
                                                          SceneNotes* notes) {
  std::map<IntrinsicId, RadialCamera> cameras;
  FitCounter fits(0);
  for (const auto& [id, view] : scene.views) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(id);
    if (intrinsic == nullptr || cameras.count(view.intrinsic_id) > 0) continue;
    auto fit = RadialFromIntrinsic(*intrinsic, form);
    if (!fit) {
      fit.error().place =
          "intrinsic " + std::to_string(view.intrinsic_id.value());
      return tl::unexpected<Error>(std::move(fit.error()));
    }
    cameras[view.intrinsic_id] = fit->camera;
    fits.Add(fit->error_px);
  }
  fits.Note(
      "intrinsics were approximated by one focal length and radial distortion",
      notes);
  return cameras;
}

}  // namespace

Result<Scene> SceneFromModel(const CenteredModel& model, SceneNotes* notes) {
  LOWLAP_ASSIGN_OR_RETURN(const auto reaches, ReachOfCameras(model));
  // Less is nothing beside the error of a measurement.
  constexpr double kMinErrorPx = 0.01;
  FitCounter fits(kMinErrorPx);
  Scene scene;
  for (std::size_t n = 0; n < model.cameras.size(); ++n) {
    const CenteredCamera& camera = model.cameras[n];
    const auto id = static_cast<std::uint32_t>(n);
    View& view = scene.views[id];
    view.filename = camera.name;
    view.pose_id = id;
    if (!camera.pose) continue;
    LOWLAP_ASSIGN_OR_RETURN(const Intrinsic intrinsic,
                            IntrinsicOfCamera(model, n, reaches[n], &fits));
    scene.intrinsics[id] = intrinsic;
    view.width_px = intrinsic.width_px;
    view.height_px = intrinsic.height_px;
    view.intrinsic_id = id;
    scene.poses[id] = *camera.pose;
  }
  fits.Note("distortions were approximated by k1, k2, k3", notes);
  AddModelPoints(model, &scene, notes);
  AddNote(scene.intrinsics.size(),
          "image sizes are not in the file; they are taken as small as the "
          "observations allow",
          notes);
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  return scene;
}

Result<CenteredModel> ModelFromScene(const Scene& scene, RadialForm form,
                                     Unsolved unsolved, SceneNotes* notes) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  LOWLAP_ASSIGN_OR_RETURN(const auto radial_cameras,
                          RadialCameras(scene, form, notes));
  CenteredModel model;
  model.form = form;
  std::map<ViewId, std::size_t> place_of_view;
  std::size_t num_unsolved = 0;
  for (const auto& [id, view] : scene.views) {
    const Pose* pose = scene.FindPose(id);
    CenteredCamera camera;
    // Where views are left out, places in the list do not tell ids.
    camera.name = unsolved == Unsolved::kLeftOut ? ImageName(id, view)
                                                 : view.PathBelowRoot();
    if (pose != nullptr && scene.FindIntrinsic(id) != nullptr) {
      camera.pose = *pose;
      camera.camera = radial_cameras.at(view.intrinsic_id);
    } else {
      ++num_unsolved;
      if (unsolved == Unsolved::kLeftOut) continue;
    }
    place_of_view[id] = model.cameras.size();
    model.cameras.push_back(std::move(camera));
  }
  AddNote(num_unsolved,
          unsolved == Unsolved::kLeftOut
              ? "views without a pose or an intrinsic were left out"
              : "views without a pose or an intrinsic are empty cameras",
          notes);
  for (const auto& [id, landmark] : SolvedLandmarks(scene, notes)) {
    CenteredPoint point;
    point.position = landmark.position;
    for (const PointObservation& observation : landmark.observations) {
      point.observations.push_back(
          {place_of_view.at(observation.view), observation.feature,
           observation.pixel_px -
               scene.FindIntrinsic(observation.view)->principal_point_px});
    }
    model.points.push_back(std::move(point));
  }
  return model;
}

}  // namespace lowlap::bundler
