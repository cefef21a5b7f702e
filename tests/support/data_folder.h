#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lowlap {

/// The folder with the photographs and reference solutions that slow tests
/// measure on: the environment variable LOWLAP_DATA, or shared/data beside the
/// source folder. Empty if there is none.
inline std::string DataFolder() {
  const char* given = std::getenv("LOWLAP_DATA");
  const std::filesystem::path folder =
      given
          ? std::filesystem::path(given)
          : std::filesystem::path(LOWLAP_SOURCE_DIR) / ".." / "shared" / "data";
  std::error_code ignored;
  return std::filesystem::is_directory(folder, ignored) ? folder.string() : "";
}

}  // namespace lowlap
