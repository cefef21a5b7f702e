#include "lowlap/core/internal/file_changes.h"

#include <unistd.h>

#include <cerrno>
#include <set>

namespace lowlap {
namespace {

struct FileChanges {
  std::mutex mutex;
  std::set<std::string> temporary_files;
};

// Never destroyed: threads may still write when the program ends.
FileChanges& Changes() {
  static auto* changes = new FileChanges;
  return *changes;
}

}  // namespace

std::unique_lock<std::mutex> LockFileChanges() {
  return std::unique_lock<std::mutex>(Changes().mutex);
}

void AddTemporaryFile(const std::string& path) {
  Changes().temporary_files.insert(path);
}

void ForgetTemporaryFile(const std::string& path) {
  Changes().temporary_files.erase(path);
}

void EndFileChanges() {
  LockFileChanges().release();
  for (const std::string& path : Changes().temporary_files) {
    ::unlink(path.c_str());
  }
}

bool WriteAll(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace lowlap
