#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/study/internal/trust/scenes.h"

namespace lowlap {

/// A camera of a solved scene against the truth.
struct JudgedView {
  ViewId view = kInvalidId;
  GradedView graded;
  /// In shares of the scene's size (RobustPositionErrors). Infinite: not
  /// placed, or there is no truth.
  double error = 0;
  /// The standard deviation that the adjustment states for the centre
  /// (CenterStddev), in the unit of the error; 0 if it states none.
  double deviation = 0;

  bool IsFirm() const { return graded.grade == ViewGrade::kFirm; }
  bool IsDoubtful() const { return graded.grade == ViewGrade::kDoubtful; }
  bool IsPlaced() const { return graded.grade != ViewGrade::kUnplaced; }
};

/// What SolveScene made of one scene, with its default options.
struct TrustTrial {
  std::vector<std::string> labels;  // of the scene
  /// Why there is no solution; else empty.
  std::string failure;
  int num_triplets = 0;
  int num_meaningful = 0;  // of their ratios
  /// Something is doubtful, whether cameras are named or not.
  bool is_doubtful = false;
  std::vector<JudgedView> views;  // all of the scene
};

/// Draws, makes, solves and judges the scene. Only cancelling is an error.
Result<TrustTrial> RunTrustTrial(TrustFamily family, std::uint64_t seed,
                                 const RunContext& context);

}  // namespace lowlap
