#include "python/keywords.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/pipeline/internal/measure/measurement_choices.h"
#include "lowlap/scale/evidence/evidence_registry.h"
#include "python/averager.h"
#include "third_party_adapters/internal/camera_files.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::python {
namespace {

[[noreturn]] void RaiseArgument(const std::string& message) {
  Raise({ErrorCode::kInvalidArgument, message, {}, {}});
}

}  // namespace

Keywords::Keywords(std::string function, const py::kwargs& given)
    : function_(std::move(function)), left_(given.attr("copy")()) {}

py::object Keywords::Take(const std::string& name) {
  known_ += (known_.empty() ? "" : ", ") + name;
  const py::object object =
      left_.attr("pop")(name, py::none()).cast<py::object>();
  return object.is_none() ? py::object() : object;
}

void Keywords::TakeWords(const std::string& name,
                         std::vector<std::string>* words) {
  const py::object object = Take(name);
  if (!object) return;
  if (!py::isinstance<py::str>(object)) {
    try {
      *words = object.cast<std::vector<std::string>>();
    } catch (const py::cast_error&) {
      FailType(name, object);
    }
    return;
  }
  words->clear();
  std::istringstream text(object.cast<std::string>());
  for (std::string word; std::getline(text, word, ',');) {
    words->push_back(word);
  }
}

void Keywords::Finish() const {
  if (left_.empty()) return;
  throw py::type_error(function_ + "() has no option '" +
                       py::str((*left_.begin()).first).cast<std::string>() +
                       "'; it has " + known_);
}

void Keywords::FailType(const std::string& name,
                        const py::object& object) const {
  throw py::type_error(function_ + "(): " + name + " cannot be " +
                       py::repr(object).cast<std::string>());
}

std::unique_ptr<Call> TakeCall(Keywords* keywords) {
  int threads = 0;
  std::uint64_t seed = 0;
  keywords->Take("threads", &threads);
  keywords->Take("seed", &seed);
  if (threads < 0) RaiseArgument("threads must not be negative");
  py::object progress = py::none(), log = py::none();
  keywords->Take("progress", &progress);
  keywords->Take("log", &log);
  return std::make_unique<Call>(progress, log, threads, seed);
}

ScaleOptions TakeScaleOptions(Keywords* keywords) {
  ScaleOptions options;
  keywords->TakeWords("features", &options.features);
  for (const auto& entry : EvidenceRegistry::BuiltIn().entries()) {
    if (entry.flag.empty()) continue;
    std::string name = entry.flag;
    std::replace(name.begin(), name.end(), '-', '_');
    bool asked = true;
    keywords->Take(name, &asked);
    if (!asked) options.without.push_back(entry.name);
  }
  keywords->TakeChoice("criterion",
                       {{"ac", ScaleCriterion::kAContrario},
                        {"ransac", ScaleCriterion::kFixedThreshold}},
                       &options.criterion);
  keywords->TakeChoice(
      "nfa", {{"calibrated", NfaForm::kCalibrated}, {"paper", NfaForm::kPaper}},
      &options.nfa_form);
  keywords->Take("threshold", &options.threshold_px);
  RaiseIfError(options.Validate());
  return options;
}

SolveArguments TakeComparedOptions(Keywords* keywords) {
  SolveArguments arguments;
  SolveOptions& options = arguments.options;
  arguments.scale = TakeScaleOptions(keywords);
  options.scale_estimator = MakeScaleEstimator(arguments.scale);
  std::vector<std::string> features = {"points", "lines", "coplanar"};
  keywords->TakeWords("adjust_features", &features);
  RaiseIfError(SetAdjustedFeatures(features, &options.adjustment));
  std::string ties = "planes";
  keywords->Take("coplanar_ties", &ties);
  options.adjustment.coplanar_ties = ValueOf(ParseCoplanarTies(ties));
  keywords->Take("directions", &options.adjustment.use_directions);
  keywords->Take("principal_point_stddev",
                 &options.adjustment.principal_point_stddev);
  bool no_adjust = false;
  keywords->Take("no_adjust", &no_adjust);
  options.adjust = !no_adjust;
  RaiseIfError(options.Validate());
  return arguments;
}

SolveArguments TakeSolveArguments(Keywords* keywords, Call* call) {
  SolveArguments arguments = TakeComparedOptions(keywords);
  if (const py::object strategy = keywords->Take("strategy")) {
    arguments.options.poses.averager = AveragerOf(strategy, call);
  }
  const py::object parts = keywords->Take("refine_intrinsics");
  if (parts && !parts.is(py::bool_(false))) {
    // Alone, as the flag of the command line.
    arguments.refinement = ValueOf(ParseRefinement(
        parts.is(py::bool_(true)) ? "focal,distortion"
        : py::isinstance<py::str>(parts)
            ? parts.cast<std::string>()
            : py::str(",").attr("join")(parts).cast<std::string>()));
    if (!arguments.options.adjust) {
      RaiseArgument("refine_intrinsics excludes no_adjust");
    }
  }
  arguments.truth = keywords->Take("gt");
  if (const py::object output = keywords->Take("output")) {
    arguments.output = PathOf(output, "output must be a path");
  }
  return arguments;
}

