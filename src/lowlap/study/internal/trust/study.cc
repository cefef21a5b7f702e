#include "lowlap/study/internal/trust/study.h"

#include <optional>
#include <utility>
#include <vector>

#include "lowlap/study/internal/run_trials.h"

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
  return RunTrials<TrustKey, TrustTrial>(
      context, "solving scenes", missing,
      [](const TrustKey& key) -> std::optional<TrustTrial> {
        RunContext alone;
        alone.num_threads = 1;
        alone.seed = key.second;
        auto trial = RunTrustTrial(key.first, key.second, alone);
        if (!trial) return std::nullopt;
        return std::move(*trial);
      },
      done, &study->trials);
}

}  // namespace lowlap
