#include "third_party_adapters/onedsfm/internal/scene_format.h"

#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "third_party_adapters/onedsfm/internal/problem.h"

namespace lowlap::onedsfm {

SceneFormats OneDSfmFormats() {
  SceneFormat format;
  format.name = "1dsfm";
  format.description = "a problem folder of 1DSfM (EGs.txt, cc.txt, ...)";
  format.recognizes_folder = IsProblemFolder;
  format.holds = {SceneContent::kNames,         SceneContent::kIntrinsics,
                  SceneContent::kFrames,        SceneContent::kKeypoints,
                  SceneContent::kRelativePoses, SceneContent::kPointMatches,
                  SceneContent::kPointTracks};
  format.read = [](const std::string& path,
                   SceneNotes* notes) -> Result<Scene> {
    LOWLAP_ASSIGN_OR_RETURN(auto problem, ReadProblem(path));
    for (std::string& note : problem.notes) notes->push_back(std::move(note));
    return std::move(problem.scene);
  };
  return {std::move(format)};
}

}  // namespace lowlap::onedsfm
