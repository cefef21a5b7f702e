#include "lowlap/core/internal/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/file_changes.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> SystemError(const std::string& what,
                                  const std::string& path, int reason = errno) {
  return MakeError(ErrorCode::kIo,
                   what + ": " + std::generic_category().message(reason), path);
}

int Open(const std::string& path, int flags) {
  constexpr mode_t kMode = 0666;  // less the umask
  int file = -1;
  do {
    file = ::open(path.c_str(), flags | O_CLOEXEC, kMode);
  } while (file < 0 && errno == EINTR);
  return file;
}

/// Where a path leads, and how it is to be written.
struct Target {
  std::string path;
  bool is_direct = false;
};

Result<Target> FollowLinks(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ELOOP) {
      return SystemError("cannot be opened for writing", path);
    }
  } else if (!S_ISREG(status.st_mode)) {
    return Target{path, !S_ISDIR(status.st_mode)};
  }
  fs::path target = path;
  std::error_code error;
  while (fs::is_symlink(target, error)) {
    // /dev/stdout, say: the file that is open, which need not have the name
    // that the link gives.
    if (target.string().rfind("/proc/", 0) == 0) return Target{path, true};
    const fs::path link = fs::read_symlink(target, error);
    if (error) break;
    target = target.parent_path() / link;
  }
  return Target{target.string(), false};
}

/// Locks a file that was opened under `name`; false if another writer has it,
/// or has renamed or removed it.
bool Lock(int file, const std::string& name) {
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) return false;
  struct stat opened {
  }, named{};
  if (::fstat(file, &opened) == 0 && ::stat(name.c_str(), &named) == 0 &&
      opened.st_ino == named.st_ino && opened.st_dev == named.st_dev) {
    return true;
  }
  errno = EWOULDBLOCK;
  return false;
}

constexpr char kTemporary[] = ".tmp";
constexpr char kSecondName[] = ".tmp-old";
constexpr int kMaxWriters = 10000;
// A process may have 1,024 files open as a rule. Of larger sets, the rest is
// closed, and so unlocked, under names that nobody else takes.
constexpr std::size_t kMaxOpen = 256;

/// Removes STARTn, START(n+1), ... as far as nobody has locked them.
void RemoveStale(const std::string& start, int n) {
  for (;; ++n) {
    const std::string name = start + std::to_string(n);
    const int file = Open(name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) return;
    if (Lock(file, name)) ::unlink(name.c_str());
    ::close(file);
  }
}

/// A name that no other writer uses.
std::string UniqueName(const std::string& start) {
  static std::atomic<unsigned> call{0};
  return start + std::to_string(static_cast<long>(::getpid())) + "-" +
         std::to_string(call.fetch_add(1));
}

/// Opens an empty temporary file beside `target`; -1 and errno on failure.
int OpenTemporary(const std::string& target, std::string* name) {
  for (int n = 0; n < kMaxWriters; ++n) {
    *name = target + kTemporary + std::to_string(n);
    const int file = Open(*name, O_WRONLY | O_CREAT | O_NOFOLLOW);
    if (file < 0) {
      const int reason = errno;
      std::error_code ignored;
      // Somebody else's: the next name.
      if (fs::exists(fs::symlink_status(*name, ignored))) continue;
      errno = reason;
      return -1;
    }
    if (Lock(file, *name)) {
      if (::ftruncate(file, 0) == 0) {
        RemoveStale(target + kTemporary, n + 1);
        RemoveStale(target + kSecondName, 0);
        return file;
      }
    }
    const bool is_taken = errno == EWOULDBLOCK;
    ::close(file);
    if (!is_taken) {  // a file system without locks
      *name = UniqueName(target + kTemporary);
      return Open(*name, O_WRONLY | O_CREAT | O_EXCL);
    }
  }
  errno = EBUSY;
  return -1;
}

/// What files replace, by a second name until all of them are in place.
class ReplacedFiles {
 public:
  ~ReplacedFiles() {
    for (const Replaced& file : files_) {
      if (file.second_name) ::unlink(file.second_name->c_str());
      if (file.lock >= 0) ::close(file.lock);
    }
  }

