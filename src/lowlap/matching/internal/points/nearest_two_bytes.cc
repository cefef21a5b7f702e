#include <algorithm>
#include <cstddef>
#include <cstring>

#include "lowlap/matching/internal/points/nearest_two.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace lowlap {

#if defined(__x86_64__)
namespace {

constexpr int kLanes = 16;          // descriptors of the database side by side
constexpr int kWords = 128 / 4;     // of four elements each
constexpr int kQueries = 6;         // queries at a time
constexpr std::size_t kBlock = 64;  // groups of lanes that stay in the cache
constexpr std::int32_t kFar = 1 << 30;

// Elements of the database less 128, since the instruction multiplies unsigned
// by signed bytes: a.b = a.(b - 128) + 128 sum(a).
struct alignas(64) Group {
  std::int8_t values[kWords][kLanes][4];
  std::int32_t norms2[kLanes];
};

// Running minima of a query, one per lane. Keys are |b|^2 - 2 a.(b - 128).
struct alignas(64) Minima {
  std::int32_t best[kLanes];
  std::int32_t second[kLanes];
  std::int32_t group[kLanes];
};

std::int32_t SquaredNorm(const PointDescriptor& descriptor) {
  std::int32_t sum = 0;
  for (const std::int32_t value : descriptor) sum += value * value;
  return sum;
}

std::vector<Group> PackDatabase(const std::vector<PointDescriptor>& database) {
  std::vector<Group> groups((database.size() + kLanes - 1) / kLanes, Group{});
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = g * kLanes + lane;
      // A lane without a descriptor is never nearer than kFar.
      groups[g].norms2[lane] = kFar;
      if (i >= database.size()) continue;
      for (int k = 0; k < 4 * kWords; ++k) {
        groups[g].values[k / 4][lane][k % 4] =
            static_cast<std::int8_t>(database[i][k] - 128);
      }
      groups[g].norms2[lane] = SquaredNorm(database[i]);
    }
  }
  return groups;
}

__attribute__((target("avx512f,avx512bw,avx512vl,avx512vnni"))) void
UpdateMinima(const PointDescriptor* queries, const Group* groups,
             std::size_t begin, std::size_t end, Minima* minima) {
  for (std::size_t g = begin; g < end; ++g) {
    __m512i dots[kQueries];
    for (__m512i& dot : dots) dot = _mm512_setzero_si512();
    for (int k = 0; k < kWords; ++k) {
      const __m512i b = _mm512_load_si512(groups[g].values[k]);
      for (int q = 0; q < kQueries; ++q) {
        std::int32_t word = 0;
        std::memcpy(&word, queries[q].data() + 4 * k, sizeof(word));
        dots[q] = _mm512_dpbusd_epi32(dots[q], _mm512_set1_epi32(word), b);
      }
    }
    const __m512i here = _mm512_set1_epi32(static_cast<std::int32_t>(g));
    const __m512i norms2 = _mm512_load_si512(groups[g].norms2);
    for (int q = 0; q < kQueries; ++q) {
      Minima& m = minima[q];
      const __m512i key =
          _mm512_sub_epi32(norms2, _mm512_add_epi32(dots[q], dots[q]));
      const __m512i best = _mm512_load_si512(m.best);
      const __mmask16 nearer = _mm512_cmplt_epi32_mask(key, best);
      const __m512i loser = _mm512_mask_blend_epi32(nearer, key, best);
      _mm512_store_si512(m.second, _mm512_mask_blend_epi32(
                                       _mm512_cmplt_epi32_mask(
                                           loser, _mm512_load_si512(m.second)),
                                       _mm512_load_si512(m.second), loser));
      _mm512_store_si512(m.best, _mm512_mask_blend_epi32(nearer, best, key));
      _mm512_store_si512(
          m.group,
          _mm512_mask_blend_epi32(nearer, _mm512_load_si512(m.group), here));
    }
  }
}

NearestTwo Reduce(const Minima& minima, const PointDescriptor& query) {
  std::int32_t sum = 0;
  for (const std::int32_t value : query) sum += value;
  const std::int32_t to_distance2 = SquaredNorm(query) - 256 * sum;
  NearestTwo result;
  std::int32_t best = kFar, second = kFar;
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::int32_t key = minima.best[lane];
    if (key >= kFar) continue;
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
  if (best < kFar) result.distance2 = best + to_distance2;
  if (second < kFar) result.second_distance2 = second + to_distance2;
  return result;
}

}  // namespace

bool HasByteProducts() {
  return __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512vnni");
}

std::vector<NearestTwo> FindNearestTwoInBytes(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database) {
  const std::vector<Group> groups = PackDatabase(database);
  std::vector<PointDescriptor> padded = queries;
  padded.resize((queries.size() + kQueries - 1) / kQueries * kQueries,
                PointDescriptor{});
  Minima start = {};
  std::fill_n(start.best, kLanes, kFar);
  std::fill_n(start.second, kLanes, kFar);
  std::vector<Minima> minima(padded.size(), start);
  for (std::size_t begin = 0; begin < groups.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, groups.size());
    for (std::size_t q = 0; q < padded.size(); q += kQueries) {
      UpdateMinima(&padded[q], groups.data(), begin, end, &minima[q]);
    }
  }
  std::vector<NearestTwo> results(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    results[i] = Reduce(minima[i], queries[i]);
  }
  return results;
}

#else

bool HasByteProducts() { return false; }

std::vector<NearestTwo> FindNearestTwoInBytes(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database) {
  return FindNearestTwoInFloats(queries, database);
}

#endif

}  // namespace lowlap
