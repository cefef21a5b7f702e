#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/averaging/reliability/internal/pose_warnings.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/measure_and_refine.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/pipeline/solve_scene.h"
#include "python/solution.h"

namespace lowlap::python {
namespace {

Solution Solve(const py::object& scene_or_path, const py::kwargs& kwargs) {
  Keywords keywords("solve", kwargs);
  const auto call = TakeCall(&keywords);
  const SolveArguments arguments = TakeSolveArguments(&keywords, call.get());
  const SceneInput input = TakeSceneInput(&keywords);
  keywords.Finish();
  CheckOutput(arguments.output);
  StageLog stages;
  Solution solution =
      LoadToSolve(scene_or_path, input, arguments, call.get(), &stages);
  solution.summary.command = "solve";
  SolveInPlace(arguments, call.get(), &stages, &solution);
  return solution;
}

Solution Run(const py::object& images, const py::object& intrinsics,
             const py::kwargs& kwargs) {
  Keywords keywords("run", kwargs);
  const auto call = TakeCall(&keywords);
  const SolveArguments arguments = TakeSolveArguments(&keywords, call.get());
  Photographs photographs;
  photographs.measurement = TakeMeasurementOptions(&keywords, arguments.scale);
  std::optional<double> focal_px;
  keywords.Take("focal", &focal_px);
  keywords.TakeWords("exclude", &photographs.exclude);
  keywords.Finish();
  CheckOutput(arguments.output);
  photographs.folder = PathOf(images, "images must be a path");
  photographs.intrinsics = IntrinsicsOf(intrinsics, focal_px);
  StageLog stages;
  Solution solution =
      MeasurePhotographs(photographs, arguments, call.get(), &stages);
  solution.summary.command = "run";
  SolveInPlace(arguments, call.get(), &stages, &solution);
  return solution;
}

std::vector<std::string> CalibrationNotes(const Solution& solution) {
  std::vector<std::string> notes = DescribeIntrinsicChanges(*solution.scene);
  if (const auto& adjustment = solution.summary.solve->adjustment) {
    for (std::string& line : DescribeCalibrationPreferences(*adjustment)) {
      notes.push_back(std::move(line));
    }
  }
  return notes;
}

void BindSummaries(py::module_& module) {
  py::class_<StageCost>(module, "StageCost", "What a stage took.")
      .def_readonly("name", &StageCost::name)
      .def_readonly("wall_s", &StageCost::wall_s)
      .def_readonly("cpu_s", &StageCost::cpu_s);

  py::class_<PairReport>(module, "PairReport", "What became of a pair.")
      .def_readonly("views", &PairReport::views)
      .def_readonly("accepted", &PairReport::accepted)
      .def_readonly("no_parallax", &PairReport::no_parallax)
      .def_readonly("reason", &PairReport::reason)
      .def_readonly("num_point_matches", &PairReport::num_point_matches)
      .def_readonly("num_line_matches", &PairReport::num_line_matches)
      .def_readonly("num_point_inliers", &PairReport::num_point_inliers)
      .def_readonly("num_line_inliers", &PairReport::num_line_inliers)
      .def_readonly("log10_nfa", &PairReport::log10_nfa);

  py::class_<UnrelatedView>(module, "UnrelatedView",
                            "A view without any relative pose, and why.")
      .def_readonly("view", &UnrelatedView::view)
      .def_readonly("no_parallax", &UnrelatedView::no_parallax)
      .def_readonly("reason", &UnrelatedView::reason);

  py::class_<OutlierEdge>(module, "OutlierEdge",
                          "A relative pose that was left out, and why.")
      .def_readonly("views", &OutlierEdge::views)
      .def_property_readonly("reason",
                             [](const OutlierEdge& edge) {
                               return OutlierReasonName(edge.reason);
                             })
      .def_readonly("error_deg", &OutlierEdge::error_deg);

  py::class_<ReliabilityWarning>(module, "ReliabilityWarning",
                                 "Views whose place is doubtful, and why.")
      .def_property_readonly("reason",
                             [](const ReliabilityWarning& warning) {
                               return WarningReasonName(warning.reason);
                             })
      .def_readonly("views", &ReliabilityWarning::views)
      .def_readonly("against", &ReliabilityWarning::against)
      .def_readonly("untold", &ReliabilityWarning::untold)
      .def_readonly("missing", &ReliabilityWarning::missing)
      .def_readonly("ratios", &ReliabilityWarning::ratios)
      .def_readonly("share", &ReliabilityWarning::share);

  py::class_<Contest>(
      module, "Contest",
      "Views that relative poses join to the others with hardly "
      "more evidence than what contradicts these.")
      .def_readonly("links", &Contest::links)
      .def_readonly("contradictions", &Contest::contradictions)
      .def_readonly("views", &Contest::views);

  py::class_<ReplacedDirection>(module, "ReplacedDirection",
                                "A relative pose whose own matches bear out "
                                "another direction, which took its place.")
      .def_readonly("views", &ReplacedDirection::views)
      .def_readonly("error_deg", &ReplacedDirection::error_deg);

  py::class_<ReconsideredPose>(
      module, "ReconsideredPose",
      "A relative pose of few matches that got another motion, which the rest "
      "of the scene and its own matches bear out together.")
      .def_readonly("views", &ReconsideredPose::views)
      .def_readonly("rotation_deg", &ReconsideredPose::rotation_deg)
      .def_readonly("gained_digits", &ReconsideredPose::gained_digits);

  py::class_<KindAdjustment>(module, "KindAdjustment",
                             "One kind of residual in the bundle adjustment.")
      .def_readonly("landmarks", &KindAdjustment::landmarks)
      .def_readonly("observations_used", &KindAdjustment::observations_used)
      .def_readonly("observations_dropped",
                    &KindAdjustment::observations_dropped)
      .def_readonly("observations_surplus",
                    &KindAdjustment::observations_surplus)
      .def_readonly("initial_rmse_px", &KindAdjustment::initial_rmse_px)
      .def_readonly("final_rmse_px", &KindAdjustment::final_rmse_px)
      .def_readonly("stddev_px", &KindAdjustment::stddev_px)
      .def_readonly("threshold_px", &KindAdjustment::threshold_px);

  py::class_<RivalOptimum>(module, "RivalOptimum",
                           "Another end of the adjustment, as good.")
      .def_readonly("start", &RivalOptimum::start)
      .def_readonly("distances", &RivalOptimum::distances);

  py::class_<AdjustmentSummary>(module, "AdjustmentSummary",
                                "What the bundle adjustment did.")
      .def_readonly("initial_cost", &AdjustmentSummary::initial_cost)
      .def_readonly("final_cost", &AdjustmentSummary::final_cost)
      .def_readonly("points", &AdjustmentSummary::points)
      .def_readonly("lines", &AdjustmentSummary::lines)
      .def_readonly("coplanar", &AdjustmentSummary::coplanar)
      .def_readonly("planes", &AdjustmentSummary::planes)
      .def_readonly("landmarks_on_planes",
                    &AdjustmentSummary::landmarks_on_planes)
      .def_readonly("directions", &AdjustmentSummary::directions)
      .def_readonly("rivals", &AdjustmentSummary::rivals)
      .def_readonly("iterations", &AdjustmentSummary::iterations)
      .def_readonly("outlier_rounds", &AdjustmentSummary::outlier_rounds)
      .def_readonly("converged", &AdjustmentSummary::converged);
}

constexpr char kSolveDoc[] =
    "From measurements to a calibrated scene: scale ratios, rotations, poses,\n"
    "structure, bundle adjustment. The scene that is given stays as it is.\n\n"
    "Options, all by keyword, as the flags of `lowlap solve`:\n"
    "  features, coplanar_points, criterion, nfa, threshold: the scale "
    "ratios;\n"
    "  strategy: NAME[:key=value,...] or a TranslationAverager;\n"
    "  adjust_features, coplanar_ties, directions, no_adjust,\n"
    "  refine_intrinsics (True, or parts), principal_point_stddev: the bundle\n"
    "  adjustment;\n"
    "  gt: true cameras to evaluate against, never used for solving;\n"
    "  output: a folder for what the command writes;\n"
    "  matchdir, match_file, images, exclude: what goes with a path, as of\n"
    "  measure();\n"
    "  threads, seed;\n"
    "  progress(stage, done, total): return False to stop;\n"
    "  log(level, message): without it, warnings are Python's.";

constexpr char kRunDoc[] =
    "From a folder of photographs to a calibrated scene.\n\n"
    "intrinsics: the path of K.txt or of a scene file, a scene, or the 3x3\n"
    "calibration matrix; without it and `focal`: from EXIF data.\n"
    "Options, all by keyword, as the flags of `lowlap run`: those of solve(),\n"
    "and focal, pairs, matcher, exclude, two_view, max_tilt, refine_points,\n"
    "cache (a folder of features and matches to use again; none if not given).";

}  // namespace

void CheckOutput(const std::string& output) {
  if (!output.empty()) RaiseIfError(CheckOutputFolder(output));
}

Solution LoadToSolve(const py::object& scene, const SceneInput& input,
                     const SolveArguments& arguments, Call* call,
                     StageLog* stages, const ViewCheck& check) {
  MeasuredScene measured =
      MeasuredSceneOf(scene, input, call, stages, check,
                      {arguments.options, arguments.refinement});
  Solution solution;
  solution.scene = std::make_shared<Scene>(*measured.scene);
  solution.summary.pairs = std::move(measured.pairs);
  return solution;
}

Solution MeasurePhotographs(const Photographs& photographs,
                            const SolveArguments& arguments, Call* call,
                            StageLog* stages, const ViewCheck& check) {
  const RunContext& context = call->context();
  std::vector<std::string> notes;
  Solution solution;
  solution.scene = std::make_shared<Scene>(call->Run([&] {
    return SceneFromImages(photographs.folder, photographs.intrinsics,
                           photographs.exclude, &notes);
  }));
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  TruthOf(arguments.truth, *solution.scene);
  if (check) RaiseIfError(check(*solution.scene));
  ImageReport report = call->Run([&] {
    auto measured = MeasureAndRefine(
        solution.scene.get(), photographs.measurement,
        {arguments.options, arguments.refinement}, context, stages);
    if (!measured && measured.error().file.empty()) {
      measured.error().file = photographs.folder;
    }
    return measured;
  });
  solution.summary.pairs = std::move(report.pairs);
  solution.summary.unrelated = std::move(report.unrelated);
  solution.summary.detected = std::move(report.detected);
  return solution;
}

void SolveInPlace(const SolveArguments& arguments, Call* call, StageLog* stages,
                  Solution* solution, const Solver& solver) {
  Scene* scene = solution->scene.get();
  RunSummary& summary = solution->summary;
  const auto truth = TruthOf(arguments.truth, *scene);
  SolveOptions options = arguments.options;
  RefineAllIntrinsics(arguments.refinement, scene, &options.adjustment);
  summary.solve = call->Run(
      [&] { return solver(scene, options, call->context(), stages); });
  if (truth) {
    if (summary.solve->adjustment) {
      summary.evaluation_before_adjustment = EvaluatePoses(
          scene->views, summary.solve->poses_before_adjustment, *truth);
    }
    summary.evaluation = EvaluatePoses(*scene, *truth);
    summary.truth = *truth;
  }
  summary.kinds = options.scale_estimator->kinds();
  summary.stages = stages->stages();
  if (arguments.output.empty()) return;
  call->Run([&] {
    return WriteOutputs(*scene, summary, call->context(), arguments.output);
  });
}

void BindSolve(py::module_& module) {
  BindSummaries(module);
  // The summary of the averaging, from a solution.
  const auto poses = [](auto member) {
    return [member](const Solution& s) { return s.poses().*member; };
  };
  py::class_<Solution>(module, "Solution",
                       "What solve(), run() and merge() return.")
      .def_readonly("scene", &Solution::scene)
      .def_property_readonly("num_views", poses(&PoseSummary::num_views))
      .def_property_readonly("num_placed", poses(&PoseSummary::num_placed))
      .def_property_readonly("unplaced", poses(&PoseSummary::unplaced))
      .def_property_readonly("components", poses(&PoseSummary::components),
                             "Views by common scale; the first have poses.")
      .def_property_readonly("outlier_edges",
                             poses(&PoseSummary::outlier_edges))
      .def_property_readonly("kept_outliers",
                             poses(&PoseSummary::kept_outliers),
                             "In use though they contradict the poses: without "
                             "them views would be lost.")
      .def_property_readonly("left_out_ratios",
                             poses(&PoseSummary::left_out_ratios),
                             "Without them the directions agree.")
      .def_property_readonly(
          "replaced_directions",
          [](const Solution& s) { return s.poses().matches.replaced; })
      .def_property_readonly(
          "reconsidered_poses",
          [](const Solution& s) { return s.summary.solve->reconsidered; })
      .def_property_readonly(
          "untold_edges",
          [](const Solution& s) { return s.poses().matches.untold; },
          "Relative poses with too few matches to say whether they are right.")
      .def_property_readonly("contests", poses(&PoseSummary::contests))
      .def_property_readonly("weak_ratios", poses(&PoseSummary::weak_ratios))
      .def_property_readonly("reliability_warnings",
                             poses(&PoseSummary::reliability_warnings))
      .def_property_readonly(
          "is_firm", [](const Solution& s) { return s.poses().IsFirm(); },
          "All views are placed, and nothing contradicts any of them.")
      .def_property_readonly(
          "warnings",
          [](const Solution& s) { return PoseWarnings(s.poses(), *s.scene); },
          "What to know before relying on the poses, a sentence each.")
      .def_property_readonly(
          "notes", [](const Solution& s) { return s.summary.notes; },
          "Of merge(): what the measurements say about the models.")
      .def_property_readonly(
          "calibration_notes", &CalibrationNotes,
          "What became of the intrinsics, and which the images prefer.")
      .def_property_readonly(
          "adjustment",
          [](const Solution& s) { return s.summary.solve->adjustment; })
      .def_property_readonly("poses_before_adjustment",
                             [](const Solution& s) {
                               return s.summary.solve->poses_before_adjustment;
                             })
      .def_property_readonly(
          "evaluation", [](const Solution& s) { return s.summary.evaluation; },
          "Errors against `gt`, or None.")
      .def_property_readonly("evaluation_before_adjustment",
                             [](const Solution& s) {
                               return s.summary.evaluation_before_adjustment;
                             })
      .def_property_readonly(
          "pairs", [](const Solution& s) { return s.summary.pairs; },
          "Of run(): what became of every pair.")
      .def_property_readonly(
          "unrelated_views",
          [](const Solution& s) { return s.summary.unrelated; })
      .def_property_readonly("costs",
                             [](const Solution& s) { return s.summary.stages; })
      .def(
          "write",
          [](const Solution& s, const std::filesystem::path& folder) {
            const Status written =
                WriteOutputs(*s.scene, s.summary, {}, folder.string());
            RaiseIfError(written);
          },
          py::arg("folder"),
          "What the command leaves: report.html, sfm_data.json, scene.lowlap,\n"
          "cloud.ply, summary.json.")
      .def("__repr__", [](const Solution& s) {
        return "<lowlap.Solution: " + std::to_string(s.poses().num_placed) +
               " of " + std::to_string(s.poses().num_views) + " views placed>";
      });
  module.def("solve", &Solve, py::arg("scene"), kSolveDoc);
  module.def("run", &Run, py::arg("images"), py::arg("intrinsics") = py::none(),
             kRunDoc);
}

}  // namespace lowlap::python
