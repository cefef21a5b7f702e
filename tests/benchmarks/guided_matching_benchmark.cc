// What matching under a known relative pose costs. "relative_cost" is the
// processor time over that of matching the same features by appearance alone,
// so that it depends little on the machine; "times_faster" is against the
// portable form of the same search.
#include <benchmark/benchmark.h>

#include "benchmarks/processor_time.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/matching/internal/lines/guided_line_matching.h"
#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "lowlap/matching/internal/points/nearest_two.h"
#include "lowlap/matching/internal/points/point_matching.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using testing::ProcessorSeconds;

constexpr std::size_t kNumPoints = 4000;
constexpr std::size_t kNumLines = 1000;

template <class Descriptor>
Descriptor RandomBytes(Random* random) {
  Descriptor descriptor;
  for (auto& byte : descriptor) {
    byte = static_cast<std::uint8_t>(random->Uniform(0, 256));
  }
  return descriptor;
}

struct View {
  ViewFeatures features;
  std::vector<Keypoint> keypoints;
  std::vector<PointDescriptor> point_descriptors;
  std::vector<LineDescriptor> line_descriptors;
  NormalizedFeatures normalized;
};

// Points and short lines in front of both cameras; both views see all of them,
// with equal descriptors.
struct ViewCouple {
  RigidTransform cam2_from_cam1 = {
      RotationFromAngleAxis(Vec3(0.02, -0.5, 0.03)), Vec3(0.95, 0.1, 0.3)};
  View first, second;

  ViewCouple() {
    Intrinsic camera;
    camera.width_px = 1200;
    camera.height_px = 800;
    camera.fx_px = camera.fy_px = 900;
    camera.principal_point_px = Vec2(600, 400);
    Random random(1);
    const auto point = [&]() -> Vec3 {
      return {random.Uniform(0.5, 3.5), random.Uniform(-1.5, 1.5),
              random.Uniform(4, 6)};
    };
    for (std::size_t i = 0; i < kNumPoints; ++i) {
      const Vec3 x = point();
      const auto descriptor = RandomBytes<PointDescriptor>(&random);
      for (View* view : {&first, &second}) {
        Keypoint keypoint;
        keypoint.position_px =
            camera.Project(view == &first ? x : cam2_from_cam1 * x);
        keypoint.scale_px = 3;
        view->features.points_px.push_back(keypoint.position_px);
        view->keypoints.push_back(keypoint);
        view->point_descriptors.push_back(descriptor);
      }
    }
    for (std::size_t i = 0; i < kNumLines; ++i) {
      const Vec3 a = point();
      const Vec2 step = testing::UniformVec2(random, {-0.3, -0.3}, {0.3, 0.3});
      const Vec3 b = a + Vec3(step.x(), step.y(), 0);
      const auto descriptor = RandomBytes<LineDescriptor>(&random);
      for (View* view : {&first, &second}) {
        LineSegment segment;
        segment.start_px =
            camera.Project(view == &first ? a : cam2_from_cam1 * a);
        segment.end_px =
            camera.Project(view == &first ? b : cam2_from_cam1 * b);
        view->features.segments.push_back(segment);
        view->line_descriptors.push_back(descriptor);
      }
    }
    for (View* view : {&first, &second}) {
      view->normalized = NormalizeFeatures(view->features, camera);
    }
  }
};

const ViewCouple& Couple() {
  static const ViewCouple couple;
  return couple;
}

void NearestTwoAgainstFloats(benchmark::State& state) {
  const auto& a = Couple().first.point_descriptors;
  const auto& b = Couple().second.point_descriptors;
  double floats = 0, chosen = 0;
  for (auto _ : state) {
    floats += ProcessorSeconds(
        [&] { benchmark::DoNotOptimize(FindNearestTwoInFloats(a, b)); });
    chosen += ProcessorSeconds(
        [&] { benchmark::DoNotOptimize(FindNearestTwo(a, b)); });
  }
  state.counters["times_faster"] = floats / chosen;
}
BENCHMARK(NearestTwoAgainstFloats)->Unit(benchmark::kMillisecond);

void GuidedPointsAgainstAppearance(benchmark::State& state) {
  const View &a = Couple().first, &b = Couple().second;
  double guided = 0, plain = 0;
  for (auto _ : state) {
    plain += ProcessorSeconds([&] {
      benchmark::DoNotOptimize(
          MatchPoints(a.point_descriptors, b.point_descriptors, {}));
    });
    guided += ProcessorSeconds([&] {
      benchmark::DoNotOptimize(
          MatchPointsGuided({a.keypoints, a.point_descriptors, a.normalized},
                            {b.keypoints, b.point_descriptors, b.normalized},
                            Couple().cam2_from_cam1, 2, {}));
    });
  }
  state.counters["relative_cost"] = guided / plain;
}
BENCHMARK(GuidedPointsAgainstAppearance)->Unit(benchmark::kMillisecond);

void GuidedLinesAgainstAppearance(benchmark::State& state) {
  const View &a = Couple().first, &b = Couple().second;
  const DescribedLines lines1 = {a.features.segments, a.line_descriptors};
  const DescribedLines lines2 = {b.features.segments, b.line_descriptors};
  double guided = 0, plain = 0;
  for (auto _ : state) {
    plain += ProcessorSeconds(
        [&] { benchmark::DoNotOptimize(MatchLines(lines1, lines2, {})); });
    guided += ProcessorSeconds([&] {
      benchmark::DoNotOptimize(
          MatchLinesGuided(lines1, lines2, a.normalized, b.normalized,
                           Couple().cam2_from_cam1, {}, {}));
    });
  }
  state.counters["relative_cost"] = guided / plain;
}
BENCHMARK(GuidedLinesAgainstAppearance)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
