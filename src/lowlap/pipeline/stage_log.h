#pragma once

#include <string>
#include <vector>

#include "lowlap/core/run_context.h"

namespace lowlap {

/// What one stage cost.
struct StageCost {
  std::string name;
  double wall_s = 0;
  double cpu_s = 0;  // of the whole process, all threads
};

/// Collects the cost of the stages of a run, in order.
class StageLog {
 public:
  /// Times a stage from construction to destruction; `log` may be null.
  class Scope {
   public:
    Scope(StageLog* log, std::string name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageLog* log_;
    StageCost cost_;
    double wall_start_s_;
    double cpu_start_s_;
  };

  const std::vector<StageCost>& stages() const { return stages_; }

 private:
  std::vector<StageCost> stages_;
};

/// Largest resident memory of this process so far, in megabytes.
double PeakMemoryMb();

}  // namespace lowlap
