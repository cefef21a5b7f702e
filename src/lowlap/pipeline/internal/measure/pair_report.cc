#include "lowlap/pipeline/internal/measure/pair_report.h"

#include <algorithm>
#include <tuple>

#include "lowlap/core/internal/format.h"

namespace lowlap {
namespace {

int NumMatches(const PairReport& pair) {
  return pair.num_point_matches + pair.num_line_matches;
}

}  // namespace

void CountInliers(const Scene& scene, std::vector<PairReport>* pairs) {
  for (PairReport& pair : *pairs) {
    const auto found = scene.relative_poses.find(pair.views);
    if (found == scene.relative_poses.end()) continue;
    pair.num_point_inliers =
        static_cast<int>(found->second.point_inliers.size());
    pair.num_line_inliers = static_cast<int>(found->second.line_inliers.size());
  }
}

std::string ExplainNoPose(const std::vector<PairReport>& pairs) {
  const std::string none = "no pair of views has a relative pose";
  if (pairs.empty()) return none + ", for none has matches";
  const PairReport& best = *std::max_element(
      pairs.begin(), pairs.end(), [](const PairReport& a, const PairReport& b) {
        return NumMatches(a) < NumMatches(b);
      });
  return none +
         Format(
             "; of %zu, views %u and %u match most (%d points, %d "
             "lines): ",
             pairs.size(), static_cast<unsigned>(best.views.first),
             static_cast<unsigned>(best.views.second), best.num_point_matches,
             best.num_line_matches) +
         best.reason;
}

std::vector<UnrelatedView> FindUnrelatedViews(
    const std::map<ViewId, View>& all, const std::vector<PairReport>& pairs,
    const std::map<ViewId, Error>& failed) {
  // Of every view: related, or the pair that says most.
  std::map<ViewId, const PairReport*> best;
  for (const PairReport& pair : pairs) {
    for (const ViewId view : {pair.views.first, pair.views.second}) {
      const PairReport*& known = best[view];
      const auto rank = [](const PairReport& p) {
        return std::make_tuple(p.accepted, p.no_parallax, NumMatches(p));
      };
      if (known == nullptr || rank(*known) < rank(pair)) known = &pair;
    }
  }
  std::vector<UnrelatedView> views;
  for (const auto& [id, view] : all) {
    const auto error = failed.find(id);
    const auto pair = best.find(id);
    if (error != failed.end()) {
      views.push_back({id, false, error->second.message});
    } else if (pair == best.end()) {
      views.push_back({id, false, "no pair with it was matched"});
    } else if (!pair->second->accepted) {
      views.push_back({id, pair->second->no_parallax, pair->second->reason});
    }
  }
  return views;
}

}  // namespace lowlap
