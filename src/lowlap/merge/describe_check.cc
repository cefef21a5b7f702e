#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/types.h"
#include "lowlap/merge/internal/names.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

bool Holds(const std::vector<ViewId>& views, ViewId view) {
  return std::binary_search(views.begin(), views.end(), view);
}

// Joins the views of one piece and those of the other, and both in neither.
bool IsAcross(const ViewPair& pair, const RigidPiece& a, const RigidPiece& b) {
  const auto inside = [&](const RigidPiece& piece) {
    return Holds(piece.views, pair.first) && Holds(piece.views, pair.second);
  };
  return !inside(a) && !inside(b) &&
         ((Holds(a.views, pair.first) && Holds(b.views, pair.second)) ||
          (Holds(b.views, pair.first) && Holds(a.views, pair.second)));
}

// Turns and directions that contradict between two pieces; empty if none do.
std::string PairsAcross(const ModelCheck& check, const RigidPiece& a,
                        const RigidPiece& b) {
  int num_across = 0;
  std::vector<double> turns, directions;
  for (const PairAgreement& pair : check.pairs) {
    if (!IsAcross(pair.views, a, b)) continue;
    ++num_across;
    if (pair.Agrees()) continue;
    turns.push_back(pair.rotation_error_rad);
    directions.push_back(pair.direction_error_rad);
  }
  if (turns.empty()) return {};
  const std::size_t num_against = turns.size();
  return Format(
      "%zu of %d relative poses between them contradict it, by %.1f degrees of "
      "rotation and %.1f of direction",
      num_against, num_across, DegFromRad(Median(std::move(turns))),
      DegFromRad(Median(std::move(directions))));
}

// The scale that ratios give the second piece in the first; empty if none do.
std::string RatiosAcross(const ModelCheck& check, const RigidPiece& a,
                         const RigidPiece& b) {
  std::size_t num_across = 0;
  std::vector<double> errors;
  for (const RatioAgreement& ratio : check.ratios) {
    const ViewTriplet& v = ratio.views;
    const bool forward =
        a.Holds(v.first, v.middle) && b.Holds(v.middle, v.last);
    const bool backward =
        b.Holds(v.first, v.middle) && a.Holds(v.middle, v.last);
    if (!forward && !backward) continue;
    ++num_across;
    if (!ratio.Agrees()) errors.push_back(forward ? ratio.error : -ratio.error);
  }
  if (errors.empty()) return {};
  const std::size_t num_against = errors.size();
  const double factor = std::exp(Median(std::move(errors)));
  return Format(
      "%zu of %zu scale ratios between them contradict it: the model has the "
      "second %.2f times too %s",
      num_against, num_across, std::max(factor, 1 / factor),
      factor > 1 ? "large" : "small");
}

std::string SharedViews(const Scene& scene, const RigidPiece& a,
                        const RigidPiece& b) {
  std::vector<ViewId> shared;
  std::set_intersection(a.views.begin(), a.views.end(), b.views.begin(),
                        b.views.end(), std::back_inserter(shared));
  return shared.empty() ? ""
                        : ", which meet in " + NamesOf(scene, shared) + ",";
}

}  // namespace

std::vector<std::string> DescribeCheck(const PartialModel& model,
                                       const ModelCheck& check,
                                       const Scene& measured) {
  const auto agree = [](const auto& agreement) { return agreement.Agrees(); };
  std::vector<std::string> lines;
  lines.push_back(Format(
      "%s: %zu cameras; %zu of %zu relative poses and %zu of %zu scale ratios "
      "agree with it%s",
      model.name.c_str(), model.poses.size(),
      static_cast<std::size_t>(
          std::count_if(check.pairs.begin(), check.pairs.end(), agree)),
      check.pairs.size(),
      static_cast<std::size_t>(
          std::count_if(check.ratios.begin(), check.ratios.end(), agree)),
      check.ratios.size(),
      check.IsWhole() ? ", which bear out all of it" : ""));
  if (check.IsWhole()) return lines;
  for (std::size_t p = 0; p < check.pieces.size(); ++p) {
    lines.push_back(Format("%s: piece %zu of %zu: ", model.name.c_str(), p + 1,
                           check.pieces.size()) +
                    NamesOf(measured, check.pieces[p].views));
  }
  for (std::size_t p = 0; p < check.pieces.size(); ++p) {
    for (std::size_t q = p + 1; q < check.pieces.size(); ++q) {
      const RigidPiece& a = check.pieces[p];
      const RigidPiece& b = check.pieces[q];
      const std::string pairs = PairsAcross(check, a, b);
      const std::string ratios = RatiosAcross(check, a, b);
      const std::string shared = SharedViews(measured, a, b);
      // Of pieces that are far apart there is nothing to say.
      if (pairs.empty() && ratios.empty() && shared.empty()) continue;
      lines.push_back(
          Format("%s: pieces %zu and %zu", model.name.c_str(), p + 1, q + 1) +
          shared + " are not one: " +
          (pairs.empty() && ratios.empty()
               ? "nothing that was measured ties their scales"
               : pairs + (pairs.empty() || ratios.empty() ? "" : "; ") +
                     ratios));
    }
  }
  if (!check.unconfirmed.empty()) {
    lines.push_back(model.name + ": nothing bears out the places of " +
                    NamesOf(measured, check.unconfirmed));
  }
  return lines;
}

}  // namespace lowlap
