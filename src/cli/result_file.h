#pragma once

#include <string>

#include "lowlap/core/result.h"

namespace lowlap::cli {

/// A table on disk that grows: every line is appended by one write and flushed
/// to the disk, so that a run that is killed loses what it had not finished.
class ResultFile {
 public:
  explicit ResultFile(std::string path) : path_(std::move(path)) {}
  ~ResultFile();
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;

  /// kIo unless the file exists and can be written to.
  Status Open();
  Status Append(const std::string& line) const;

 private:
  Status Failure(const std::string& what) const;

  std::string path_;
  int file_ = -1;
};

/// Prepares a folder for a table that an earlier run with the same `settings`
/// may have begun: returns the table's text, empty if there is none.
/// kInvalidArgument if it was begun with other settings (settings.txt).
Result<std::string> TakeUpTable(const std::string& folder,
                                const std::string& table_name,
                                const std::string& settings);

}  // namespace lowlap::cli
