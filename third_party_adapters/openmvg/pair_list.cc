#include <algorithm>
#include <ostream>

#include "lowlap/core/atomic_file.h"
#include "third_party_adapters/openmvg/internal/text_reader.h"
#include "third_party_adapters/openmvg/matches.h"

namespace lowlap::openmvg {

Result<std::vector<ViewPair>> ParsePairList(std::string_view text,
                                            const std::string& file) {
  std::vector<ViewPair> pairs;
  internal::LineReader lines(text);
  std::string_view line;
  while (lines.Next(line)) {
    std::vector<ViewId> ids;
    for (std::string_view token = internal::TakeToken(line); !token.empty();
         token = internal::TakeToken(line)) {
      ViewId id = 0;
      if (!internal::ParseNumber(token, id)) {
        return MakeError(
            ErrorCode::kParse,
            "'" + std::string(token.substr(0, 32)) + "' is not a view id", file,
            lines.Place());
      }
      ids.push_back(id);
    }
    if (ids.size() < 2) {
      return MakeError(ErrorCode::kParse,
                       "a line of a pair list names two views or more", file,
                       lines.Place());
    }
    for (std::size_t n = 1; n < ids.size(); ++n) {
      if (ids[n] == ids[0]) {
        return MakeError(
            ErrorCode::kParse,
            "view " + std::to_string(ids[0]) + " is paired with itself", file,
            lines.Place());
      }
      pairs.push_back({std::min(ids[0], ids[n]), std::max(ids[0], ids[n])});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Result<std::vector<ViewPair>> ReadPairList(const std::string& path) {
  const Result<std::string> text = ReadWholeFile(path);
  if (!text) return tl::unexpected<Error>(text.error());
  return ParsePairList(*text, path);
}

Status WritePairList(const std::vector<ViewPair>& pairs,
                     const std::string& path) {
  return WriteFileAtomically(path, [&pairs](std::ostream& stream) -> Status {
    for (const ViewPair& pair : pairs) {
      stream << pair.first << ' ' << pair.second << '\n';
    }
    return {};
  });
}

}  // namespace lowlap::openmvg
