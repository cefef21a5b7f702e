#include "lowlap/pipeline/image_collection.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/pipeline/internal/measure/calibration_fit.h"
#include "lowlap/pipeline/internal/measure/exif.h"
#include "lowlap/scene/internal/view_names.h"

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

// Other systems keep what they know of a file in a hidden one of its name.
bool IsHidden(const fs::path& path) {
  return path.filename().string().front() == '.';
}

bool NameFits(const std::string& name, const std::string& filename) {
  return name == filename || name == fs::path(filename).stem().string();
}

Error WithPath(const char* message, const std::string& path) {
  return {ErrorCode::kInvalidArgument, message, Escaped(path), ""};
}

Result<std::vector<std::string>> ListImages(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return MakeError(ErrorCode::kNotFound, "no such image folder", folder);
  }
  if (!IsUtf8(folder)) {
    return tl::unexpected<Error>(
        WithPath("the folder's name is not UTF-8", folder));
  }
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (IsHidden(entry->path()) || !HasImageExtension(entry->path())) continue;
    const std::string path = entry->path().string();
    std::error_code unreadable;
    const fs::file_status status = fs::status(entry->path(), unreadable);
    if (!fs::exists(status)) {  // a link that leads nowhere, or in a circle
      return MakeError(ErrorCode::kIo, unreadable.message(), Escaped(path));
    }
    if (!fs::is_regular_file(status)) continue;
    names.push_back(entry->path().filename().string());
    if (!IsUtf8(names.back())) {
      return tl::unexpected<Error>(
          WithPath("the file's name is not UTF-8; rename it", path));
    }
  }
  if (error) return MakeError(ErrorCode::kIo, error.message(), folder);
  std::sort(names.begin(), names.end());
  return names;
}

bool HasImagesInSubfolders(const std::string& folder) {
  std::error_code error;
  fs::recursive_directory_iterator entry(
      folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator();
       entry.increment(error)) {
    std::error_code unreadable;
    if (IsHidden(entry->path())) {
      entry.disable_recursion_pending();
    } else if (entry.depth() > 0 && HasImageExtension(entry->path()) &&
               entry->is_regular_file(unreadable)) {
      return true;
    }
  }
  return false;
}

// The images of the folder that are not excluded, two at least.
Result<std::vector<std::string>> ListTaken(
    const std::string& folder, const std::vector<std::string>& excluded,
    std::vector<std::string>* notes) {
  LOWLAP_ASSIGN_OR_RETURN(auto names, ListImages(folder));
  for (const std::string& name : excluded) {
    const auto kept = std::remove_if(
        names.begin(), names.end(),
        [&](const auto& filename) { return NameFits(name, filename); });
    if (kept == names.end()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "no image '" + name + "' to exclude", folder);
    }
    names.erase(kept, names.end());
  }
  const std::string left_out = HasImagesInSubfolders(folder)
                                   ? "photographs in subfolders are not taken"
                                   : "";
  if (names.size() < 2) {
    return MakeError(ErrorCode::kInsufficientData,
                     "at least two images are needed, found " +
                         std::to_string(names.size()) +
                         (left_out.empty() ? "" : "; " + left_out),
                     folder);
  }
  if (!left_out.empty()) notes->push_back(left_out);
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

Result<Intrinsic> FromExif(const std::string& path, const ImageSize& size) {
  LOWLAP_ASSIGN_OR_RETURN(const auto exif, ReadExif(path, size));
  if (!exif.focal_px) {
    return MakeError(
        ErrorCode::kInsufficientData,
        "holds no focal length in EXIF data, which is read from JPEG "
        "files; give a calibration matrix, a focal length, or a "
        "file of intrinsics",
        path);
  }
  return WithFocal(*exif.focal_px, size);
}

// How many names, from the last on, two paths have in common.
int CommonNames(const fs::path& a, const fs::path& b) {
  const std::vector<fs::path> in_a(a.begin(), a.end()),
      in_b(b.begin(), b.end());
  const auto ends =
      std::mismatch(in_a.rbegin(), in_a.rend(), in_b.rbegin(), in_b.rend());
  return static_cast<int>(ends.first - in_a.rbegin());
}

