#include "lowlap/pipeline/image_collection.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>
#include <system_error>

#include "lowlap/features/image.h"
#include "lowlap/pipeline/internal/exif.h"

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

Intrinsic WithFocal(double focal_px, const ImageSize& size) {
  Intrinsic intrinsic;
  intrinsic.width_px = size.width_px;
  intrinsic.height_px = size.height_px;
  intrinsic.fx_px = intrinsic.fy_px = focal_px;
  // Pixel centres are integers, so the middle of the image is at (w - 1) / 2.
  intrinsic.principal_point_px = {0.5 * (size.width_px - 1),
                                  0.5 * (size.height_px - 1)};
  return intrinsic;
}

Intrinsic WithCalibration(const Mat3& k, const ImageSize& size) {
  Intrinsic intrinsic;
  intrinsic.width_px = size.width_px;
  intrinsic.height_px = size.height_px;
  intrinsic.fx_px = k(0, 0);
  intrinsic.fy_px = k(1, 1);
  intrinsic.principal_point_px = {k(0, 2), k(1, 2)};
  return intrinsic;
}

Result<Intrinsic> FromExif(const std::string& path, const ImageSize& size) {
  const auto focal_px = ReadExifFocalPx(path, size);
  if (!focal_px) return tl::unexpected<Error>(focal_px.error());
  if (!*focal_px) {
    return MakeError(ErrorCode::kInsufficientData,
                     "holds no focal length in EXIF data; give a calibration "
                     "matrix, a focal length, or a file of intrinsics",
                     path);
  }
  return WithFocal(**focal_px, size);
}

// The id of the intrinsic in a scene that an image is to have.
Result<IntrinsicId> FindInScene(const Scene& scene, const std::string& name,
                                const std::string& path,
                                const ImageSize& size) {
  IntrinsicId id = kInvalidId;
  for (const auto& [view_id, view] : scene.views) {
    if (fs::path(view.filename).filename() == name &&
        scene.FindIntrinsic(view_id) != nullptr) {
      id = view.intrinsic_id;
    }
  }
  if (id == kInvalidId && scene.intrinsics.size() == 1) {
    id = scene.intrinsics.begin()->first;
  }
  if (id == kInvalidId) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the given scene has no intrinsic for this image", path);
  }
  const Intrinsic& intrinsic = scene.intrinsics.at(id);
  if (intrinsic.width_px != size.width_px ||
      intrinsic.height_px != size.height_px) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the image has " + std::to_string(size.width_px) + " x " +
                         std::to_string(size.height_px) +
                         " pixels, the given intrinsic " +
                         std::to_string(intrinsic.width_px) + " x " +
                         std::to_string(intrinsic.height_px),
                     path);
  }
  return id;
}

// Adds the intrinsic of an image to the scene, unless it is there.
Result<IntrinsicId> AddIntrinsic(const IntrinsicSource& source,
                                 const std::string& name,
                                 const std::string& path, const ImageSize& size,
                                 Scene* scene) {
  Intrinsic intrinsic;
  IntrinsicId id = kInvalidId;
  if (source.scene) {
    const auto found = FindInScene(*source.scene, name, path, size);
    if (!found) return found;
    id = *found;
    intrinsic = source.scene->intrinsics.at(id);
  } else if (source.calibration) {
    intrinsic = WithCalibration(*source.calibration, size);
  } else if (source.focal_px) {
    intrinsic = WithFocal(*source.focal_px, size);
  } else {
    const auto from_exif = FromExif(path, size);
    if (!from_exif) return tl::unexpected<Error>(from_exif.error());
    intrinsic = *from_exif;
  }
  if (const Status valid = intrinsic.Validate(); !valid) {
    return MakeError(ErrorCode::kInvalidArgument, valid.error().message);
  }
  if (id == kInvalidId) {
    const auto equal = std::find_if(
        scene->intrinsics.begin(), scene->intrinsics.end(),
        [&](const auto& entry) { return entry.second == intrinsic; });
    id = equal != scene->intrinsics.end()
             ? equal->first
             : static_cast<IntrinsicId>(scene->intrinsics.size());
  }
  scene->intrinsics.emplace(id, intrinsic);
  return id;
}

}  // namespace

Result<Scene> SceneFromImages(const std::string& folder,
                              const IntrinsicSource& intrinsics,
                              const std::vector<std::string>& excluded) {
  if (intrinsics.calibration.has_value() + intrinsics.focal_px.has_value() +
          intrinsics.scene.has_value() >
      1) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "give one of a calibration matrix, a focal length, and a "
                     "scene with intrinsics");
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
  for (std::size_t n = 0; n < names->size(); ++n) {
    const std::string& name = (*names)[n];
    const std::string path = (fs::path(folder) / name).string();
    const auto size = ReadImageSize(path);
    if (!size) return tl::unexpected<Error>(size.error());
    const auto intrinsic = AddIntrinsic(intrinsics, name, path, *size, &scene);
    if (!intrinsic) return tl::unexpected<Error>(intrinsic.error());
    View view;
    view.filename = name;
    view.width_px = size->width_px;
    view.height_px = size->height_px;
    view.intrinsic_id = *intrinsic;
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
