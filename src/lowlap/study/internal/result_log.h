#pragma once

#include <functional>
#include <string>

#include "lowlap/core/result.h"

namespace lowlap {

/// A file of JSON lines that grows: what a study has found so far. Every record
/// is appended by one write and flushed to the disk, so that a study that is
/// stopped or killed goes on from all that it had finished.
class ResultLog {
 public:
  /// Begins the file, or goes on with that of an earlier study. `settings` is
  /// what the records depend on; the first line holds it. `take` is given each
  /// record there is and says whether it is one. A last line without an end, as
  /// a killed study may leave it, is dropped. Errors: kInvalidArgument for a
  /// file of other settings, kParse with the line for what is no record, kIo.
  static Result<ResultLog> Open(
      const std::string& path, const std::string& settings,
      const std::function<bool(const std::string& record)>& take);

  ResultLog(ResultLog&& other) noexcept;
  ResultLog& operator=(ResultLog&&) = delete;
  ~ResultLog();

  /// A JSON value on one line, without its end.
  Status Append(const std::string& record) const;

 private:
  ResultLog(std::string path, int file);

  std::string path_;
  int file_;
};

}  // namespace lowlap
