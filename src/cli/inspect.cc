#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "cli/flags/scene_input.h"
#include "lowlap/averaging/rigidity/internal/rigidity.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/summary_json.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap::cli {
namespace {

struct InspectFlags {
  CommonFlags common;
  SceneInputFlags input;
  std::string json;
};

std::string Names(const Scene& scene, const std::vector<ViewId>& views) {
  return Joined(views, " ", [&](ViewId view) { return scene.NameOf(view); });
}

void PrintContent(const Scene& scene) {
  std::size_t points = 0, segments = 0, meaningful = 0;
  for (const auto& [view, features] : scene.features) {
    points += features.points_px.size();
    segments += features.segments.size();
  }
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    meaningful += ratio.verdict == RatioVerdict::kMeaningful ? 1 : 0;
  }
  std::printf("views %zu, intrinsics %zu, poses %zu\n", scene.views.size(),
              scene.intrinsics.size(), scene.poses.size());
  std::printf("features: %zu points, %zu segments\n", points, segments);
  std::printf("relative poses %zu, pairs compared in vain %zu\n",
              scene.relative_poses.size(), scene.unrelated_pairs.size());
  std::printf("tracks: %zu points, %zu lines\n", scene.point_tracks.size(),
              scene.line_tracks.size());
  std::printf("scale ratios %zu, meaningful %zu\n", scene.scale_ratios.size(),
              meaningful);
  std::printf("structure: %zu points, %zu lines, %zu coplanar pairs\n",
              scene.structure.size(), scene.line_structure.size(),
              scene.coplanar_pairs.size());
}

void PrintConnections(const RigidityReport& report, const ViewGraph& graph,
                      const Scene& scene) {
  if (!report.isolated_views.empty()) {
    std::printf("views without a relative pose: %s\n",
                Names(scene, report.isolated_views).c_str());
  }
  if (report.connected_components.size() > 1) {
    std::printf("the view graph falls into %zu parts without a link:\n",
                report.connected_components.size());
    for (const auto& component : report.connected_components) {
      std::printf("  %s\n", Names(scene, component).c_str());
    }
  }
  const std::vector<ViewId> articulation = ArticulationViews(graph);
  if (!articulation.empty()) {
    std::printf("views without which their part falls apart: %s\n",
                Names(scene, articulation).c_str());
  }
}

// Groups that keep a scale of their own, and the cameras they meet in.
void PrintGroups(const RigidityReport& report, const Scene& scene) {
  if (report.groups.empty()) {
    std::printf("  none\n");
    return;
  }
  if (report.groups.size() == 1) {
    std::printf("  one scale for all of: %s\n",
                Names(scene, report.groups[0].views).c_str());
    return;
  }
  for (std::size_t g = 0; g < report.groups.size(); ++g) {
    std::printf("  group %zu: %s\n", g + 1,
                Names(scene, report.groups[g].views).c_str());
  }
  for (const ArticulationView& hinge : report.articulation_views) {
    const std::string groups = Joined(hinge.groups, ", ", [](std::size_t g) {
      return std::to_string(g + 1);
    });
    std::printf(
        "  groups %s meet in %s: only scale ratios across it join "
        "them\n",
        groups.c_str(), scene.NameOf(hinge.view).c_str());
  }
}

Result<int> Inspect(const InspectFlags& flags) {
  LOWLAP_RETURN_IF_ERROR(CheckDistinct({{"the scene", flags.input.scene}},
                                       {{"--json", flags.json}}));
  const RunContext context = MakeContext(flags.common);
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(const auto loaded,
                          LoadScene(flags.input, context, &stages));
  const Scene& scene = loaded.scene;
  const ViewGraph graph(scene);
  const RigidityReport by_directions = AnalyzeRigidity(graph);
  constexpr int kMinSharedTracks = 30;
  const RigidityReport by_triplets =
      AnalyzeTripletRigidity(scene, kMinSharedTracks);
  if (!flags.json.empty()) {
    LOWLAP_RETURN_IF_ERROR(WriteFileAtomically(
        flags.json, "{\"by_directions\": " + ToJson(by_directions) +
                        ",\n\"by_triplets\": " + ToJson(by_triplets) + "}\n"));
  }
  PrintContent(scene);
  if (scene.relative_poses.empty()) return 0;
  PrintConnections(by_directions, graph, scene);
  std::printf(
      "\nviews that share a scale through the directions of all relative "
      "poses:\n");
  PrintGroups(by_directions, scene);
  std::printf(
      "\nviews that share a scale through triplets with at least %d "
      "common point tracks (what averaging over triplets uses):\n",
      kMinSharedTracks);
  PrintGroups(by_triplets, scene);
  if (!by_triplets.isolated_views.empty()) {
    std::printf("  in no such triplet: %s\n",
                Names(scene, by_triplets.isolated_views).c_str());
  }
  return 0;
}

}  // namespace

void AddInspect(CLI::App* program, Action* action) {
  auto flags = std::make_shared<InspectFlags>();
  CLI::App* command =
      AddCommand(program, "inspect",
                 "Say what a scene holds, and which views can share a scale, "
                 "before anything is solved");
  AddSceneInputFlags(command, &flags->input);
  AddOption(command, "--json", flags->json,
            "Also write groups and hinges as JSON");
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Inspect, action);
}

}  // namespace lowlap::cli
