#pragma once

#include <functional>
#include <memory>
#include <string>

#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/pipeline/stage_log.h"
#include "python/keywords.h"

namespace lowlap::python {

/// What solve(), run() and merge() return.
struct Solution {
  std::shared_ptr<Scene> scene;
  RunSummary summary;

  const PoseSummary& poses() const { return summary.solve->poses; }
};

/// Raises if results cannot be put into the folder; empty: none is asked for.
void CheckOutput(const std::string& output);

/// A scene to solve, as MeasuredSceneOf gives it. Its adjustment starts from
/// the calibration as it was given, or from that with which it was related
/// here.
Solution LoadToSolve(const py::object& scene, const SceneInput& input,
                     const SolveArguments& arguments, Call* call,
                     StageLog* stages, const ViewCheck& check = nullptr);

/// Photographs, and how they are measured.
struct Photographs {
  std::string folder;
  IntrinsicSource intrinsics;
  std::vector<std::string> exclude;
  MeasurementOptions measurement;
};

/// Measures photographs as `lowlap run` does, if `check`, which may be null,
/// finds nothing, and if the true cameras fit.
Solution MeasurePhotographs(const Photographs& photographs,
                            const SolveArguments& arguments, Call* call,
                            StageLog* stages, const ViewCheck& check = nullptr);

using Solver = std::function<Result<SolveResult>(Scene*, const SolveOptions&,
                                                 const RunContext&, StageLog*)>;

/// Solves solution->scene, evaluates it and writes what is asked for.
void SolveInPlace(const SolveArguments& arguments, Call* call, StageLog* stages,
                  Solution* solution, const Solver& solver = SolveScene);

}  // namespace lowlap::python
