#include "lowlap/pipeline/internal/output/ratio_profiles.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scale/internal/search/ratio_profile.h"

namespace lowlap {
namespace {

bool AreAlike(const RatioOptimum& a, const RatioOptimum& b) {
  constexpr double kAlike = 0.05;
  if (std::abs(a.nfa.log10_nfa - b.nfa.log10_nfa) > kAlike) return false;
  for (std::size_t k = 0; k < a.nfa.kinds.size(); ++k) {
    if (std::abs(a.nfa.kinds[k].log10_nfa - b.nfa.kinds[k].log10_nfa) >
        kAlike) {
      return false;
    }
  }
  return true;
}

ReportProfile MakeProfile(const RatioProfile& profile) {
  ReportProfile page;
  for (const std::string& kind : profile.kinds) {
    page.kinds.emplace_back(kind, std::vector<double>());
  }
  const std::vector<RatioOptimum>& nodes = profile.nodes;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const bool is_flat = n > 0 && n + 1 < nodes.size() &&
                         AreAlike(nodes[n - 1], nodes[n]) &&
                         AreAlike(nodes[n], nodes[n + 1]);
    if (is_flat) continue;
    page.log_ratios.push_back(nodes[n].log_ratio);
    page.log10_nfas.push_back(nodes[n].nfa.log10_nfa);
    for (std::size_t k = 0; k < page.kinds.size(); ++k) {
      page.kinds[k].second.push_back(nodes[n].nfa.kinds[k].log10_nfa);
    }
  }
  return page;
}

std::vector<ScaleRatio> ChooseRatios(const Scene& scene) {
  constexpr std::size_t kMostWeak = 200, kMostOthers = 200;
  std::vector<ScaleRatio> ratios;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    if (ratio.verdict != RatioVerdict::kNoCandidates) ratios.push_back(ratio);
  }
  if (ratios.size() <= kMostWeak + kMostOthers) return ratios;
  std::stable_sort(ratios.begin(), ratios.end(),
                   [](const ScaleRatio& a, const ScaleRatio& b) {
                     return a.log10_nfa > b.log10_nfa;
                   });
  const std::size_t num_others = ratios.size() - kMostWeak;
  std::vector<ScaleRatio> chosen(ratios.begin(), ratios.begin() + kMostWeak);
  for (std::size_t n = 0; n < kMostOthers; ++n) {
    chosen.push_back(ratios[kMostWeak + n * num_others / kMostOthers]);
  }
  return chosen;
}

}  // namespace

Result<std::map<ViewTriplet, ReportProfile>> ProfilesForPage(
    const Scene& scene, const EvidenceKinds& kinds, const RunContext& context) {
  std::map<ViewTriplet, ReportProfile> pages;
  if (kinds.empty()) return pages;
  LOWLAP_ASSIGN_OR_RETURN(
      const auto profiles,
      SketchScaleRatios(scene, ChooseRatios(scene), kinds, context));
  for (const RatioProfile& profile : profiles) {
    if (!profile.nodes.empty())
      pages[profile.ratio.views] = MakeProfile(profile);
  }
  return pages;
}

}  // namespace lowlap
