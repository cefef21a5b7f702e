#include <gtest/gtest.h>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/study/internal/trust/trial.h"

namespace lowlap {
namespace {

// Of a thousand scenes without truth, one ratio in a hundred may be meaningful.
TEST(TrustNoise, AThousandScenesOfUnrelatedFeatures) {
  constexpr std::size_t kScenes = 1000;
  std::vector<TrustTrial> trials(kScenes);
  ASSERT_TRUE(ParallelFor(RunContext(), "", kScenes, [&](std::size_t n) {
    RunContext alone;
    alone.num_threads = 1;
    alone.seed = n;
    trials[n] = *RunTrustTrial(TrustFamily::kNoise, n, alone);
  }));
  int num_triplets = 0, num_meaningful = 0;
  for (std::size_t n = 0; n < kScenes; ++n) {
    num_triplets += trials[n].num_triplets;
    num_meaningful += trials[n].num_meaningful;
    for (const JudgedView& judged : trials[n].views) {
      EXPECT_FALSE(judged.IsFirm()) << "seed " << n;
    }
  }
  EXPECT_GT(num_triplets, 1000);
  EXPECT_LE(100 * num_meaningful, num_triplets);
}

}  // namespace
}  // namespace lowlap
