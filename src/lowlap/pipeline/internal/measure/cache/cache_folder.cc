#include "lowlap/pipeline/internal/measure/cache/cache_folder.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;

constexpr char kMagic[] = "lowlap cache 2\n";
constexpr char kExtension[] = ".entry";
constexpr std::chrono::hours kRecent{1};

// What stands before the bytes of an entry. Numbers are in the machine's own
// order: on another kind of machine the header does not fit and the entry is
// computed anew.
std::string Header(const std::string& kind, const Hash128::Value& key,
                   const std::string& bytes) {
  Hash128 checksum;
  checksum.AddBytes(bytes);
  const Hash128::Value sum = checksum.value();
  const std::uint64_t numbers[] = {key.high, key.low, bytes.size(), sum.high,
                                   sum.low};
  std::string header = kMagic + kind + '\n';
  header.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
  return header;
}

bool IsOld(const fs::path& file) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - time > kRecent;
}

// Of a file that was written atomically and whose writer was killed.
bool IsTemporary(const fs::path& file) {
  return file.filename().string().find(std::string(kExtension) + ".tmp") !=
         std::string::npos;
}

}  // namespace

Result<CacheFolder> CacheFolder::Open(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return MakeError(
        ErrorCode::kIo,
        "cannot be made a folder for the cache: " + error.message(), folder);
  }
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (IsTemporary(entry->path()) && IsOld(entry->path())) {
      leftovers.push_back(entry->path());
    }
  }
  for (const fs::path& file : leftovers) fs::remove(file, error);
  return CacheFolder(folder);
}

std::string CacheFolder::EntryPath(const std::string& kind,
                                   const Hash128::Value& key) const {
  return (fs::path(path_) / (kind + '-' + ToHex(key) + kExtension)).string();
}

Result<std::optional<std::string>> CacheFolder::Read(
    const std::string& kind, const Hash128::Value& key) const {
  const std::string path = EntryPath(kind, key);
  Result<std::string> file = ReadWholeFile(path);
  if (!file) {
    if (file.error().code == ErrorCode::kNotFound) {
      return std::optional<std::string>();
    }
    return tl::unexpected<Error>(file.error());
  }
  const std::size_t header_size = Header(kind, key, "").size();
  if (file->size() < header_size) {
    return MakeError(ErrorCode::kParse, "the entry is truncated", path);
  }
  std::string bytes = file->substr(header_size);
  if (file->compare(0, header_size, Header(kind, key, bytes)) != 0) {
    return MakeError(ErrorCode::kParse, "the entry is damaged", path);
  }
  std::error_code ignored;  // the time of the last use, for Prune
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
  return std::optional<std::string>(std::move(bytes));
}

Status CacheFolder::Write(const std::string& kind, const Hash128::Value& key,
                          const std::string& bytes) const {
  return WriteFileAtomically(EntryPath(kind, key),
                             Header(kind, key, bytes) + bytes);
}

void CacheFolder::Prune(double max_bytes) const {
  struct File {
    fs::file_time_type time;
    fs::path path;
    double size;
  };
  std::vector<File> files;
  double total = 0;
  std::error_code error;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code unreadable;
    const auto size = entry->file_size(unreadable);
    const auto time = entry->last_write_time(unreadable);
    if (unreadable || entry->path().extension() != kExtension) continue;
    files.push_back({time, entry->path(), static_cast<double>(size)});
    total += files.back().size;
  }
  std::sort(files.begin(), files.end(),
            [](const File& a, const File& b) { return a.time < b.time; });
  for (const File& file : files) {
    if (total <= max_bytes || !IsOld(file.path)) return;
    if (fs::remove(file.path, error)) total -= file.size;
  }
}

}  // namespace lowlap
