#include "third_party_adapters/openmvg/matches.h"

#include <utility>

#include "lowlap/core/atomic_file.h"
#include "third_party_adapters/openmvg/internal/archive_reader.h"
#include "third_party_adapters/openmvg/internal/text_reader.h"

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
  return "view " + std::to_string(view) + " is matched with itself";
}

void Insert(ViewPair pair, std::vector<FeatureMatch> matches,
            PairMatches& result) {
  if (pair.first > pair.second) {
    std::swap(pair.first, pair.second);
    for (FeatureMatch& match : matches) std::swap(match.first, match.second);
  }
  result[pair] = std::move(matches);
}

/// Unsigned numbers separated by any white space, as OpenMVG reads them.
class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : lines_(text) {}

  bool AtEnd() {
    while (token_.empty()) {
      token_ = internal::TakeToken(line_);
      if (token_.empty() && !lines_.Next(line_)) return true;
    }
    return false;
  }
  template <class T>
  bool Take(T& value) {
    if (AtEnd() || !internal::ParseNumber(token_, value)) return false;
    token_ = {};
    return true;
  }
  /// What was found where Take() failed, and where.
  tl::unexpected<Error> Failure(const std::string& expected,
                                const std::string& file) {
    const std::string found =
        AtEnd() ? "the end of the file"
                : "'" + std::string(token_.substr(0, 32)) + "'";
    return MakeError(ErrorCode::kParse, expected + " expected, not " + found,
                     file, lines_.Place());
  }
  std::string Place() const { return lines_.Place(); }

 private:
  internal::LineReader lines_;
  std::string_view line_;
  std::string_view token_;
};

}  // namespace

Result<PairMatches> ParseMatchesText(std::string_view text,
                                     const std::string& file) {
  PairMatches result;
  NumberReader numbers(text);
  while (!numbers.AtEnd()) {
    ViewPair pair;
    if (!numbers.Take(pair.first) || !numbers.Take(pair.second)) {
      return numbers.Failure("a view id", file);
    }
    if (pair.first == pair.second) {
      return MakeError(ErrorCode::kParse, SelfPairMessage(pair.first), file,
                       numbers.Place());
    }
    std::size_t count = 0;
    if (!numbers.Take(count)) {
      return numbers.Failure("a number of matches", file);
    }
    // Each match takes four characters, which bounds what is reserved.
    if (count > text.size() / 4 + 1) {
      return MakeError(ErrorCode::kParse,
                       std::to_string(count) +
                           " matches do not fit into the rest of the file",
                       file, numbers.Place());
    }
    std::vector<FeatureMatch> matches(count);
    for (FeatureMatch& match : matches) {
      if (!numbers.Take(match.first) || !numbers.Take(match.second)) {
        return numbers.Failure("a feature index", file);
      }
    }
    Insert(pair, std::move(matches), result);
  }
  return result;
}

Result<PairMatches> ParseMatchesBin(std::string_view bytes,
                                    const std::string& file) {
  PairMatches result;
  internal::ArchiveReader in(bytes, file);
  const std::size_t num_pairs = in.Count(16);
  for (std::size_t n = 0; n < num_pairs && in.ok(); ++n) {
    const std::size_t place = in.offset();
    const ViewId first = in.U32();
    const ViewId second = in.U32();
    if (in.ok() && first == second) in.FailAt(place, SelfPairMessage(first));
    std::vector<FeatureMatch> matches(in.Count(8));
    for (FeatureMatch& match : matches) {
      match.first = in.U32();
      match.second = in.U32();
    }
    Insert({first, second}, std::move(matches), result);
  }
  if (!in.ok()) return in.Failure();
  return result;
}

Result<PairMatches> ReadMatches(const std::string& path) {
  const bool is_text = EndsWith(path, ".txt");
  if (!is_text && !EndsWith(path, ".bin")) return UnknownExtension(path);
  const Result<std::string> content = ReadWholeFile(path);
  if (!content) return tl::unexpected<Error>(content.error());
  return is_text ? ParseMatchesText(*content, path)
                 : ParseMatchesBin(*content, path);
}

}  // namespace lowlap::openmvg
