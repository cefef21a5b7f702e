#include "lowlap/matching/internal/points/nearest_two.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "lowlap/matching/internal/points/approximate_nearest.h"

namespace lowlap {
namespace {

constexpr int kLength = 128;
constexpr int kLanes = 16;   // descriptors of the database side by side
constexpr int kQueries = 6;  // queries at a time

// A group of `kLanes` descriptors: element k of all of them, then element
// k + 1, ... Groups have keys, by which descriptors are compared, a number of
// groups that stays in the cache, and what a lane without a descriptor is never
// nearer than.
struct alignas(64) FloatGroup {
  using Key = float;
  static constexpr std::size_t kBlock = 32;
  // Larger than any distance, and exact: 128 * 255^2 < 2^23.
  static constexpr Key kFar = 16777216.0f;

  void Set(int lane, int k, std::uint8_t value) { values[k][lane] = value; }

  float values[kLength][kLanes];
  Key norms2[kLanes];
};

// Elements less 128, since the instruction multiplies unsigned by signed bytes:
// a.b = a.(b - 128) + 128 sum(a). Four by four.
struct alignas(64) ByteGroup {
  using Key = std::int32_t;
  static constexpr std::size_t kBlock = 64;
  static constexpr Key kFar = 1 << 30;

  void Set(int lane, int k, std::uint8_t value) {
    values[k / 4][lane][k % 4] = static_cast<std::int8_t>(value - 128);
  }

