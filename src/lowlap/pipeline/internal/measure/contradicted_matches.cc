#include "lowlap/pipeline/internal/measure/contradicted_matches.h"

#include <algorithm>
#include <utility>

#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

// Those with evidence of their own: a pose that was given has none.
std::vector<std::size_t> EvidenceFirst(
    const std::vector<PairEstimate>& estimates) {
  std::vector<std::size_t> order;
  for (std::size_t n = 0; n < estimates.size(); ++n) {
    if (estimates[n].pose && estimates[n].log10_nfa_with_repeats < 0) {
      order.push_back(n);
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) {
                     return estimates[a].log10_nfa_with_repeats <
                            estimates[b].log10_nfa_with_repeats;
                   });
  return order;
}

MatchLoops LoopsOf(const Scene& scene) {
  std::map<ViewId, MatchLoops::View> views;
  for (const auto& [id, features] : scene.features) {
    const View& view = scene.views.at(id);
    views[id] = {&features,
                 static_cast<double>(std::max(view.width_px, view.height_px))};
  }
  return MatchLoops(std::move(views));
}

// More than surfaces that end explain.
bool StandsOnCopies(const std::vector<LoopVerdict>& verdicts) {
  constexpr double kUsualShare = 0.1;
  constexpr double kMaxLog10Chance = -3;
  const auto count = [&](LoopVerdict verdict) {
    return static_cast<int>(
        std::count(verdicts.begin(), verdicts.end(), verdict));
  };
  const int elsewhere = count(LoopVerdict::kLeadsElsewhere);
  const int told = elsewhere + count(LoopVerdict::kCloses);
  return Log10BinomialTail(told, elsewhere, kUsualShare) < kMaxLog10Chance;
}

}  // namespace

std::vector<FeatureMatch> WithoutContradicted(
    const std::vector<FeatureMatch>& matches,
    const std::vector<LoopVerdict>& verdicts) {
  std::vector<FeatureMatch> rest;
  for (std::size_t n = 0; n < matches.size(); ++n) {
    if (verdicts[n] != LoopVerdict::kLeadsElsewhere) rest.push_back(matches[n]);
  }
  return rest;
}

LoopFindings ExamineLoops(const Scene& scene,
                          const std::vector<ViewPair>& pairs,
                          const std::map<ViewPair, PairMatches>& matches,
                          const std::vector<PairEstimate>& estimates) {
  LoopFindings findings = {LoopsOf(scene), {}};
  MatchLoops& loops = findings.loops;
  for (const std::size_t n : EvidenceFirst(estimates)) {
    const ViewPair& pair = pairs[n];
    const std::vector<FeatureMatch>& inliers = estimates[n].pose->point_inliers;
    const std::vector<LoopVerdict> verdicts = loops.OfPoints(pair, inliers);
    loops.Add(pair, WithoutContradicted(inliers, verdicts));
    if (!StandsOnCopies(verdicts)) continue;
    const PairMatches& putative = matches.at(pair);
    findings.allowed[n] = {
        WithoutContradicted(putative.points,
                            loops.OfPoints(pair, putative.points)),
        WithoutContradicted(putative.lines,
                            loops.OfLines(pair, putative.lines))};
  }
  return findings;
}

}  // namespace lowlap
