#include "lowlap/core/atomic_file.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace lowlap {
namespace fs = std::filesystem;

Status WriteFileAtomically(const std::string& path,
                           const std::function<Status(std::ostream&)>& write) {
  // Its own for every call: threads may write the same path.
  static std::atomic<unsigned> call{0};
  const std::string temporary = path + ".tmp" +
                                std::to_string(static_cast<long>(::getpid())) +
                                "-" + std::to_string(call.fetch_add(1));
  const auto fail = [&](Error error) -> Status {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    if (error.file.empty()) error.file = path;
    return tl::unexpected<Error>(std::move(error));
  };
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (!stream) {
      return MakeError(ErrorCode::kIo, "cannot be opened for writing", path);
    }
    const Status written = write(stream);
    if (!written) return fail(written.error());
    stream.close();
    if (!stream) return fail({ErrorCode::kIo, "writing failed", path, {}});
  }
  std::error_code error;
  fs::rename(temporary, path, error);
  if (error) return fail({ErrorCode::kIo, error.message(), path, {}});
  return {};
}

Result<std::string> ReadWholeFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    return MakeError(ErrorCode::kNotFound, "no such file", path);
  }
  if (fs::is_directory(status)) {
    return MakeError(ErrorCode::kIo, "is a folder, not a file", path);
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return MakeError(ErrorCode::kIo, "cannot be opened", path);
  // The size is a hint: a pipe has none.
  std::string content;
  const std::uintmax_t size_hint = fs::file_size(path, error);
  if (!error) content.reserve(size_hint);
  std::array<char, 1 << 16> buffer;
  do {
    stream.read(buffer.data(), buffer.size());
    content.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
  } while (stream);
  if (stream.bad()) return MakeError(ErrorCode::kIo, "cannot be read", path);
  return content;
}

}  // namespace lowlap
