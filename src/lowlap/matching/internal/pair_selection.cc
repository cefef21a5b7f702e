#include "lowlap/matching/internal/pair_selection.h"

#include <algorithm>
#include <charconv>
#include <iomanip>
#include <optional>
#include <sstream>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/scene/internal/view_names.h"

namespace lowlap {
namespace {

template <class T>
std::optional<T> ParseNumber(const std::string& text) {
  T value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

void SortAndDeduplicate(std::vector<ViewPair>* pairs) {
  std::sort(pairs->begin(), pairs->end());
  pairs->erase(std::unique(pairs->begin(), pairs->end()), pairs->end());
}

ViewPair Ordered(ViewId a, ViewId b) {
  return a < b ? ViewPair{a, b} : ViewPair{b, a};
}

// Views at most `reach` places apart in the order of their ids.
std::vector<ViewPair> WindowPairs(const std::vector<ViewId>& ids,
                                  std::size_t reach) {
  std::vector<ViewPair> pairs;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = i + 1; j < ids.size() && j - i <= reach; ++j) {
      pairs.push_back({ids[i], ids[j]});
    }
  }
  return pairs;
}

// Splits at blanks; double quotes hold a word together. nullopt: a quote that
// is not closed.
std::optional<std::vector<std::string>> SplitWords(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  while (!(stream >> std::ws).eof()) {
    constexpr char kNoEscape = '\0';
    std::string word;
    if (!(stream >> std::quoted(word, '"', kNoEscape))) return std::nullopt;
    words.push_back(std::move(word));
  }
  return words;
}

}  // namespace

Result<std::vector<ViewPair>> ParsePairs(const Scene& scene,
                                         const std::string& text,
                                         const std::string& file) {
  const ViewNames names(scene);
  std::vector<ViewPair> pairs;
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const auto fail = [&](const std::string& message) {
      return MakeError(ErrorCode::kParse, message, file,
                       "line " + std::to_string(number));
    };
    const std::size_t start = line.find_first_not_of(" \t\r\v\f");
    if (start == std::string::npos || line[start] == '#') continue;
    const auto words = SplitWords(line);
    if (!words) return fail("a quote is not closed");
    if (words->size() != 2) {
      return fail("expected two views, found " + std::to_string(words->size()) +
                  " words");
    }
    const Result<ViewId> a = names.Find((*words)[0]);
    if (!a) return fail(a.error().message);
    const Result<ViewId> b = names.Find((*words)[1]);
    if (!b) return fail(b.error().message);
    if (*a == *b) return fail("a view cannot be paired with itself");
    pairs.push_back(Ordered(*a, *b));
  }
  if (pairs.empty()) {
    return MakeError(ErrorCode::kParse, "names no pair of views", file);
  }
  SortAndDeduplicate(&pairs);
  return pairs;
}

Result<std::vector<ViewPair>> SelectViewPairs(
    const Scene& scene, const std::string& specification) {
  std::vector<ViewId> ids;
  for (const auto& [id, view] : scene.views) ids.push_back(id);

  if (specification == "all") return WindowPairs(ids, ids.size());
  if (specification == "chain") return WindowPairs(ids, 1);
  if (specification == "cycle") {
    std::vector<ViewPair> pairs = WindowPairs(ids, 1);
    if (ids.size() > 2) pairs.push_back({ids.front(), ids.back()});
    SortAndDeduplicate(&pairs);
    return pairs;
  }
  const std::string window = "window:";
  if (specification.compare(0, window.size(), window) == 0) {
    const auto reach =
        ParseNumber<std::uint32_t>(specification.substr(window.size()));
    if (!reach || *reach == 0) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "the window of \"" + specification +
                           "\" must be a number of at least 1");
    }
    return WindowPairs(ids, *reach);
  }
  if (specification == "auto") {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the pairs of \"auto\" are known only once photographs "
                     "have features");
  }
  const Result<std::string> text = ReadWholeFile(specification);
  if (!text) {
    Error error = text.error();
    if (error.code == ErrorCode::kNotFound) {
      error.message =
          "pairs are all, chain, cycle, window:N, auto (where photographs are "
          "matched) or a file of pairs; there is no such file";
    }
    return tl::unexpected<Error>(std::move(error));
  }
  return ParsePairs(scene, *text, specification);
}

}  // namespace lowlap