  void Keep(const std::string& target) {
    Replaced file;
    file.target = target;
    const std::string start = target + kSecondName;
    const bool is_locked = files_.size() < kMaxOpen;
    int failed = -1;
    errno = EEXIST;
    for (int n = 0; failed != 0 && errno == EEXIST && n < kMaxWriters; ++n) {
      file.second_name =
          is_locked ? start + std::to_string(n) : UniqueName(start);
      failed = ::link(target.c_str(), file.second_name->c_str());
    }
    if (failed == 0 && is_locked) {
      // So that other writers see that it is in use.
      file.lock = Open(*file.second_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
      if (file.lock >= 0) ::flock(file.lock, LOCK_EX | LOCK_NB);
    } else if (failed != 0) {
      file.was_missing = errno == ENOENT;
      file.second_name.reset();
    }
    files_.push_back(std::move(file));
  }

  /// A file that could not be kept, for lack of links, stays replaced.
  void PutBack() {
    for (const Replaced& file : files_) {
      if (file.was_missing) ::unlink(file.target.c_str());
      if (file.second_name) {
        ::rename(file.second_name->c_str(), file.target.c_str());
      }
    }
  }

 private:
  struct Replaced {
    std::string target;
    std::optional<std::string> second_name;
    int lock = -1;  // the open second name
    bool was_missing = false;
  };
  std::vector<Replaced> files_;
};

}  // namespace

FileSet::~FileSet() {
  const auto lock = LockFileChanges();
  for (const Output& output : outputs_) {
    if (!output.temporary.empty()) {
      ::unlink(output.temporary.c_str());
      ForgetTemporaryFile(output.temporary);
    }
    if (output.file >= 0) ::close(output.file);
  }
}

Status FileSet::Add(const std::string& path, std::string_view content) {
  LOWLAP_ASSIGN_OR_RETURN(const Target& target, FollowLinks(path));
  if (target.is_direct) {
    outputs_.push_back({path, target.path, {}, std::string(content), -1});
    return {};
  }
  std::error_code ignored;
  if (fs::is_directory(target.path, ignored)) {
    return SystemError("cannot be opened for writing", path, EISDIR);
  }
  Output output{path, target.path, {}, {}, -1};
  const bool stays_open = outputs_.size() < kMaxOpen;
  {
    const auto lock = LockFileChanges();
    if (stays_open) {
      output.file = OpenTemporary(target.path, &output.temporary);
    } else {
      output.temporary = UniqueName(target.path + kTemporary);
      output.file = Open(output.temporary, O_WRONLY | O_CREAT | O_EXCL);
    }
    if (output.file < 0) {
      return SystemError("cannot be opened for writing", path);
    }
    AddTemporaryFile(output.temporary);
  }
  outputs_.push_back(std::move(output));
  const int file = outputs_.back().file;
  // Some file systems tell when a file is closed that the disk is full.
  if (!WriteAll(file, content) || ::close(::dup(file)) != 0) {
    return SystemError("cannot be written", path);
  }
  if (!stays_open) ::close(std::exchange(outputs_.back().file, -1));
  return {};
}

Status FileSet::Commit() {
  for (const Output& output : outputs_) {
    if (!output.temporary.empty()) continue;
    const int file = Open(output.target, O_WRONLY | O_APPEND | O_NOCTTY);
    if (file < 0) {
      return SystemError("cannot be opened for writing", output.path);
    }
    const bool is_written = WriteAll(file, output.content);
    const int reason = errno;
    ::close(file);
    if (!is_written) {
      return SystemError("cannot be written", output.path, reason);
    }
  }
  const auto lock = LockFileChanges();
  ReplacedFiles replaced;
  for (Output& output : outputs_) {
    if (output.temporary.empty()) continue;
    if (outputs_.size() > 1) replaced.Keep(output.target);
    if (::rename(output.temporary.c_str(), output.target.c_str()) != 0) {
      const int reason = errno;
      replaced.PutBack();
      return SystemError("cannot be replaced", output.path, reason);
    }
    ForgetTemporaryFile(output.temporary);
    output.temporary.clear();
    if (output.file >= 0) ::close(std::exchange(output.file, -1));
  }
  outputs_.clear();
  return {};
}

Status WriteFileAtomically(const std::string& path, std::string_view content) {
  FileSet files;
  Status status = files.Add(path, content);
  return status ? files.Commit() : status;
}

Result<std::string> ReadWholeFile(const std::string& path) {
  const int file = Open(path, O_RDONLY);
  if (file < 0) {
    if (errno == ENOENT || errno == ENOTDIR) {
      return MakeError(ErrorCode::kNotFound, "no such file", path);
    }
    return SystemError("cannot be opened", path);
  }
  struct stat status {};
  std::string content;
  std::array<char, 1 << 16> buffer;
  ssize_t count = 0;
  // The size is a hint: a pipe has none.
  if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
    content.reserve(static_cast<std::size_t>(status.st_size));
  }
  do {
    count = ::read(file, buffer.data(), buffer.size());
    if (count > 0) {
      content.append(buffer.data(), static_cast<std::size_t>(count));
    }
  } while (count > 0 || (count < 0 && errno == EINTR));
  const int reason = errno;
  ::close(file);
  if (count == 0) return content;
  if (reason == EISDIR) {
    return MakeError(ErrorCode::kIo, "is a folder, not a file", path);
  }
  return SystemError("cannot be read", path, reason);
}

}  // namespace lowlap
