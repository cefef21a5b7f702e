#include "third_party_adapters/trajectories/internal/scene_format.h"

#include <utility>

#include "third_party_adapters/trajectories/internal/kitti.h"
#include "third_party_adapters/trajectories/internal/tum.h"

namespace lowlap::trajectories {
namespace {

using ParseTrajectory = Result<Scene> (*)(std::string_view,
                                          const std::string& file);
using FormatTrajectory = Result<std::string> (*)(const Scene&, SceneNotes*);

SceneFormat TrajectoryFormat(const char* name, const char* description,
                             ParseTrajectory parse, FormatTrajectory format) {
  SceneFormat result;
  result.name = name;
  result.description = description;
  result.extension = std::string(".") + name;
  result.holds = {SceneContent::kPoses};
  result.needs = {SceneContent::kPoses};
  result.read =
      ReadOneFile([parse](std::string_view text, const std::string& file,
                          SceneNotes*) { return parse(text, file); });
  result.write = WriteOneFile(format);
  return result;
}

}  // namespace

SceneFormats TrajectoryFormats() {
  SceneFormat tum =
      TrajectoryFormat("tum", "trajectory of the TUM RGB-D benchmark (*.tum)",
                       ParseTum, FormatTum);
  tum.recognizes_start = IsTumStart;
  SceneFormat kitti = TrajectoryFormat(
      "kitti", "poses of the KITTI odometry benchmark (*.kitti)", ParseKitti,
      FormatKitti);
  kitti.recognizes_start = IsKittiStart;
  return {std::move(tum), std::move(kitti)};
}

}  // namespace lowlap::trajectories
