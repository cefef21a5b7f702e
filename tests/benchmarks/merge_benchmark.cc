// How long the pieces of a model take to find.
#include <benchmark/benchmark.h>

#include <cstdint>

#include "lowlap/core/internal/random.h"
#include "lowlap/merge/internal/rigid_pieces.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

// A street: every view is related to the next two, no ratio is measured.
void RigidPiecesOfStreet(benchmark::State& state) {
  const auto num_views = static_cast<std::uint32_t>(state.range(0));
  Random random(1);
  std::map<ViewId, Pose> poses;
  std::vector<PairAgreement> pairs;
  for (std::uint32_t n = 0; n < num_views; ++n) {
    const Vec2 aside = testing::UniformVec2(random, {-1, -1}, {1, 1});
    poses[n].center = Vec3(n, aside.x(), aside.y());
    for (std::uint32_t next = n + 1; next <= n + 2 && next < num_views;
         ++next) {
      pairs.push_back({{n, next}, 0, 0, 0, 0.01, 0.03});
    }
  }
  std::size_t num_pieces = 0;
  for (auto _ : state) {
    const auto pieces = FindRigidPieces(poses, pairs, {}, 5, RunContext());
    if (!pieces) return state.SkipWithError(pieces.error().message.c_str());
    num_pieces = pieces->size();
  }
  state.counters["pieces"] = static_cast<double>(num_pieces);
}
BENCHMARK(RigidPiecesOfStreet)->Arg(500)->Arg(5000)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
