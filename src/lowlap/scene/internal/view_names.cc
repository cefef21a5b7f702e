#include "lowlap/scene/internal/view_names.h"

#include <algorithm>
#include <filesystem>
#include <utility>

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

}  // namespace

ViewNames::ViewNames(const Scene& scene) {
  Index below_root, whole, last_part, stem, number, id_text;
  bool all_numbers = !scene.views.empty();
  for (const auto& [id, view] : scene.views) {
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
    if (found->second.size() == 1) return found->second.front();
    return MakeError(
        ErrorCode::kInvalidArgument,
        "several views are named \"" + word + "\"; use their whole names");
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "no view has the file name or the id \"" + word + "\"");
}

}  // namespace lowlap
