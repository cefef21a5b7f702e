#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap {

/// Files that are written together: each appears whole or not at all, and none
/// of them before all are prepared. If one cannot take its name all the same,
/// those that have are taken back, and what they replaced is back in its place
/// (where the file system has hard links).
///
/// A file is prepared under a temporary name in its folder (NAME.tmp0), which
/// is locked while the writer lives (those beyond the first hundreds have names
/// of their own instead), and then renamed; what it replaces has a second name
/// (NAME.tmp-old0) meanwhile. What a killed writer left is taken over or
/// removed by the next one; names of their own stay. A symbolic link stays, and
/// the file that it names is written. Devices and pipes are written to, all of
/// them before the first file appears. Errors are kIo with the path and the
/// system's reason.
class FileSet {
 public:
  FileSet() = default;
  /// Removes what was prepared and not committed.
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  Status Add(const std::string& path, std::string_view content);
  Status Commit();

 private:
  struct Output {
    std::string path;
    std::string target;     // `path` with its links followed
    std::string temporary;  // empty: written to directly, or in place
    std::string content;    // of what is written to directly
    int file = -1;          // closed: -1
  };
  std::vector<Output> outputs_;
};

/// A set of one.
Status WriteFileAtomically(const std::string& path, std::string_view content);

/// The whole file as bytes; kNotFound or kIo with the path otherwise.
Result<std::string> ReadWholeFile(const std::string& path);

}  // namespace lowlap
