#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/pipeline/internal/output/run_output.h"

namespace lowlap {

/// A folder for results. Of what it had to make, it removes what is empty when
/// it goes: make it before the FileSet that fills it.
class OutputFolder {
 public:
  OutputFolder() = default;
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Makes the folder (and its parents) if it does not exist; kIo if a file is
  /// in the way or it cannot be written to. Once.
  Status Make(const std::string& folder);

 private:
  std::vector<std::string> made_;  // the deepest first
};

/// Makes the folder and writes files (name, content) into it, as a FileSet.
Status WriteTextFiles(
    const std::vector<std::pair<std::string, std::string>>& files,
    const std::string& folder);

}  // namespace lowlap
