#pragma once

#include <memory>
#include <string>

#include "lowlap/scale/evidence/evidence_kind.h"

namespace lowlap {

/// Points seen in all three views (TripletView::points), by TripletPointSolver
/// and PointResiduals.
class TrifocalPointKind : public EvidenceKind {
 public:
  std::string Name() const override { return "points"; }
  std::unique_ptr<Evidence> Gather(const TripletView& triplet) const override;
};

}  // namespace lowlap
