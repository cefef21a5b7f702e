#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
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

// What was measured between two pieces. Of pieces that are far apart there is
// nothing, and nothing to be said.
struct Between {
  std::vector<const PairAgreement*> pairs;
  std::vector<const RatioAgreement*> ratios;
};

using PiecePair = std::pair<std::size_t, std::size_t>;  // the smaller first

std::set<PiecePair> PairsOf(const std::vector<std::size_t>& some,
                            const std::vector<std::size_t>& others) {
  std::set<PiecePair> pairs;
  for (const std::size_t p : some) {
    for (const std::size_t q : others) {
      if (p != q) pairs.insert(std::minmax(p, q));
    }
  }
  return pairs;
}

// Of pieces that share views, and of those with anything between them.
std::map<PiecePair, Between> FindBetween(const ModelCheck& check) {
  std::map<ViewId, std::vector<std::size_t>> of_view;
  std::map<ViewPair, std::vector<std::size_t>> of_pair;
  for (std::size_t p = 0; p < check.pieces.size(); ++p) {
    for (const ViewId view : check.pieces[p].views) of_view[view].push_back(p);
    for (const ViewPair& pair : check.pieces[p].pairs) {
      of_pair[pair].push_back(p);
    }
  }
  std::map<PiecePair, Between> between;
  for (const auto& entry : of_view) {
    for (const PiecePair& two : PairsOf(entry.second, entry.second)) {
      between[two];
    }
  }
  for (const PairAgreement& pair : check.pairs) {
    for (const PiecePair& two :
         PairsOf(of_view[pair.views.first], of_view[pair.views.second])) {
      if (IsAcross(pair.views, check.pieces[two.first],
                   check.pieces[two.second])) {
        between[two].pairs.push_back(&pair);
      }
    }
  }
  for (const RatioAgreement& ratio : check.ratios) {
    const ViewTriplet& v = ratio.views;
    for (const PiecePair& two :
         PairsOf(of_pair[OrderedPair(v.first, v.middle)],
                 of_pair[OrderedPair(v.middle, v.last)])) {
      between[two].ratios.push_back(&ratio);
    }
  }
  return between;
}

// Turns and directions that contradict between two pieces; empty if none do.
std::string PairsAcross(const Between& between) {
  std::vector<double> turns, directions;
  for (const PairAgreement* pair : between.pairs) {
    if (pair->Agrees()) continue;
    turns.push_back(pair->rotation_error_rad);
    directions.push_back(pair->direction_error_rad);
  }
  if (turns.empty()) return {};
  const std::size_t num_against = turns.size();
  return Format(
      "%zu of %zu relative poses between them contradict it, by %.1f degrees "
      "of "
      "rotation and %.1f of direction",
      num_against, between.pairs.size(), DegFromRad(Median(std::move(turns))),
      DegFromRad(Median(std::move(directions))));
}

// The scale that ratios give the second piece in the first; empty if none do.
std::string RatiosAcross(const Between& between, const RigidPiece& first) {
  std::vector<double> errors;
  for (const RatioAgreement* ratio : between.ratios) {
    if (ratio->Agrees()) continue;
    const bool is_forward =
        first.Holds(ratio->views.first, ratio->views.middle);
    errors.push_back(is_forward ? ratio->error : -ratio->error);
  }
  if (errors.empty()) return {};
  const std::size_t num_against = errors.size();
  const double factor = std::exp(Median(std::move(errors)));
  return Format(
      "%zu of %zu scale ratios between them contradict it: the model has the "
      "second %.2f times too %s",
      num_against, between.ratios.size(), std::max(factor, 1 / factor),
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
  for (const auto& [two, between] : FindBetween(check)) {
    const RigidPiece& a = check.pieces[two.first];
    const RigidPiece& b = check.pieces[two.second];
    const std::string pairs = PairsAcross(between);
    const std::string ratios = RatiosAcross(between, a);
    const std::string shared = SharedViews(measured, a, b);
    if (pairs.empty() && ratios.empty() && shared.empty()) continue;
    std::string why = pairs;
    if (!pairs.empty() && !ratios.empty()) why += "; ";
    why += ratios;
    if (why.empty()) why = "nothing that was measured ties their scales";
    std::string line = Format("%s: pieces %zu and %zu", model.name.c_str(),
                              two.first + 1, two.second + 1);
    line += shared;
    line += " are not one: ";
    line += why;
    lines.push_back(std::move(line));
  }
  if (!check.unconfirmed.empty()) {
    lines.push_back(model.name + ": nothing bears out the places of " +
                    NamesOf(measured, check.unconfirmed));
  }
  return lines;
}

}  // namespace lowlap
