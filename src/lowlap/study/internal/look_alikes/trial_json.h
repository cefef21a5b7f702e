#pragma once

#include <string>

#include "lowlap/study/internal/look_alikes/study.h"

namespace lowlap {

/// A record of a ResultLog.
std::string ToJsonLine(const LookAlikeKey& key, const LookAlikeTrial& trial);
/// The inverse: adds the trial; false, and nothing is added, for anything else.
bool AddJsonLine(const std::string& line, LookAlikeStudy* study);

}  // namespace lowlap
