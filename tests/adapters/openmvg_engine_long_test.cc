// Minutes of adjustment.
#include "adapters/openmvg_engine_data.h"

namespace lowlap {
namespace {

TEST_F(OpenMvgEngineData, GivesTheAdjustedPosesOfAllFilesToTheByte) {
  for (const Project& project : AllProjects()) {
    ExpectPosesOfTheFiles(project, true);
  }
}

}  // namespace
}  // namespace lowlap
