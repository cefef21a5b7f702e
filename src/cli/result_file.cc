#include "cli/result_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "lowlap/core/atomic_file.h"
#include "lowlap/pipeline/output_folder.h"

namespace lowlap::cli {

ResultFile::~ResultFile() {
  if (file_ >= 0) ::close(file_);
}

Status ResultFile::Open() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  return file_ >= 0 ? Status() : Failure("cannot be opened");
}

Status ResultFile::Append(const std::string& line) const {
  const ssize_t written = ::write(file_, line.data(), line.size());
  const bool whole = written == static_cast<ssize_t>(line.size());
  return whole && ::fdatasync(file_) == 0 ? Status()
                                          : Failure("cannot be written to");
}

Status ResultFile::Failure(const std::string& what) const {
  return MakeError(ErrorCode::kIo,
                   what + ": " + std::generic_category().message(errno), path_);
}

Result<std::string> TakeUpTable(const std::string& folder,
                                const std::string& table_name,
                                const std::string& settings) {
  namespace fs = std::filesystem;
  const std::string settings_path =
      (fs::path(folder) / "settings.txt").string();
  const std::string table_path = (fs::path(folder) / table_name).string();
  if (const Status made = PrepareOutputFolder(folder); !made) {
    return tl::unexpected<Error>(made.error());
  }
  std::error_code ignored;
  if (fs::exists(table_path, ignored)) {
    const auto before = ReadWholeFile(settings_path);
    if (!before || *before != settings) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "holds results of another scene or of other options; "
                       "take another folder, or remove them",
                       folder);
    }
    return ReadWholeFile(table_path);
  }
  const Status written = WriteFileAtomically(settings_path, settings);
  if (!written) return tl::unexpected<Error>(written.error());
  return std::string();
}

}  // namespace lowlap::cli
