#include "cli/flags/adjust_flags.h"

#include "lowlap/core/internal/propagate.h"

namespace lowlap::cli {

std::vector<std::string> OptionsOfAdjustment() {
  return {"--adjust-features", "--coplanar-ties", "--directions",
          "--principal-point-stddev"};
}

Status ChooseAdjustment(const std::vector<std::string>& features,
                        const std::optional<std::string>& coplanar_ties,
                        std::optional<bool> directions,
                        AdjustmentOptions* options) {
  LOWLAP_RETURN_IF_ERROR(SetAdjustedFeatures(features, options));
  if (coplanar_ties) {
    LOWLAP_ASSIGN_OR_RETURN(options->coplanar_ties,
                            ParseCoplanarTies(*coplanar_ties));
  }
  options->use_directions = directions.value_or(options->use_directions);
  return {};
}

void WarnOfIdleTies(const std::optional<std::string>& coplanar_ties,
                    std::optional<bool> directions,
                    const AdjustmentOptions& options,
                    const RunContext& context) {
  // Pairs leave directions out, whether there are coplanar pairs or not.
  const bool leaves_directions_out =
      options.coplanar_ties == CoplanarTies::kPairs && options.use_directions &&
      options.use_lines && !options.MovesIntrinsics();
  if (coplanar_ties && !options.use_coplanar && !leaves_directions_out) {
    context.Log(LogLevel::kWarning,
                "--coplanar-ties is ignored: coplanar is not among "
                "--adjust-features");
  }
  if (!directions.value_or(false)) return;
  const char* reason = !options.use_lines ? "the adjustment has no lines"
                       : options.coplanar_ties == CoplanarTies::kPairs
                           ? "--coplanar-ties pairs leaves them out"
                       : options.MovesIntrinsics() ? "intrinsics move"
                                                   : nullptr;
  if (reason == nullptr) return;
  context.Log(LogLevel::kWarning,
              std::string("--directions is ignored: ") + reason);
}

void AddCoplanarTiesFlag(CLI::App* command, std::optional<std::string>* ties) {
  AddOption(command, "--coplanar-ties", *ties,
            "What of the coplanar kind holds the end of the bundle adjustment: "
            "the pairs of lines of the ratios, the planes of the scene with "
            "the points and lines on them (the pairs where there are none), or "
            "both")
      .Must(Check::OneOf({"pairs", "planes", "both"}))
      .ShowDefault(kDefaultCoplanarTies);
}

void AddDirectionsFlag(CLI::App* command, std::optional<bool>* directions) {
  AddFlag(command, "--directions,!--no-directions", *directions,
          "Whether the directions of parallel lines hold rotations in the "
          "bundle adjustment; never with --coplanar-ties pairs, nor while "
          "intrinsics move");
}

void AddPrincipalPointFlag(CLI::App* command, double* stddev) {
  AddOption(command, "--principal-point-stddev", *stddev,
            "How well the given principal points are known, as a share "
            "of the image diagonal (0.0003: a pixel of six "
            "megapixels): the bundle adjustment moves them within "
            "this; 0: it holds them")
      .Must(Check::NonNegative())
      .ShowDefault();
}

}  // namespace lowlap::cli
