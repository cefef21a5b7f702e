#include "lowlap/scene/view.h"

#include <filesystem>

namespace lowlap {

std::string View::PathBelowRoot() const {
  return (std::filesystem::path(local_path) / filename).generic_string();
}

}  // namespace lowlap
