#include "lowlap/study/internal/result_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/file_changes.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

Status SystemError(const std::string& what, const std::string& path) {
  return MakeError(ErrorCode::kIo,
                   what + ": " + std::generic_category().message(errno), path);
}

}  // namespace

ResultLog::ResultLog(std::string path, int file)
    : path_(std::move(path)), file_(file) {}

ResultLog::ResultLog(ResultLog&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

ResultLog::~ResultLog() {
  if (file_ >= 0) ::close(file_);
}

Result<ResultLog> ResultLog::Open(
    const std::string& path, const std::string& settings,
    const std::function<bool(const std::string&)>& take) {
  const std::string head =
      nlohmann::json::object({{"settings", settings}})
          .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
      "\n";
  Result<std::string> text = ReadWholeFile(path);
  if (!text && text.error().code != ErrorCode::kNotFound) {
    return tl::unexpected<Error>(text.error());
  }
  std::string known = text.value_or("");
  known.resize(known.find_last_of('\n') + 1);  // to 0 without any
  if (known.empty()) known = head;
  if (known.compare(0, head.size(), head) != 0) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "holds results of another scene or of other options; "
                     "take another folder, or remove it",
                     path);
  }
  std::size_t line = 1;
  for (std::size_t at = head.size(); at < known.size();) {
    const std::size_t end = known.find('\n', at);
    ++line;
    if (!take(known.substr(at, end - at))) {
      return MakeError(ErrorCode::kParse, "is no result of this study", path,
                       "line " + std::to_string(line));
    }
    at = end + 1;
  }
  LOWLAP_RETURN_IF_ERROR(WriteFileAtomically(path, known));
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file < 0) {
    return tl::unexpected<Error>(
        SystemError("cannot be opened for writing", path).error());
  }
  return ResultLog(path, file);
}

Status ResultLog::Append(const std::string& record) const {
  const std::string line = record + "\n";
  const ::off_t end = ::lseek(file_, 0, SEEK_END);
  if (WriteAll(file_, line) && ::fdatasync(file_) == 0) return {};
  const Status error = SystemError("cannot be written", path_);
  // Without the half of a line; if that fails, too, the next study drops it.
  [[maybe_unused]] const int ignored = ::ftruncate(file_, end);
  return error;
}

}  // namespace lowlap