// What an image is to have, before it is fitted to it.
struct GivenIntrinsic {
  Intrinsic intrinsic;
  IntrinsicId id = kInvalidId;  // in IntrinsicSource::scene
};

class IntrinsicsOfImages {
 public:
  // `common`: CommonIntrinsic.
  IntrinsicsOfImages(const IntrinsicSource& source,
                     const std::optional<Intrinsic>& common)
      : source_(source), common_(common) {
    if (!source.scene) return;
    for (const auto& [id, view] : source.scene->views) {
      if (source.scene->FindIntrinsic(id) != nullptr) {
        views_[fs::path(view.filename).filename().string()].push_back(&view);
      }
    }
  }

  Result<GivenIntrinsic> Find(const std::string& path, const ImageSize& size) {
    GivenIntrinsic given;
    if (source_.scene) {
      LOWLAP_ASSIGN_OR_RETURN(given.id, IdInScene(path));
      given.intrinsic = source_.scene->intrinsics.at(given.id);
    } else if (common_) {
      const bool stands = (size.height_px > size.width_px) !=
                          (common_->height_px > common_->width_px);
      given.intrinsic = source_.focal_px && stands
                            ? *Turned(*common_, QuarterTurn::kClockwise)
                            : *common_;
    } else {
      LOWLAP_ASSIGN_OR_RETURN(given.intrinsic, FromExif(path, size));
    }
    return given;
  }

  // Images that the scene does not list, and that have its only intrinsic.
  int num_unlisted() const { return num_unlisted_; }

 private:
  // Of views of one file name those count whose folders fit best.
  Result<IntrinsicId> IdInScene(const std::string& path) {
    const auto named = views_.find(fs::path(path).filename().string());
    if (named == views_.end()) return TheOnlyOne(path);
    const View* best = nullptr;
    int most = 0;
    for (const View* view : named->second) {
      const int common = CommonNames(view->PathBelowRoot(), path);
      if (common > most) {
        most = common;
        best = view;
      } else if (common == most && view->intrinsic_id != best->intrinsic_id) {
        return MakeError(ErrorCode::kInvalidArgument,
                         "'" + best->PathBelowRoot() + "' and '" +
                             view->PathBelowRoot() +
                             "' of the given scene have this file name, and "
                             "different intrinsics",
                         path);
      }
    }
    return best->intrinsic_id;
  }

  Result<IntrinsicId> TheOnlyOne(const std::string& path) {
    const auto& intrinsics = source_.scene->intrinsics;
    if (intrinsics.size() != 1) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "the given scene has no intrinsic for this image", path);
    }
    ++num_unlisted_;
    return intrinsics.begin()->first;
  }

  const IntrinsicSource& source_;
  const std::optional<Intrinsic>& common_;
  std::map<std::string, std::vector<const View*>> views_;  // by file name
  int num_unlisted_ = 0;
};

// One calibration for all photographs, with the size that it is for; a focal
// length alone is the same however a photograph is turned.
Result<std::optional<Intrinsic>> CommonIntrinsic(
    const IntrinsicSource& source, const std::vector<std::string>& paths,
    const std::vector<ImageSize>& sizes, std::vector<std::string>* notes) {
  if (source.calibration) {
    const Mat3& k = *source.calibration;
    Intrinsic intrinsic;
    intrinsic.fx_px = k(0, 0);
    intrinsic.fy_px = k(1, 1);
    intrinsic.principal_point_px = {k(0, 2), k(1, 2)};
    LOWLAP_ASSIGN_OR_RETURN(const auto made_for,
                            FindCalibratedSize(intrinsic, paths, sizes));
    intrinsic.width_px = made_for.size.width_px;
    intrinsic.height_px = made_for.size.height_px;
    if (!made_for.warning.empty()) notes->push_back(made_for.warning);
    return std::optional<Intrinsic>(intrinsic);
  }
  if (source.focal_px) {
    LOWLAP_ASSIGN_OR_RETURN(const auto size, FindCommonSize(paths, sizes));
    return std::optional<Intrinsic>(WithFocal(*source.focal_px, size));
  }
  return std::optional<Intrinsic>();
}

