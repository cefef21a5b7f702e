#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scale/scale_options.h"
#include "python/call.h"
#include "third_party_adapters/internal/scene_input.h"

namespace lowlap::python {

/// The keyword arguments of a function, which have the names of the command
/// line's flags. None stands for the default.
class Keywords {
 public:
  Keywords(std::string function, const py::kwargs& given);

  /// Empty if it is not given, or None.
  py::object Take(const std::string& name);
  /// Leaves `value` as it is if it is not given. TypeError for another type.
  template <class T>
  void Take(const std::string& name, T* value) {
    const py::object object = Take(name);
    if (!object) return;
    try {
      *value = object.cast<T>();
    } catch (const py::cast_error&) {
      FailType(name, object);
    }
  }
  /// A list of words, or one text with commas between them.
  void TakeWords(const std::string& name, std::vector<std::string>* words);
  /// One word of several.
  template <class T>
  void TakeChoice(const std::string& name,
                  std::initializer_list<std::pair<const char*, T>> choices,
                  T* value) {
    const py::object given = Take(name);
    if (!given) return;
    if (!py::isinstance<py::str>(given)) FailType(name, given);
    const std::string word = given.cast<std::string>();
    std::string known;
    for (const auto& [choice, meaning] : choices) {
      if (word == choice) {
        *value = meaning;
        return;
      }
      known += (known.empty() ? "" : ", ") + std::string(choice);
    }
    Raise({ErrorCode::kInvalidArgument,
           name + ": '" + word + "' is not one of " + known,
           {},
           {}});
  }
  /// TypeError, with what is known, if one is left.
  void Finish() const;

 private:
  [[noreturn]] void FailType(const std::string& name,
                             const py::object& object) const;

  std::string function_;
  py::dict left_;
  std::string known_;
};

/// threads, seed, progress, log.
std::unique_ptr<Call> TakeCall(Keywords* keywords);

/// features, coplanar_points, criterion, nfa, threshold.
ScaleOptions TakeScaleOptions(Keywords* keywords);

/// What solve() and run() have in common.
struct SolveArguments {
  ScaleOptions scale;
  SolveOptions options;
  IntrinsicRefinement refinement;
  py::object truth;
  std::string output;
};

/// Those of TakeScaleOptions, adjust_features, coplanar_ties, directions,
/// no_adjust and principal_point_stddev.
SolveArguments TakeComparedOptions(Keywords* keywords);
/// The same, strategy, refine_intrinsics, gt and output.
SolveArguments TakeSolveArguments(Keywords* keywords, Call* call);

/// pairs, matcher, two_view, refine_points, cache.
MeasurementOptions TakeMeasurementOptions(Keywords* keywords,
                                          const ScaleOptions& scale);

/// A path, a scene, or a 3x3 matrix; with None, `focal` if there is one.
IntrinsicSource IntrinsicsOf(const py::object& intrinsics,
                             std::optional<double> focal_px);

/// None, a path, a scene, or a dict of Pose by view id.
std::optional<GroundTruth> TruthOf(const py::object& truth, const Scene& scene);

/// The path of an object; TypeError, with `what`, if it is none.
std::string PathOf(const py::object& object, const char* what);

/// A scene, or the path of one. What its reader leaves out is a warning.
std::shared_ptr<const Scene> SceneOf(const py::object& scene, Call* call);

/// matchdir, match_file, images, exclude.
SceneInput TakeSceneInput(Keywords* keywords);

struct MeasuredScene {
  std::shared_ptr<const Scene> scene;
  std::vector<PairReport> pairs;  // if the relative poses were estimated
};

/// A scene with relative poses, or the path of what LoadMeasuredScene reads;
/// `input` goes with a path. `stages` may be null.
MeasuredScene MeasuredSceneOf(const py::object& scene, SceneInput input,
                              Call* call, StageLog* stages = nullptr,
                              const ViewCheck& check = nullptr,
                              const FirstSolution& first = {});

}  // namespace lowlap::python
