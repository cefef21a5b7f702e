#include "lowlap/matching/internal/hamming.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lowlap::internal {
namespace {

inline __attribute__((always_inline)) void CountDifferences(
    const LineDescriptor& query, const std::vector<LineDescriptor>& others,
    int* distances) {
  constexpr std::size_t kWords = sizeof(LineDescriptor) / sizeof(std::uint64_t);
  std::uint64_t a[kWords], b[kWords];
  std::memcpy(a, query.data(), sizeof(a));
  for (std::size_t n = 0; n < others.size(); ++n) {
    std::memcpy(b, others[n].data(), sizeof(b));
    int distance = 0;
    for (std::size_t k = 0; k < kWords; ++k) {
      distance += __builtin_popcountll(a[k] ^ b[k]);
    }
    distances[n] = distance;
  }
}

using Count = void (*)(const LineDescriptor&,
                       const std::vector<LineDescriptor>&, int*);

void CountPortably(const LineDescriptor& query,
                   const std::vector<LineDescriptor>& others, int* distances) {
  CountDifferences(query, others, distances);
}

#if defined(__x86_64__)
__attribute__((target("popcnt"))) void CountInHardware(
    const LineDescriptor& query, const std::vector<LineDescriptor>& others,
    int* distances) {
  CountDifferences(query, others, distances);
}
#endif

Count ChooseCount() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("popcnt")) return CountInHardware;
#endif
  return CountPortably;
}

}  // namespace

void HammingDistances(const LineDescriptor& query,
                      const std::vector<LineDescriptor>& others,
                      std::vector<int>* distances) {
  static const Count count = ChooseCount();
  distances->resize(others.size());
  count(query, others, distances->data());
}

}  // namespace lowlap::internal
