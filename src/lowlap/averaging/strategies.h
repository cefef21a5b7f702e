#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// The names of the built-in strategies; the first is the default.
std::vector<std::string> TranslationAveragerNames();

/// A strategy by name, or behind the edge filter of OneDSfmAverager:
/// `1dsfm+NAME`. kInvalidArgument lists the known ones otherwise.
Result<std::unique_ptr<TranslationAverager>> MakeTranslationAverager(
    const std::string& name);

}  // namespace lowlap
