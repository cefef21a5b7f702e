// Preloaded into a program, makes calls that change the file system fail:
//   FAULTY_CALLS   which are counted: open,write,mkdir,sync,rename,link
//   FAULTY_FIRST   the first one that fails, from 1 on; 0: none
//   FAULTY_LAST    the last one; those after it work again
//   FAULTY_ERROR   their errno, or "kill": the program is killed before it
//   FAULTY_COUNT   a file that gets the number of calls when the program ends
// A write that fails first writes half, as on a disk that gets full. Standard
// output and error, pipes and devices are spared.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<int> num_calls{0};

const char* Setting(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : value;
}

bool IsCounted(const char* call) {
  static const char* calls = Setting("FAULTY_CALLS", "");
  return std::strstr(calls, call) != nullptr;
}

enum class Fate { kWorks, kFailsFirst, kFails };

Fate FateOf(const char* call) {
  static const int first = std::atoi(Setting("FAULTY_FIRST", "0"));
  static const int last = std::atoi(Setting("FAULTY_LAST", "2147483647"));
  static const char* error = Setting("FAULTY_ERROR", "28");
  if (!IsCounted(call)) return Fate::kWorks;
  const int n = ++num_calls;
  if (first == 0 || n < first || n > last) return Fate::kWorks;
  if (std::strcmp(error, "kill") == 0) ::raise(SIGKILL);
  errno = std::atoi(error);
  return n == first ? Fate::kFailsFirst : Fate::kFails;
}

bool IsFile(int file) {
  struct stat status {};
  return file > STDERR_FILENO && ::fstat(file, &status) == 0 &&
         S_ISREG(status.st_mode);
}

template <class Function>
Function* Real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

struct Count {
  ~Count() {
    const char* path = std::getenv("FAULTY_COUNT");
    if (path == nullptr) return;
    if (std::FILE* file = std::fopen(path, "w")) {
      std::fprintf(file, "%d\n", num_calls.load());
      std::fclose(file);
    }
  }
} count_at_end;

int OpenFile(const char* name, const char* path, int flags, mode_t mode) {
  const bool creates = (flags & O_CREAT) != 0 && ::access(path, F_OK) != 0;
  if (creates && FateOf("open") != Fate::kWorks) return -1;
  return Real<int(const char*, int, ...)>(name)(path, flags, mode);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return OpenFile("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return OpenFile("open64", path, flags, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
  static const auto real = Real<ssize_t(int, const void*, size_t)>("write");
  const Fate fate = IsFile(file) ? FateOf("write") : Fate::kWorks;
  if (fate == Fate::kWorks) return real(file, bytes, size);
  return fate == Fate::kFailsFirst && size > 1 ? real(file, bytes, size / 2)
                                               : -1;
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  static const auto real =
      Real<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  const Fate fate = IsFile(file) ? FateOf("write") : Fate::kWorks;
  if (fate == Fate::kWorks) return real(file, bytes, size, at);
  return fate == Fate::kFailsFirst && size > 1 ? real(file, bytes, size / 2, at)
                                               : -1;
}

int fsync(int file) {
  return FateOf("sync") == Fate::kWorks ? Real<int(int)>("fsync")(file) : -1;
}

int fdatasync(int file) {
  return FateOf("sync") == Fate::kWorks ? Real<int(int)>("fdatasync")(file)
                                        : -1;
}

int mkdir(const char* path, mode_t mode) noexcept {
  if (::access(path, F_OK) != 0 && FateOf("mkdir") != Fate::kWorks) return -1;
  return Real<int(const char*, mode_t)>("mkdir")(path, mode);
}

int rename(const char* from, const char* to) noexcept {
  return FateOf("rename") == Fate::kWorks
             ? Real<int(const char*, const char*)>("rename")(from, to)
             : -1;
}

int link(const char* from, const char* to) noexcept {
  return FateOf("link") == Fate::kWorks
             ? Real<int(const char*, const char*)>("link")(from, to)
             : -1;
}

}  // extern "C"
