#pragma once

#include <memory>
#include <string>

#include "lowlap/scale/evidence/evidence_kind.h"

namespace lowlap {

/// Pairs of a line of (i, j) and a line of (j, k) that may lie in one plane
/// (CoplanarRatio, FindCoplanarCandidates), each line with its 10 nearest;
/// their errors are TransferResiduals. Lines count once.
///
/// Pairs are tried in nested tiers of proximity: those whose crossing is within
/// 1 % and within 3.5 % of the image diagonal of both segments. Lines that meet
/// in the image are far more often coplanar than others (in the rendered rooms
/// 80 to 90 % of the pairs that nearly touch give the right ratio, 20 % of
/// those more than 100 px apart); pairs that meet farther off are not used:
/// what they agree on by chance, since whole families of them are parallel, is
/// wrong too often.
class CoplanarLinesKind : public EvidenceKind {
 public:
  std::string Name() const override { return "coplanar"; }
  std::unique_ptr<Evidence> Gather(const TripletView& triplet) const override;
};

}  // namespace lowlap
