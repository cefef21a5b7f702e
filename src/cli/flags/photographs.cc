#include "cli/flags/photographs.h"

#include "cli/command.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/image_collection.h"

namespace lowlap::cli {

Option AddPairsFlag(CLI::App* command, std::string* pairs,
                    const std::string& help) {
  return AddOption(command, "--pairs", *pairs,
                   help +
                       ": all, chain, cycle, window:N, auto (those that look "
                       "alike), or a file with two view names or ids a line")
      .ShowDefault();
}

Option AddMaxTiltFlag(CLI::App* command, double* max_tilt) {
  return AddOption(command, "--max-tilt", *max_tilt,
                   "Pairs with few matches are matched again by what their "
                   "photographs show from aside, compressed by up to this (1 "
                   "to 16; 1: not at all)")
      .Must(Check::Between(1.0, 16.0))
      .ShowDefault();
}

Result<Scene> OpenPhotographs(const PhotographFlags& flags,
                              const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(const auto intrinsics,
                          ReadIntrinsics(flags.intrinsics));
  std::vector<std::string> notes;
  LOWLAP_ASSIGN_OR_RETURN(auto scene, SceneFromImages(flags.images, intrinsics,
                                                      flags.exclude, &notes));
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  return scene;
}

Result<ImageReport> MeasurePhotographs(const PhotographFlags& flags,
                                       const SolveFlags& solve,
                                       const RunContext& context,
                                       StageLog* stages, Scene* scene) {
  LOWLAP_ASSIGN_OR_RETURN(const auto first, MakeFirstSolution(solve));
  LOWLAP_ASSIGN_OR_RETURN(const auto scale, MakeScaleOptions(solve.scale));
  MeasurementOptions measurement;
  LOWLAP_RETURN_IF_ERROR(SetChoices(flags.choices, scale, &measurement));
  measurement.pairs = flags.pairs;
  measurement.refine_points = flags.refine_points;
  measurement.cache_folder = flags.cache;
  if (!flags.intrinsics.AreGiven() && solve.refine_intrinsics.empty()) {
    context.Log(LogLevel::kInfo,
                "focal lengths are those of the EXIF data, a few percent off "
                "as a rule; --refine-intrinsics adjusts them");
  }
  auto report = MeasureAndRefine(scene, measurement, first, context, stages);
  if (report) return report;
  if (IsInterrupted() && !flags.cache.empty()) {
    context.Log(LogLevel::kInfo, "what was measured is kept in " + flags.cache +
                                     "; the same command goes on from there");
  }
  if (report.error().file.empty()) report.error().file = flags.images;
  return report;
}

}  // namespace lowlap::cli