// The id of an intrinsic in the scene, where it is put unless it is there:
// `wanted`, if that is free.
IntrinsicId Add(const Intrinsic& intrinsic, IntrinsicId wanted, Scene* scene) {
  auto& intrinsics = scene->intrinsics;
  if (wanted != kInvalidId) {
    const auto [entry, is_new] = intrinsics.emplace(wanted, intrinsic);
    if (is_new || entry->second == intrinsic) return wanted;
  }
  for (const auto& [id, known] : intrinsics) {
    if (known == intrinsic) return id;
  }
  const IntrinsicId id =
      intrinsics.empty() ? 0 : intrinsics.rbegin()->first.value() + 1;
  intrinsics[id] = intrinsic;
  return id;
}

}  // namespace

Result<Scene> SceneFromImages(const std::string& folder,
                              const IntrinsicSource& intrinsics,
                              const std::vector<std::string>& excluded,
                              std::vector<std::string>* notes) {
  if (intrinsics.calibration.has_value() + intrinsics.focal_px.has_value() +
          intrinsics.scene.has_value() >
      1) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "give one of a calibration matrix, a focal length, and a "
                     "scene with intrinsics");
  }
  std::vector<std::string> unused;
  if (notes == nullptr) notes = &unused;
  LOWLAP_ASSIGN_OR_RETURN(const auto names, ListTaken(folder, excluded, notes));
  std::vector<std::string> paths;
  std::vector<ImageSize> sizes;
  for (const std::string& name : names) {
    paths.push_back((fs::path(folder) / name).string());
    LOWLAP_ASSIGN_OR_RETURN(const auto size, ReadImageSize(paths.back()));
    sizes.push_back(size);
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto common,
                          CommonIntrinsic(intrinsics, paths, sizes, notes));

  IntrinsicsOfImages of_images(intrinsics, common);
  Scene scene;
  scene.root_path = folder;
  for (std::size_t n = 0; n < names.size(); ++n) {
    LOWLAP_ASSIGN_OR_RETURN(const auto given,
                            of_images.Find(paths[n], sizes[n]));
    LOWLAP_ASSIGN_OR_RETURN(
        const auto fitted,
        FitToPhotograph(given.intrinsic, paths[n], sizes[n]));
    if (const Status valid = fitted.intrinsic.Validate(); !valid) {
      return MakeError(valid.error().code, valid.error().message, paths[n]);
    }
    if (!fitted.change.empty()) {
      notes->push_back(names[n] + ": the calibration was " + fitted.change);
    }
    View view;
    view.filename = names[n];
    view.width_px = sizes[n].width_px;
    view.height_px = sizes[n].height_px;
    view.intrinsic_id = Add(fitted.intrinsic, given.id, &scene);
    view.pose_id = static_cast<PoseId>(n);
    scene.views[static_cast<ViewId>(n)] = view;
  }
  if (of_images.num_unlisted() > 0) {
    notes->push_back("the given scene does not list " +
                     std::to_string(of_images.num_unlisted()) +
                     " of the photographs: they have its only intrinsic");
  }
  if (auto note = ImplausibleFocals(scene)) notes->push_back(std::move(*note));
  return scene;
}

Result<std::vector<ViewId>> FindViews(const Scene& scene,
                                      const std::vector<std::string>& words) {
  const ViewNames names(scene);
  std::set<ViewId> found;
  for (const std::string& word : words) {
    LOWLAP_ASSIGN_OR_RETURN(const ViewId view, names.Find(word));
    found.insert(view);
  }
  return std::vector<ViewId>(found.begin(), found.end());
}

}  // namespace lowlap
