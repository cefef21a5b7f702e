#pragma once

#include <map>
#include <vector>

#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/adjustment/internal/uncertainty/center_covariances.h"

namespace lowlap {

/// From one solution to another: the steps d of the centres, after the least
/// similarity of every component. Components whose centres fix none have no
/// steps.
class CenterShift {
 public:
  CenterShift(const CameraSet& cameras,
              const std::vector<Component>& components, const CameraSet& moved);

  const std::map<PoseId, Vec3>& steps() const { return steps_; }

  /// As much as is at stake, wherever to: |d|^2 / 3 in every direction of a
  /// centre; changes of log ratios and directions add their squares.
  void AddTo(CenterUncertainty* uncertainty) const;
  /// As one of several that are drawn: `weight` d d^T, and `weight` times the
  /// squares of the changes.
  void AddDrawn(double weight, CenterUncertainty* uncertainty) const;

 private:
  void AddChanges(double weight, CenterUncertainty* uncertainty) const;
  const PoseState& PoseOf(ViewId view) const;
  bool Has(ViewId view) const;
  Vec3 Before(ViewId view) const;
  Vec3 After(ViewId view) const;

  const CameraSet& cameras_;
  std::map<PoseId, Vec3> steps_;
};

}  // namespace lowlap
