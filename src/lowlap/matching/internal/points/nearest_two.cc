#include "lowlap/matching/internal/points/nearest_two.h"

#include <algorithm>
#include <cstddef>

namespace lowlap {
namespace {

constexpr int kLength = 128;
constexpr int kLanes = 16;          // descriptors of the database side by side
constexpr int kQueries = 6;         // queries at a time
constexpr std::size_t kBlock = 32;  // groups of lanes that stay in the cache

// Larger than any distance, and exact: 128 * 255^2 < 2^23.
constexpr float kFar = 16777216.0f;

// `kLanes` descriptors: element k of all of them, then element k + 1, ...
struct alignas(64) Group {
  float values[kLength][kLanes];
  float norms2[kLanes];
};

struct Query {
  float values[kLength];
};

// Running minima of a query, one per lane. Keys are |b|^2 - 2 a.b.
struct alignas(64) Minima {
  float best[kLanes];
  float second[kLanes];
  std::int32_t group[kLanes];
};

float SquaredNorm(const PointDescriptor& descriptor) {
  int sum = 0;
  for (const int value : descriptor) sum += value * value;
  return static_cast<float>(sum);
}

std::vector<Group> PackDatabase(const std::vector<PointDescriptor>& database) {
  std::vector<Group> groups((database.size() + kLanes - 1) / kLanes);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = g * kLanes + lane;
      const bool exists = i < database.size();
      for (int k = 0; k < kLength; ++k) {
        groups[g].values[k][lane] = exists ? database[i][k] : 0.0f;
      }
      // A lane without a descriptor is never nearer than kFar.
      groups[g].norms2[lane] = exists ? SquaredNorm(database[i]) : kFar;
    }
  }
  return groups;
}

// Updates the minima of kQueries queries with groups [begin, end), in vectors
// of kWidth floats and kAtOnce queries at a time, which the caller chooses so
// that the kAtOnce * kLanes sums fit into the registers.
template <int kWidth, int kAtOnce>
inline __attribute__((always_inline)) void UpdateMinimaInVectors(
    const Query* queries, const Group* groups, std::size_t begin,
    std::size_t end, Minima* minima) {
  typedef float Floats
      __attribute__((vector_size(kWidth * sizeof(float)), may_alias));
  typedef std::int32_t Ints
      __attribute__((vector_size(kWidth * sizeof(std::int32_t)), may_alias));
  constexpr int kVectors = kLanes / kWidth;
  for (std::size_t g = begin; g < end; ++g) {
    for (int first = 0; first < kQueries; first += kAtOnce) {
      Floats dots[kAtOnce][kVectors] = {};
      for (int k = 0; k < kLength; ++k) {
        const Floats* b = reinterpret_cast<const Floats*>(groups[g].values[k]);
        for (int q = 0; q < kAtOnce; ++q) {
          const float a = queries[first + q].values[k];
          for (int v = 0; v < kVectors; ++v) dots[q][v] += a * b[v];
        }
      }
      const Ints here = Ints{} + static_cast<std::int32_t>(g);
      const Floats* norms2 = reinterpret_cast<const Floats*>(groups[g].norms2);
      for (int q = 0; q < kAtOnce; ++q) {
        Minima& m = minima[first + q];
        for (int v = 0; v < kVectors; ++v) {
          Floats& best = reinterpret_cast<Floats*>(m.best)[v];
          Floats& second = reinterpret_cast<Floats*>(m.second)[v];
          Ints& group = reinterpret_cast<Ints*>(m.group)[v];
          const Floats key = norms2[v] - 2.0f * dots[q][v];
          const Ints nearer = key < best;
          const Floats loser = nearer ? best : key;
          second = loser < second ? loser : second;
          best = nearer ? key : best;
          group = nearer ? here : group;
        }
      }
    }
  }
}

using UpdateMinima = void (*)(const Query*, const Group*, std::size_t,
                              std::size_t, Minima*);

void UpdateMinimaPortably(const Query* queries, const Group* groups,
                          std::size_t begin, std::size_t end, Minima* minima) {
  UpdateMinimaInVectors<4, 3>(queries, groups, begin, end, minima);
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) void UpdateMinimaAvx2(const Query* queries,
                                                          const Group* groups,
                                                          std::size_t begin,
                                                          std::size_t end,
                                                          Minima* minima) {
  UpdateMinimaInVectors<8, 6>(queries, groups, begin, end, minima);
}

__attribute__((target("avx512f,avx512bw,avx512vl"))) void UpdateMinimaAvx512(
    const Query* queries, const Group* groups, std::size_t begin,
    std::size_t end, Minima* minima) {
  UpdateMinimaInVectors<16, 6>(queries, groups, begin, end, minima);
}
#endif

// The fastest form that the processor has.
UpdateMinima ChooseUpdateMinima() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl")) {
    return UpdateMinimaAvx512;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    return UpdateMinimaAvx2;
  }
#endif
  return UpdateMinimaPortably;
}

NearestTwo Reduce(const Minima& minima, float query_norm2) {
  NearestTwo result;
  float best = kFar, second = kFar;
  for (int lane = 0; lane < kLanes; ++lane) {
    const float key = minima.best[lane];
    if (!(key < kFar)) continue;
    const std::int32_t index = minima.group[lane] * kLanes + lane;
    if (key < best || (key == best && index < result.index)) {
      second = std::min(best, second);
      best = key;
      result.index = index;
    } else {
      second = std::min(second, key);
    }
    second = std::min(second, minima.second[lane]);
  }
  if (best < kFar) {
    result.distance2 = static_cast<std::int32_t>(best + query_norm2);
  }
  if (second < kFar) {
    result.second_distance2 = static_cast<std::int32_t>(second + query_norm2);
  }
  return result;
}

}  // namespace

std::vector<NearestTwo> FindNearestTwo(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database) {
  return HasByteProducts() ? FindNearestTwoInBytes(queries, database)
                           : FindNearestTwoInFloats(queries, database);
}

std::vector<NearestTwo> FindNearestTwoInFloats(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database) {
  const std::vector<Group> groups = PackDatabase(database);
  const std::size_t padded =
      (queries.size() + kQueries - 1) / kQueries * kQueries;
  std::vector<Query> packed(padded, Query{});
  for (std::size_t i = 0; i < queries.size(); ++i) {
    std::copy(queries[i].begin(), queries[i].end(), packed[i].values);
  }
  Minima start = {};
  std::fill_n(start.best, kLanes, kFar);
  std::fill_n(start.second, kLanes, kFar);
  std::vector<Minima> minima(padded, start);
  const UpdateMinima update = ChooseUpdateMinima();
  for (std::size_t begin = 0; begin < groups.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, groups.size());
    for (std::size_t q = 0; q < padded; q += kQueries) {
      update(&packed[q], groups.data(), begin, end, &minima[q]);
    }
  }
  std::vector<NearestTwo> results(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    results[i] = Reduce(minima[i], SquaredNorm(queries[i]));
  }
  return results;
}

}  // namespace lowlap
