#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/pipeline/internal/output/summary_json.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Whether results can be put into the folder: it is one that can be written
/// to, or can be made. Makes nothing; for asking before long work. kIo if a
/// file is in the way or a folder cannot be written to.
Status CheckOutputFolder(const std::string& folder);

/// Makes the folder (and its parents) if it does not exist; kIo if a file is
/// in the way or it cannot be written to.
Status PrepareOutputFolder(const std::string& folder);

/// Makes the folder and writes what every solving command leaves, as a FileSet:
/// sfm_data.json (OpenMVG loads it), scene.lowlap (everything), cloud.ply
/// (points, lines, cameras), report.html (for a person) and summary.json (for
/// a program). A relative root_path is made absolute, since the files move away
/// from what it was relative to.
Status WriteOutputs(Scene scene, const RunSummary& summary,
                    const std::string& folder);

/// Makes the folder and writes files (name, content) into it, as a FileSet.
Status WriteTextFiles(
    const std::vector<std::pair<std::string, std::string>>& files,
    const std::string& folder);

}  // namespace lowlap
