#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/pipeline/internal/output/run_output.h"

namespace lowlap {

/// Makes the folder (and its parents) if it does not exist; kIo if a file is
/// in the way or it cannot be written to.
Status PrepareOutputFolder(const std::string& folder);

/// Makes the folder and writes files (name, content) into it, as a FileSet.
Status WriteTextFiles(
    const std::vector<std::pair<std::string, std::string>>& files,
    const std::string& folder);

}  // namespace lowlap