  std::int8_t values[kLength / 4][kLanes][4];
  Key norms2[kLanes];
};

// Running minima of a query, one per lane. Keys are |b|^2 - 2 a.b, in bytes
// |b|^2 - 2 a.(b - 128).
template <class Key>
struct alignas(64) Minima {
  Key best[kLanes];
  Key second[kLanes];
  std::int32_t group[kLanes];
};

std::int32_t SquaredNorm(const PointDescriptor& descriptor) {
  std::int32_t sum = 0;
  for (const std::int32_t value : descriptor) sum += value * value;
  return sum;
}

template <class Group>
std::vector<Group> PackDatabase(const std::vector<PointDescriptor>& database) {
  std::vector<Group> groups((database.size() + kLanes - 1) / kLanes, Group{});
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (int lane = 0; lane < kLanes; ++lane) {
      groups[g].norms2[lane] = Group::kFar;
      const std::size_t i = g * kLanes + lane;
      if (i >= database.size()) continue;
      for (int k = 0; k < kLength; ++k) groups[g].Set(lane, k, database[i][k]);
      groups[g].norms2[lane] =
          static_cast<typename Group::Key>(SquaredNorm(database[i]));
    }
  }
  return groups;
}

template <class Group, class Key>
NearestTwo Reduce(const Minima<Key>& minima, Key to_distance2) {
  NearestTwo result;
  Key best = Group::kFar, second = Group::kFar;
  for (int lane = 0; lane < kLanes; ++lane) {
    const Key key = minima.best[lane];
    if (!(key < Group::kFar)) continue;
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
  if (best < Group::kFar) {
    result.distance2 = static_cast<std::int32_t>(best + to_distance2);
  }
  if (second < Group::kFar) {
    result.second_distance2 = static_cast<std::int32_t>(second + to_distance2);
  }
  return result;
}

// `update` takes kQueries queries at a time; to_distance2(query) added to a key
// makes it a distance.
template <class Group, class Query, class Update, class ToDistance2>
std::vector<NearestTwo> Search(const std::vector<PointDescriptor>& queries,
                               const std::vector<PointDescriptor>& database,
                               const Update& update,
                               const ToDistance2& to_distance2) {
  using Key = typename Group::Key;
  const std::vector<Group> groups = PackDatabase<Group>(database);
  std::vector<Query> padded(
      (queries.size() + kQueries - 1) / kQueries * kQueries, Query{});
  for (std::size_t i = 0; i < queries.size(); ++i) {
    std::copy(queries[i].begin(), queries[i].end(), padded[i].begin());
  }
  Minima<Key> start = {};
  std::fill_n(start.best, kLanes, Group::kFar);
  std::fill_n(start.second, kLanes, Group::kFar);
  std::vector<Minima<Key>> minima(padded.size(), start);
  for (std::size_t begin = 0; begin < groups.size(); begin += Group::kBlock) {
    const std::size_t end = std::min(begin + Group::kBlock, groups.size());
    for (std::size_t q = 0; q < padded.size(); q += kQueries) {
      update(&padded[q], groups.data(), begin, end, &minima[q]);
    }
  }
  std::vector<NearestTwo> results(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    results[i] = Reduce<Group, Key>(minima[i], to_distance2(queries[i]));
  }
  return results;
}

using FloatQuery = std::array<float, kLength>;

// Updates the minima of kQueries queries with groups [begin, end), in vectors
// of kWidth floats and kAtOnce queries at a time, which the caller chooses so
// that the kAtOnce * kLanes sums fit into the registers.
template <int kWidth, int kAtOnce>
inline __attribute__((always_inline)) void UpdateMinimaInVectors(
    const FloatQuery* queries, const FloatGroup* groups, std::size_t begin,
    std::size_t end, Minima<float>* minima) {
  // GCC drops the size from an alias in a template.
  // NOLINTBEGIN(modernize-use-using)
  typedef float Floats
      __attribute__((vector_size(kWidth * sizeof(float)), may_alias));
  typedef std::int32_t Ints
      __attribute__((vector_size(kWidth * sizeof(std::int32_t)), may_alias));
  // NOLINTEND(modernize-use-using)
  constexpr int kVectors = kLanes / kWidth;
  for (std::size_t g = begin; g < end; ++g) {
    for (int first = 0; first < kQueries; first += kAtOnce) {
      Floats dots[kAtOnce][kVectors] = {};
      for (int k = 0; k < kLength; ++k) {
        const Floats* b = reinterpret_cast<const Floats*>(groups[g].values[k]);
        for (int q = 0; q < kAtOnce; ++q) {
          const float a = queries[first + q][k];
          for (int v = 0; v < kVectors; ++v) dots[q][v] += a * b[v];
        }
      }
      const Ints here = Ints{} + static_cast<std::int32_t>(g);
      const Floats* norms2 = reinterpret_cast<const Floats*>(groups[g].norms2);
      for (int q = 0; q < kAtOnce; ++q) {
        Minima<float>& m = minima[first + q];
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

using UpdateMinima = void (*)(const FloatQuery*, const FloatGroup*, std::size_t,
                              std::size_t, Minima<float>*);

void UpdateMinimaPortably(const FloatQuery* queries, const FloatGroup* groups,
                          std::size_t begin, std::size_t end,
                          Minima<float>* minima) {
  UpdateMinimaInVectors<4, 3>(queries, groups, begin, end, minima);
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) void UpdateMinimaAvx2(
    const FloatQuery* queries, const FloatGroup* groups, std::size_t begin,
    std::size_t end, Minima<float>* minima) {
  UpdateMinimaInVectors<8, 6>(queries, groups, begin, end, minima);
}

__attribute__((target("avx512f,avx512bw,avx512vl"))) void UpdateMinimaAvx512(
    const FloatQuery* queries, const FloatGroup* groups, std::size_t begin,
    std::size_t end, Minima<float>* minima) {
  UpdateMinimaInVectors<16, 6>(queries, groups, begin, end, minima);
}

__attribute__((target("avx512f,avx512bw,avx512vl,avx512vnni"))) void
UpdateMinimaVnni(const PointDescriptor* queries, const ByteGroup* groups,
                 std::size_t begin, std::size_t end,
                 Minima<std::int32_t>* minima) {
  for (std::size_t g = begin; g < end; ++g) {
    __m512i dots[kQueries];
    for (__m512i& dot : dots) dot = _mm512_setzero_si512();
    for (int k = 0; k < kLength / 4; ++k) {
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
      Minima<std::int32_t>& m = minima[q];
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
  return Search<FloatGroup, FloatQuery>(
      queries, database, ChooseUpdateMinima(),
      [](const PointDescriptor& query) {
        return static_cast<float>(SquaredNorm(query));
      });
}

bool HasByteProducts() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512vnni");
#else
  return false;
#endif
}

std::vector<NearestTwo> FindNearestTwoInBytes(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database) {
#if defined(__x86_64__)
  return Search<ByteGroup, PointDescriptor>(
      queries, database, UpdateMinimaVnni, [](const PointDescriptor& query) {
        std::int32_t sum = 0;
        for (const std::int32_t value : query) sum += value;
        return SquaredNorm(query) - 256 * sum;
      });
#else
  return FindNearestTwoInFloats(queries, database);
#endif
}

std::vector<NearestTwo> FindNearestTwoApproximately(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database) {
  if (queries.empty() || database.size() < 2) {
    return FindNearestTwo(queries, database);
  }
  const auto neighbours = ApproximateIndex(database, {}).Search(queries, 2);
  std::vector<NearestTwo> nearest(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto& first = neighbours[2 * i];
    nearest[i] = {static_cast<std::int32_t>(first.index), first.distance2,
                  neighbours[2 * i + 1].distance2};
  }
  return nearest;
}

}  // namespace lowlap
