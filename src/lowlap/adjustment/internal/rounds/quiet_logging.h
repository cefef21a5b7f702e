#pragma once

namespace lowlap {

/// While one exists, the solver's own log (glog, a process-wide switch) is
/// silent below fatal errors: the library writes to no stream, what matters of
/// a failed step is in the summary. Nests, also over threads.
class QuietLogging {
 public:
  QuietLogging();
  ~QuietLogging();
  QuietLogging(const QuietLogging&) = delete;
  QuietLogging& operator=(const QuietLogging&) = delete;
};

}  // namespace lowlap
