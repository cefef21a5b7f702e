#include "third_party_adapters/colmap/internal/model.h"

#include <filesystem>
#include <system_error>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/io/internal/failure.h"

namespace lowlap::colmap {
namespace {

namespace fs = std::filesystem;

bool IsFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace

std::string PartPath(const std::string& folder, const std::string& name,
                     ModelForm form) {
  return (fs::path(folder) /
          (name + (form == ModelForm::kBinary ? ".bin" : ".txt")))
      .string();
}

bool HasModel(const std::string& folder, ModelForm form) {
  for (const char* name : {"cameras", "images", "points3D"}) {
    if (!IsFile(PartPath(folder, name, form))) return false;
  }
  return true;
}

Result<Model> ReadModel(const std::string& folder, ModelForm form) {
  Model model;
  for (const std::string name : kModelParts) {
    const std::string path = PartPath(folder, name, form);
    const bool is_optional = name == "rigs" || name == "frames";
    if (is_optional && !IsFile(path)) continue;
    const auto content = ReadWholeFile(path);
    if (!content) return tl::unexpected<Error>(content.error());
    Result<int> parsed = Caught([&] {
      (form == ModelForm::kBinary ? ParseBinary : ParseText)(*content, name,
                                                             &model);
      return 0;
    });
    if (!parsed) {
      parsed.error().file = path;
      return tl::unexpected<Error>(std::move(parsed.error()));
    }
  }
  return model;
}

}  // namespace lowlap::colmap
