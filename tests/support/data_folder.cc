#include "support/data_folder.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace lowlap {

std::string SourceFolder() { return LOWLAP_SOURCE_DIR; }

std::string DataFolder() {
  const char* given = std::getenv("LOWLAP_DATA");
  const std::filesystem::path folder =
      given ? std::filesystem::path(given)
            : std::filesystem::path(SourceFolder()) / ".." / "shared" / "data";
  std::error_code ignored;
  return std::filesystem::is_directory(folder, ignored) ? folder.string() : "";
}

std::string RoomFolder() { return SourceFolder() + "/sfm_data/samples/room"; }

}  // namespace lowlap
