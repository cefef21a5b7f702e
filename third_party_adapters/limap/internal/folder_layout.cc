#include "third_party_adapters/limap/internal/folder_layout.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/token_reader.h"

namespace lowlap::limap {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> EntriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace

bool IsLimapFolder(const std::string& path) {
  std::error_code ignored;
  const fs::path folder(path);
  return fs::is_regular_file(folder / kImageList, ignored) ||
         fs::is_directory(folder / "line_detections", ignored) ||
         fs::is_directory(folder / kTrackFolder, ignored);
}

std::map<std::uint32_t, std::string> NumberedFiles(
    const std::string& folder, const std::string& prefix,
    const std::string& extension) {
  std::map<std::uint32_t, std::string> files;
  for (const fs::path& path : EntriesOf(folder)) {
    const std::string stem = path.stem().string();
    if (path.extension() != extension || stem.rfind(prefix, 0) != 0) continue;
    const std::string number = stem.substr(prefix.size());
    TokenReader reader(number, {});
    const auto value = reader.Next<std::uint32_t>("a number");
    if (reader.status() && reader.AtEnd()) files[value] = path.string();
  }
  return files;
}

Result<std::string> OnlyFolderBelow(const std::string& folder, int depth) {
  if (depth == 0) return folder;
  std::vector<std::string> folders;
  std::error_code ignored;
  for (const fs::path& path : EntriesOf(folder)) {
    if (fs::is_directory(path, ignored)) folders.push_back(path.string());
  }
  if (folders.empty()) return std::string();
  if (folders.size() == 1) return OnlyFolderBelow(folders.front(), depth - 1);
  return MakeError(ErrorCode::kUnsupported,
                   "holds results of several programs (" +
                       fs::path(folders[0]).filename().string() + ", " +
                       fs::path(folders[1]).filename().string() +
                       ", ...); leave one",
                   folder);
}

}  // namespace lowlap::limap