MeasurementOptions TakeMeasurementOptions(Keywords* keywords,
                                          const ScaleOptions& scale) {
  MeasurementOptions options;
  keywords->Take("pairs", &options.pairs);
  MeasurementChoices choices;
  keywords->Take("matcher", &choices.matcher);
  keywords->TakeWords("two_view", &choices.two_view);
  keywords->Take("max_tilt", &choices.max_tilt);
  RaiseIfError(SetChoices(choices, scale, &options));
  keywords->Take("refine_points", &options.refine_points);
  if (const py::object cache = keywords->Take("cache")) {
    options.cache_folder = PathOf(cache, "cache must be a path");
  }
  RaiseIfError(options.Validate());
  return options;
}

IntrinsicSource IntrinsicsOf(const py::object& intrinsics,
                             std::optional<double> focal_px) {
  IntrinsicSource source;
  source.focal_px = focal_px;
  if (focal_px && !(*focal_px > 0)) RaiseArgument("focal must be positive");
  if (intrinsics.is_none()) return source;
  if (focal_px) RaiseArgument("intrinsics excludes focal");
  if (py::isinstance<Scene>(intrinsics)) {
    source.scene = intrinsics.cast<Scene>();
    return source;
  }
  if (py::isinstance<py::str>(intrinsics) ||
      py::hasattr(intrinsics, "__fspath__")) {
    return ValueOf(ReadIntrinsicSource(PathOf(intrinsics, "intrinsics")));
  }
  try {
    source.calibration = intrinsics.cast<Mat3>();
  } catch (const py::cast_error&) {
    throw py::type_error(
        "intrinsics must be a path, a scene or a 3x3 matrix of numbers");
  }
  return source;
}

std::optional<GroundTruth> TruthOf(const py::object& truth,
                                   const Scene& scene) {
  if (!truth || truth.is_none()) return std::nullopt;
  if (py::isinstance<Scene>(truth)) {
    return ValueOf(GroundTruthFromScene(truth.cast<const Scene&>(), scene));
  }
  if (py::isinstance<py::dict>(truth)) {
    try {
      return truth.cast<GroundTruth>();
    } catch (const py::cast_error&) {
      throw py::type_error("true cameras must be a dict of Pose by view id");
    }
  }
  return ValueOf(ReadGroundTruth(
      PathOf(truth, "true cameras must be a path, a scene or a dict"), scene));
}

std::string PathOf(const py::object& object, const char* what) {
  try {
    return object.cast<std::filesystem::path>().string();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(what) + ", not " +
                         Py_TYPE(object.ptr())->tp_name);
  }
}

std::shared_ptr<const Scene> SceneOf(const py::object& scene, Call* call) {
  if (py::isinstance<Scene>(scene)) {
    return scene.cast<std::shared_ptr<Scene>>();
  }
  const std::string path = PathOf(scene, "scene must be a Scene or a path");
  return std::make_shared<Scene>(call->Run([&] {
    SceneNotes notes;
    auto read = ReadScene(path, &notes);
    for (const std::string& note : notes) {
      call->context().Log(LogLevel::kWarning, note);
    }
    return read;
  }));
}

SceneInput TakeSceneInput(Keywords* keywords) {
  SceneInput input;
  const auto take_path = [&](const char* name, std::string* path) {
    if (const py::object object = keywords->Take(name)) {
      *path = PathOf(object, (std::string(name) + " must be a path").c_str());
    }
  };
  take_path("matchdir", &input.matches_dir);
  take_path("match_file", &input.match_file);
  take_path("images", &input.images);
  keywords->TakeWords("exclude", &input.exclude);
  if (!input.match_file.empty() && input.matches_dir.empty()) {
    RaiseArgument("match_file goes with matchdir");
  }
  return input;
}

MeasuredScene MeasuredSceneOf(const py::object& scene, SceneInput input,
                              Call* call, StageLog* stages,
                              const ViewCheck& check,
                              const FirstSolution& first) {
  if (!py::isinstance<Scene>(scene)) {
    input.scene = PathOf(scene, "scene must be a Scene or a path");
    LoadedScene loaded = call->Run([&] {
      return LoadMeasuredScene(input, call->context(), stages, check, first);
    });
    return {std::make_shared<Scene>(std::move(loaded.scene)),
            std::move(loaded.pairs)};
  }
  if (!input.matches_dir.empty() || !input.images.empty() ||
      !input.exclude.empty()) {
    RaiseArgument("matchdir, images and exclude go with a path, not a scene");
  }
  const auto measured = scene.cast<std::shared_ptr<Scene>>();
  if (measured->relative_poses.empty()) {
    Raise({ErrorCode::kInvalidScene,
           "the scene holds no relative poses",
           {},
           {}});
  }
  if (check) RaiseIfError(check(*measured));
  if (measured->given_intrinsics.empty()) return {measured, {}};
  const auto restored = std::make_shared<Scene>(*measured);
  RestoreGivenIntrinsics(restored.get());
  return {restored, {}};
}

}  // namespace lowlap::python
