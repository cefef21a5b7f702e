// How fast a scene loads from each of its two forms. The scene is the size of a
// few hundred photographs; both forms hold the same content and are parsed from
// memory, validation included. "times_faster" in the last line is the ratio.
#include <benchmark/benchmark.h>

#include "benchmarks/processor_time.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/io/internal/scene_binary.h"
#include "scene/example_scenes.h"

namespace lowlap {
namespace {

const Scene& BenchmarkScene() {
  static const Scene scene = testing::RandomScene(1, 200, 100000, 20000);
  return scene;
}

const std::string& Text() {
  static const std::string text = *FormatSceneJson(BenchmarkScene());
  return text;
}

const std::string& Bytes() {
  static const std::string bytes = *FormatSceneBinary(BenchmarkScene());
  return bytes;
}

void SetSize(benchmark::State& state, const std::string& data) {
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(data.size()));
  state.counters["bytes"] = static_cast<double>(data.size());
}

void ReadJson(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(ParseSceneJson(Text()));
  SetSize(state, Text());
}
BENCHMARK(ReadJson)->Unit(benchmark::kMillisecond);

void ReadBinary(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(ParseSceneBinary(Bytes()));
  SetSize(state, Bytes());
}
BENCHMARK(ReadBinary)->Unit(benchmark::kMillisecond);

void WriteJson(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(FormatSceneJson(BenchmarkScene()));
  }
  SetSize(state, Text());
}
BENCHMARK(WriteJson)->Unit(benchmark::kMillisecond);

void WriteBinary(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(FormatSceneBinary(BenchmarkScene()));
  }
  SetSize(state, Bytes());
}
BENCHMARK(WriteBinary)->Unit(benchmark::kMillisecond);

// One after the other, so that both see the same machine.
void ReadBinaryAgainstJson(benchmark::State& state) {
  Text();
  Bytes();
  double json = 0, binary = 0;
  for (auto _ : state) {
    json += testing::ProcessorSeconds(
        [] { benchmark::DoNotOptimize(ParseSceneJson(Text())); });
    binary += testing::ProcessorSeconds(
        [] { benchmark::DoNotOptimize(ParseSceneBinary(Bytes())); });
  }
  state.counters["times_faster"] = json / binary;
}
BENCHMARK(ReadBinaryAgainstJson)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lowlap

BENCHMARK_MAIN();
