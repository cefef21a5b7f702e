#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "lowlap/core/internal/hash.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/internal/measure/cache/cache_folder.h"

namespace lowlap {

/// One kind of a cache folder's entries, for several threads. Its troubles are
/// warnings.
class MeasurementCache {
 public:
  MeasurementCache(const CacheFolder& folder, std::string kind,
                   const RunContext& context)
      : folder_(folder), kind_(std::move(kind)), context_(context) {}

  /// What `parse` makes of the entry; nullopt if there is none to trust.
  template <class Parse>
  auto Find(const Hash128::Value& key, const Parse& parse)
      -> decltype(parse(std::string_view())) {
    const auto bytes = folder_.Read(kind_, key);
    if (!bytes) {
      Warn(bytes.error().ToString() + "; computed anew");
      return std::nullopt;
    }
    if (!*bytes) return std::nullopt;
    auto value = parse(**bytes);
    if (!value) {
      Warn("the entry " + kind_ + " " + ToHex(key) +
           " of the cache makes no sense; computed anew");
    }
    return value;
  }

  void Write(const Hash128::Value& key, const std::string& bytes) {
    const Status written = folder_.Write(kind_, key, bytes);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (written || write_failed_) return;
    write_failed_ = true;
    context_.Log(LogLevel::kWarning,
                 "the cache cannot be written: " + written.error().ToString());
  }

  void LogUse(std::size_t found, std::size_t total) const {
    if (found == 0) return;
    context_.Log(LogLevel::kInfo, kind_ + ": " + std::to_string(found) +
                                      " of " + std::to_string(total) +
                                      " from the cache " + folder_.path());
  }

 private:
  void Warn(const std::string& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    context_.Log(LogLevel::kWarning, message);
  }

  const CacheFolder& folder_;
  std::string kind_;
  const RunContext& context_;
  std::mutex mutex_;
  bool write_failed_ = false;
};

}  // namespace lowlap
