#pragma once

#include <string>

#include "lowlap/study/internal/trust/study.h"

namespace lowlap {

/// A record of a ResultLog.
std::string ToJsonLine(const TrustKey& key, const TrustTrial& trial);
/// The inverse: adds the trial; false, and nothing is added, for anything else.
bool AddJsonLine(const std::string& line, TrustStudy* study);

/// One record per camera: family, seed, labels, failure, view, grade, reasons,
/// error and deviation (empty if not known).
std::string CamerasCsv(const TrustStudy& study);

}  // namespace lowlap
