#include "lowlap/scale/evidence/evidence_registry.h"

#include <algorithm>
#include <utility>

#include "lowlap/core/internal/joined.h"
#include "lowlap/scale/evidence/internal/coplanar_lines.h"
#include "lowlap/scale/evidence/internal/plane_points.h"
#include "lowlap/scale/evidence/internal/trifocal.h"

namespace lowlap {
namespace {

template <class Kind>
EvidenceRegistry::Entry EntryOf(std::string feature, std::string help,
                                std::string flag = {}) {
  return {Kind().Name(), std::move(feature), std::move(help), std::move(flag),
          [] { return std::make_shared<Kind>(); }};
}

bool Contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

const EvidenceRegistry& EvidenceRegistry::BuiltIn() {
  static const EvidenceRegistry registry = [] {
    EvidenceRegistry built_in;
    built_in.Add(EntryOf<TrifocalPointKind>("points", "seen in three views"));
    built_in.Add(EntryOf<TrifocalLineKind>("lines", "seen in three views"));
    built_in.Add(EntryOf<CoplanarLinesKind>(
        "coplanar", "pairs of lines seen in two views each"));
    built_in.Add(EntryOf<PlanePointsKind>(
        "coplanar",
        "points and lines of one pair that lie on a plane of the other",
        "coplanar-points"));
    return built_in;
  }();
  return registry;
}

void EvidenceRegistry::Add(Entry entry) {
  const auto same =
      std::find_if(entries_.begin(), entries_.end(),
                   [&](const Entry& e) { return e.name == entry.name; });
  if (same != entries_.end()) {
    *same = std::move(entry);
  } else {
    entries_.push_back(std::move(entry));
  }
}

std::vector<std::string> EvidenceRegistry::Features() const {
  std::vector<std::string> features;
  for (const Entry& entry : entries_) {
    if (!Contains(features, entry.feature)) features.push_back(entry.feature);
  }
  return features;
}

Result<EvidenceKinds> EvidenceRegistry::Make(
    const std::vector<std::string>& features,
    const std::vector<std::string>& without) const {
  const std::vector<std::string> known = Features();
  for (const std::string& feature : features) {
    if (Contains(known, feature)) continue;
    return MakeError(ErrorCode::kInvalidArgument,
                     "unknown kind of feature '" + feature +
                         "'; known: " + Joined(known, ", "));
  }
  for (const std::string& name : without) {
    const auto has_name = [&](const Entry& e) { return e.name == name; };
    if (std::none_of(entries_.begin(), entries_.end(), has_name)) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "unknown kind of evidence '" + name + "'");
    }
  }
  EvidenceKinds kinds;
  for (const Entry& entry : entries_) {
    if ((features.empty() || Contains(features, entry.feature)) &&
        !Contains(without, entry.name)) {
      kinds.push_back(entry.make());
    }
  }
  if (kinds.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "no kind of feature is enabled for the scale ratios");
  }
  return kinds;
}

}  // namespace lowlap
