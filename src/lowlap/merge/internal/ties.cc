#include "lowlap/merge/internal/ties.h"

#include <algorithm>
#include <set>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/merge/internal/agreement.h"
#include "lowlap/merge/internal/names.h"
#include "lowlap/merge/internal/rigid_pieces.h"

namespace lowlap {
namespace {

// How many of the relative poses of `piece` are in `group`.
std::size_t CountPairs(const RigidPiece& piece, const RigidPiece& group) {
  const std::set<ViewPair> pairs(group.pairs.begin(), group.pairs.end());
  return static_cast<std::size_t>(std::count_if(
      piece.pairs.begin(), piece.pairs.end(),
      [&](const ViewPair& pair) { return pairs.count(pair) > 0; }));
}

bool IsIn(const TrustedPiece& trusted, const RigidPiece& group) {
  return 2 * CountPairs(trusted.piece, group) > trusted.piece.pairs.size();
}

// The piece of the merged cameras that holds most of what is trusted.
RigidPiece MainGroup(const std::vector<RigidPiece>& groups,
                     const std::vector<TrustedPiece>& pieces) {
  RigidPiece best;
  std::size_t most = 0;
  for (const RigidPiece& group : groups) {
    std::size_t held = 0;
    for (const TrustedPiece& trusted : pieces) {
      if (IsIn(trusted, group)) held += trusted.piece.views.size();
    }
    if (held > most) {
      most = held;
      best = group;
    }
  }
  return best;
}

// What was measured between the views of a piece and all others, or among them
// where there are no others.
std::string EvidenceAcross(const Scene& scene, const RigidPiece& piece,
                           const std::set<ViewPair>& agreeing) {
  const std::set<ViewId> inside(piece.views.begin(), piece.views.end());
  const auto is_inside = [&](ViewId view) { return inside.count(view) > 0; };
  const bool has_others = inside.size() < scene.views.size();
  int num_pairs = 0, num_agreeing = 0;
  for (const auto& entry : scene.relative_poses) {
    const ViewPair& views = entry.first;
    if (has_others && is_inside(views.first) == is_inside(views.second)) {
      continue;
    }
    ++num_pairs;
    num_agreeing += static_cast<int>(agreeing.count(views));
  }
  if (!has_others) {
    return Format(
        "of the %d relative poses between them %d agree, and tie no three of "
        "them",
        num_pairs, num_agreeing);
  }
  if (num_pairs == 0) return "no relative pose joins them to any other view";
  int num_ratios = 0, num_meaningful = 0;
  const ScaleRatio* best = nullptr;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    const ViewTriplet& views = ratio.views;
    const int count = is_inside(views.first) + is_inside(views.middle) +
                      is_inside(views.last);
    if (count == 0 || count == 3) continue;
    ++num_ratios;
    num_meaningful += ratio.verdict == RatioVerdict::kMeaningful ? 1 : 0;
    if (ratio.verdict != RatioVerdict::kNoCandidates &&
        (best == nullptr || ratio.log10_nfa < best->log10_nfa)) {
      best = &ratio;
    }
  }
  std::string text = Format(
      "%d relative poses join them to other views, of which %d agree with one "
      "another; of %d scale ratios across, %d are meaningful",
      num_pairs, num_agreeing, num_ratios, num_meaningful);
  if (best != nullptr) {
    text += " (the best: " +
            NamesOf(scene,
                    {best->views.first, best->views.middle, best->views.last}) +
            Format(", log10 NFA %.1f)", best->log10_nfa);
  }
  return text;
}

}  // namespace

Status CheckTies(const Scene& scene, const PoseSummary& summary,
                 const std::vector<PartialModel>& models,
                 const std::vector<TrustedPiece>& pieces,
                 const PoseOptions& options, const RunContext& context) {
  std::map<ViewPair, RelativePose> in_use = scene.relative_poses;
  for (const OutlierEdge& outlier : summary.outlier_edges) {
    in_use.erase(outlier.views);
  }
  const std::map<ViewId, Pose> poses = GroundTruthFromScene(scene);
  const auto pairs = ComparePairs(in_use, poses, options);
  LOWLAP_ASSIGN_OR_RETURN(
      const auto groups,
      FindRigidPieces(poses, pairs,
                      CompareRatios(scene.scale_ratios, poses, options),
                      options.outlier_reach, context));
  const RigidPiece together = MainGroup(groups, pieces);
  std::set<ViewPair> agreeing;
  for (const PairAgreement& pair : pairs) {
    if (pair.Agrees()) agreeing.insert(pair.views);
  }
  std::string reasons;
  for (const TrustedPiece& trusted : pieces) {
    if (IsIn(trusted, together)) continue;
    reasons += (reasons.empty() ? "" : "\n") + models[trusted.model].name +
               ": nothing fixes the place and the scale of " +
               NamesOf(scene, trusted.piece.views) + ": " +
               EvidenceAcross(scene, trusted.piece, agreeing);
  }
  if (reasons.empty()) return {};
  return MakeError(ErrorCode::kInsufficientData,
                   "the models cannot be merged\n" + reasons);
}

}  // namespace lowlap
