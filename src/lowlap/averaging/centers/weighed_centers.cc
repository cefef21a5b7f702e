#include "lowlap/averaging/centers/internal/weighed_centers.h"

#include <algorithm>
#include <utility>

#include "lowlap/averaging/centers/internal/side_search.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

bool IsVagueRatio(const ScaleRatio& ratio) {
  return ratio.verdict == RatioVerdict::kMeaningful &&
         ratio.log_ratio_stddev > DiagnosisOptions().max_stddev;
}

// Leaves ratios that hardly say anything to views that nothing else places.
Scene WithVagueRatiosWeak(const Scene& scene) {
  Scene result = scene;
  for (ScaleRatio& ratio : result.scale_ratios) {
    if (IsVagueRatio(ratio)) ratio.verdict = RatioVerdict::kNotMeaningful;
  }
  return result;
}

}  // namespace

Result<WeighedCenters> SolveWeighedCenters(const Scene& scene,
                                           const SceneRotations& rotations,
                                           const PoseOptions& options,
                                           const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(
      SideFound found,
      SearchSides(scene, rotations, options, SideStart::kStrongest, context));
  const auto try_other = [&](const Scene& same, SideStart start) -> Status {
    Result<SideFound> other =
        SearchSides(same, rotations, options, start, context);
    if (!other && other.error().code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(other.error());
    }
    if (other && other->side.NumPlaced() >= found.side.NumPlaced() &&
        other->side.EvidenceAgainst() < found.side.EvidenceAgainst()) {
      found = *std::move(other);
    }
    return {};
  };
  if (found.side.IsContradicted(rotations)) {
    LOWLAP_RETURN_IF_ERROR(try_other(scene, SideStart::kGrown));
    if (std::any_of(scene.scale_ratios.begin(), scene.scale_ratios.end(),
                    IsVagueRatio)) {
      const Scene same = WithVagueRatiosWeak(scene);
      for (const SideStart start : {SideStart::kStrongest, SideStart::kGrown}) {
        LOWLAP_RETURN_IF_ERROR(try_other(same, start));
      }
    }
  }
  return WeighedCenters{std::move(found.side.centers),
                        std::move(found.contests)};
}

}  // namespace lowlap
