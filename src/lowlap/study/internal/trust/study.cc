#include "lowlap/study/internal/trust/study.h"

#include <mutex>
#include <vector>

#include "lowlap/core/internal/parallel.h"

namespace lowlap {

Status RunTrustStudy(
    const RunContext& context,
    const std::function<Status(const TrustKey&, const TrustTrial&)>& done,
    TrustStudy* study) {
  if (study->num_scenes < 1) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the number of scenes must be positive");
  }
  std::vector<TrustKey> missing;
  for (const TrustFamily family : AllTrustFamilies()) {
    for (int n = 0; n < study->num_scenes; ++n) {
      const TrustKey key = {family,
                            context.seed + static_cast<std::uint64_t>(n)};
      if (study->trials.count(key) == 0) missing.push_back(key);
    }
  }
  Status failed;
  std::mutex mutex;
  RunContext watched = context;
  watched.progress = [&](const std::string& stage, std::size_t count,
                         std::size_t total) {
    const std::lock_guard<std::mutex> lock(mutex);
    return failed.has_value() && context.Progress(stage, count, total);
  };
  const Status status = ParallelFor(
      watched, "solving scenes", missing.size(), [&](std::size_t n) {
        const TrustKey& key = missing[n];
        RunContext alone;
        alone.num_threads = 1;
        alone.seed = key.second;
        const auto trial = RunTrustTrial(key.first, key.second, alone);
        if (!trial) return;
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failed) return;
        study->trials[key] = *trial;
        if (done) failed = done(key, *trial);
      });
  return failed ? status : failed;
}

}  // namespace lowlap
