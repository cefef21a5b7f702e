#pragma once

#include <optional>
#include <string>
#include <utility>

#include "lowlap/core/internal/hash.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// Results of earlier runs in a folder, one file each, found by a hash of
/// everything that they depend on.
///
/// An entry appears whole (WriteFileAtomically), and says its kind, key, size
/// and checksum: one that is truncated, damaged or of another format is never
/// returned. The functions may be called from several threads and processes.
class CacheFolder {
 public:
  /// Makes the folder. Temporary files that a killed run left an hour ago or
  /// more are removed. kIo if the folder cannot be made.
  static Result<CacheFolder> Open(const std::string& folder);

  /// The bytes of an entry, nullopt if there is none, kParse if it is damaged
  /// (the caller computes it anew and writes it again), kIo.
  Result<std::optional<std::string>> Read(const std::string& kind,
                                          const Hash128::Value& key) const;

  Status Write(const std::string& kind, const Hash128::Value& key,
               const std::string& bytes) const;

  /// Removes entries, those that were read or written longest ago first, until
  /// at most `max_bytes` are left. Entries of the last hour are spared.
  void Prune(double max_bytes) const;

  const std::string& path() const { return path_; }

 private:
  explicit CacheFolder(std::string path) : path_(std::move(path)) {}
  std::string EntryPath(const std::string& kind,
                        const Hash128::Value& key) const;

  std::string path_;
};

}  // namespace lowlap
