#include "third_party_adapters/openmvg/internal/matches.h"

#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/token_reader.h"
#include "third_party_adapters/openmvg/internal/archive_reader.h"

namespace lowlap::openmvg {
namespace {

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}

tl::unexpected<Error> UnknownExtension(const std::string& path) {
  return MakeError(ErrorCode::kUnsupported, "a match file ends in .txt or .bin",
                   path);
}

std::string SelfPairMessage(ViewId view) {
  return "view " + std::to_string(view.value()) + " is matched with itself";
}

void Insert(ViewPair pair, std::vector<FeatureMatch> matches,
            PairMatches& result) {
  if (pair.first > pair.second) {
    std::swap(pair.first, pair.second);
    for (FeatureMatch& match : matches) std::swap(match.first, match.second);
  }
  result[pair] = std::move(matches);
}

}  // namespace

Result<PairMatches> ParseMatchesText(std::string_view text,
                                     const std::string& file) {
  PairMatches result;
  TokenReader reader(text, file);
  while (reader.status() && !reader.AtEnd()) {
    ViewPair pair;
    pair.first = reader.Next<std::uint32_t>("a view id");
    pair.second = reader.Next<std::uint32_t>("a view id");
    if (pair.first == pair.second) reader.Fail(SelfPairMessage(pair.first));
    const auto count = reader.Next<std::size_t>("a number of matches");
    // Each match takes four characters, which bounds what is reserved.
    if (count > text.size() / 4 + 1) {
      reader.Fail(std::to_string(count) +
                  " matches do not fit into the rest of the file");
    }
    if (!reader.status()) break;
    std::vector<FeatureMatch> matches(count);
    for (FeatureMatch& match : matches) {
      match.first = reader.Next<FeatureIndex>("a feature index");
      match.second = reader.Next<FeatureIndex>("a feature index");
    }
    Insert(pair, std::move(matches), result);
  }
  if (!reader.status()) return reader.error();
  return result;
}

Result<PairMatches> ParseMatchesBin(std::string_view bytes,
                                    const std::string& file) {
  return Caught([&] {
    PairMatches result;
    ArchiveReader in(bytes, file);
    const std::size_t num_pairs = in.Count(16);
    for (std::size_t n = 0; n < num_pairs; ++n) {
      const std::size_t place = in.offset();
      const ViewId first = in.U32();
      const ViewId second = in.U32();
      if (first == second) in.FailAt(place, SelfPairMessage(first));
      std::vector<FeatureMatch> matches(in.Count(8));
      for (FeatureMatch& match : matches) {
        match.first = in.U32();
        match.second = in.U32();
      }
      Insert({first, second}, std::move(matches), result);
    }
    return result;
  });
}

Result<PairMatches> ReadMatches(const std::string& path) {
  const bool is_text = EndsWith(path, ".txt");
  if (!is_text && !EndsWith(path, ".bin")) return UnknownExtension(path);
  LOWLAP_ASSIGN_OR_RETURN(const std::string content, ReadWholeFile(path));
  return is_text ? ParseMatchesText(content, path)
                 : ParseMatchesBin(content, path);
}

}  // namespace lowlap::openmvg
