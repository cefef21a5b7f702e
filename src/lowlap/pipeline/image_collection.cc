#include "lowlap/pipeline/image_collection.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include "lowlap/features/image.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;

bool HasImageExtension(const fs::path& path) {
  constexpr std::array<const char*, 9> kExtensions = {".jpg", ".jpeg", ".png",
                                                      ".tif", ".tiff", ".bmp",
                                                      ".pgm", ".ppm",  ".webp"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) !=
         kExtensions.end();
}

bool NameFits(const std::string& name, const std::string& filename) {
  return name == filename || name == fs::path(filename).stem().string();
}

Result<std::vector<std::string>> ListImages(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return MakeError(ErrorCode::kNotFound, "no such image folder", folder);
  }
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_regular_file() && HasImageExtension(entry->path())) {
      names.push_back(entry->path().filename().string());
    }
  }
  if (error) return MakeError(ErrorCode::kIo, error.message(), folder);
  std::sort(names.begin(), names.end());
  return names;
}

Intrinsic MakeIntrinsic(const IntrinsicSource& source, const ImageSize& size) {
  Intrinsic intrinsic;
  intrinsic.width_px = size.width_px;
  intrinsic.height_px = size.height_px;
  if (source.calibration) {
    const Mat3& k = *source.calibration;
    intrinsic.fx_px = k(0, 0);
    intrinsic.fy_px = k(1, 1);
    intrinsic.principal_point_px = {k(0, 2), k(1, 2)};
  } else {
    intrinsic.fx_px = intrinsic.fy_px = *source.focal_px;
    // Pixel centres are integers, so the middle of the image is at (w - 1) / 2.
    intrinsic.principal_point_px = {0.5 * (size.width_px - 1),
                                    0.5 * (size.height_px - 1)};
  }
  return intrinsic;
}

}  // namespace

Result<Scene> SceneFromImages(const std::string& folder,
                              const IntrinsicSource& intrinsics,
                              const std::vector<std::string>& excluded) {
  if (intrinsics.calibration.has_value() == intrinsics.focal_px.has_value()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "give either a calibration matrix or a focal length");
  }
  auto names = ListImages(folder);
  if (!names) return tl::unexpected<Error>(names.error());
  for (const std::string& name : excluded) {
    const auto kept = std::remove_if(
        names->begin(), names->end(),
        [&](const auto& filename) { return NameFits(name, filename); });
    if (kept == names->end()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "no image '" + name + "' to exclude", folder);
    }
    names->erase(kept, names->end());
  }
  if (names->size() < 2) {
    return MakeError(ErrorCode::kInsufficientData,
                     "at least two images are needed, found " +
                         std::to_string(names->size()),
                     folder);
  }

  Scene scene;
  scene.root_path = folder;
  std::map<std::pair<int, int>, IntrinsicId> intrinsic_of_size;
  for (std::size_t n = 0; n < names->size(); ++n) {
    const std::string& name = (*names)[n];
    const auto size = ReadImageSize((fs::path(folder) / name).string());
    if (!size) return tl::unexpected<Error>(size.error());
    const auto [entry, is_new] = intrinsic_of_size.emplace(
        std::make_pair(size->width_px, size->height_px),
        static_cast<IntrinsicId>(intrinsic_of_size.size()));
    if (is_new) {
      const Intrinsic intrinsic = MakeIntrinsic(intrinsics, *size);
      if (const Status valid = intrinsic.Validate(); !valid) {
        return MakeError(ErrorCode::kInvalidArgument, valid.error().message);
      }
      scene.intrinsics[entry->second] = intrinsic;
    }
    View view;
    view.filename = name;
    view.width_px = size->width_px;
    view.height_px = size->height_px;
    view.intrinsic_id = entry->second;
    view.pose_id = static_cast<PoseId>(n);
    scene.views[static_cast<ViewId>(n)] = view;
  }
  return scene;
}

Result<std::vector<ViewId>> FindViews(const Scene& scene,
                                      const std::vector<std::string>& names) {
  std::set<ViewId> found;
  for (const std::string& name : names) {
    bool fits = false;
    for (const auto& [id, view] : scene.views) {
      if (NameFits(name, view.filename) || name == std::to_string(id)) {
        found.insert(id);
        fits = true;
      }
    }
    if (!fits) {
      return MakeError(ErrorCode::kInvalidArgument, "no view '" + name + "'");
    }
  }
  return std::vector<ViewId>(found.begin(), found.end());
}

}  // namespace lowlap
