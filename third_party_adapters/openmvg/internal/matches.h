#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"

namespace lowlap::openmvg {

/// Point matches of pairs of views, in file order; pairs have first < second.
using PairMatches = std::map<ViewPair, std::vector<FeatureMatch>>;

/// A `matches.*.txt` or `matches.*.bin` file, told apart by the extension.
/// Pairs are (view id, view id), indices are lines of the .feat files. A pair
/// stored with its larger id first is turned round; of a pair that occurs
/// twice the last one counts. Errors: kParse with the line or byte offset,
/// kUnsupported for another extension.
Result<PairMatches> ReadMatches(const std::string& path);
Result<PairMatches> ParseMatchesText(std::string_view text,
                                     const std::string& file = {});
Result<PairMatches> ParseMatchesBin(std::string_view bytes,
                                    const std::string& file = {});

}  // namespace lowlap::openmvg
