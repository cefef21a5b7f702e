#include "third_party_adapters/limap/internal/scene_format.h"

#include <utility>

#include "third_party_adapters/limap/internal/folder_layout.h"
#include "third_party_adapters/limap/internal/line_folder.h"

namespace lowlap::limap {

SceneFormats LimapFormats() {
  SceneFormat format;
  format.name = "limap";
  format.description =
      "LIMAP's folder: segments, their matches, lines, and a COLMAP model";
  format.recognizes_folder = IsLimapFolder;
  format.holds = {SceneContent::kNames,       SceneContent::kIntrinsics,
                  SceneContent::kFrames,      SceneContent::kPoses,
                  SceneContent::kKeypoints,   SceneContent::kSegments,
                  SceneContent::kLineMatches, SceneContent::kLineTracks,
                  SceneContent::kPoints,      SceneContent::kObservations,
                  SceneContent::kLines,       SceneContent::kLineObservations};
  format.needs = {SceneContent::kPoses, SceneContent::kIntrinsics};
  format.read = ReadLineFolder;
  format.write = WriteLineFolder;
  return {std::move(format)};
}

}  // namespace lowlap::limap
