#include "lowlap/scene/internal/view_names.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "lowlap/core/internal/joined.h"

namespace lowlap {
namespace {

bool IsNumber(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

std::string WithoutLeadingZeros(const std::string& number) {
  const std::size_t first = number.find_first_not_of('0');
  return first == std::string::npos ? "0" : number.substr(first);
}

// As many as a person reads.
template <class TextOf>
std::string FirstOf(const std::vector<ViewId>& views, const TextOf& text_of) {
  constexpr std::size_t kMost = 4;
  const std::vector<ViewId> first(
      views.begin(), views.begin() + static_cast<std::ptrdiff_t>(
                                         std::min(views.size(), kMost)));
  return Joined(first, ", ", text_of) + (views.size() > kMost ? ", ..." : "");
}

}  // namespace

ViewNames::ViewNames(const Scene& scene) {
  Index below_root, whole, last_part, stem, number, id_text;
  bool all_numbers = !scene.views.empty();
  for (const auto& [id, view] : scene.views) {
    whole_names_[id] = view.PathBelowRoot();
    const std::filesystem::path path(view.filename);
    below_root[view.PathBelowRoot()].push_back(id);
    whole[view.filename].push_back(id);
    last_part[path.filename().string()].push_back(id);
    stem[path.stem().string()].push_back(id);
    number[WithoutLeadingZeros(path.stem().string())].push_back(id);
    id_text[std::to_string(id.value())].push_back(id);
    all_numbers = all_numbers && IsNumber(path.stem().string());
  }
  indices_ = {std::move(below_root), std::move(whole), std::move(last_part),
              std::move(stem), std::move(all_numbers ? number : id_text)};
}

Result<ViewId> ViewNames::Find(const std::string& word) const {
  for (const Index& index : indices_) {
    const auto found = index.find(word);
    if (found == index.end()) continue;
    const std::vector<ViewId>& views = found->second;
    if (views.size() == 1) return views.front();
    const bool is_whole = whole_names_.at(views.front()) == word;
    return MakeError(
        ErrorCode::kInvalidArgument,
        "several views are named \"" + word + "\": " +
            (is_whole ? "nothing tells them apart but their ids, " +
                            FirstOf(views,
                                    [](ViewId id) {
                                      return std::to_string(id.value());
                                    })
                      : FirstOf(views, [&](ViewId id) {
                          return whole_names_.at(id);
                        }) + "; use one of these names"));
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "no view has the file name or the id \"" + word + "\"");
}

}  // namespace lowlap
