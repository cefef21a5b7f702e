#include "lowlap/pipeline/internal/measure/calibration_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/measure/exif.h"

namespace lowlap {
namespace {

using Size = std::pair<int, int>;  // width, height

std::string Text(const ImageSize& size) {
  return Format("%d x %d", size.width_px, size.height_px);
}

// Distinct sizes, the most frequent first.
std::vector<ImageSize> ByFrequency(const std::vector<ImageSize>& sizes) {
  std::map<Size, int> counts;
  for (const ImageSize& size : sizes) {
    ++counts[{size.width_px, size.height_px}];
  }
  std::vector<std::pair<int, Size>> order;
  order.reserve(counts.size());
  for (const auto& [size, count] : counts) order.emplace_back(-count, size);
  std::sort(order.begin(), order.end());
  std::vector<ImageSize> result;
  result.reserve(order.size());
  for (const auto& entry : order) {
    result.push_back({entry.second.first, entry.second.second});
  }
  return result;
}

}  // namespace

Intrinsic Resized(const Intrinsic& intrinsic, const ImageSize& size) {
  Intrinsic resized = intrinsic;
  const Vec2 scale(static_cast<double>(size.width_px) / intrinsic.width_px,
                   static_cast<double>(size.height_px) / intrinsic.height_px);
  resized.width_px = size.width_px;
  resized.height_px = size.height_px;
  resized.fx_px *= scale.x();
  resized.fy_px *= scale.y();
  if (intrinsic.model != CameraModel::kSpherical) {
    resized.principal_point_px =
        scale.cwiseProduct(intrinsic.principal_point_px + Vec2(0.5, 0.5)) -
        Vec2(0.5, 0.5);
  }
  return resized;
}

std::optional<Intrinsic> Turned(const Intrinsic& intrinsic, QuarterTurn turn) {
  if (intrinsic.model == CameraModel::kBrownT2 ||
      intrinsic.model == CameraModel::kSpherical) {
    return std::nullopt;
  }
  Intrinsic turned = intrinsic;
  std::swap(turned.width_px, turned.height_px);
  std::swap(turned.fx_px, turned.fy_px);
  const Vec2& point = intrinsic.principal_point_px;
  turned.principal_point_px =
      turn == QuarterTurn::kClockwise
          ? Vec2(intrinsic.height_px - 1 - point.y(), point.x())
          : Vec2(point.y(), intrinsic.width_px - 1 - point.x());
  return turned;
}

bool HasShapeOf(const ImageSize& size, const ImageSize& of) {
  // One of the two sides was rounded, the other less than a pixel off.
  const auto fits = [&](double scale) {
    return std::abs(scale * of.width_px - size.width_px) <= 1 &&
           std::abs(scale * of.height_px - size.height_px) <= 1;
  };
  return fits(static_cast<double>(size.width_px) / of.width_px) ||
         fits(static_cast<double>(size.height_px) / of.height_px);
}

bool IsPlausibleFocal(double focal_px, const ImageSize& size) {
  const int longer_px = std::max(size.width_px, size.height_px);
  return focal_px >= 0.2 * longer_px && focal_px <= 30 * longer_px;
}

std::optional<std::string> ImplausibleFocals(const Scene& scene) {
  std::set<IntrinsicId> used;
  for (const auto& entry : scene.views) used.insert(entry.second.intrinsic_id);
  std::string first;
  std::size_t count = 0;
  for (const auto& [id, intrinsic] : scene.intrinsics) {
    const ImageSize size = {intrinsic.width_px, intrinsic.height_px};
    if (used.count(id) == 0 || intrinsic.model == CameraModel::kFisheye ||
        intrinsic.model == CameraModel::kSpherical) {
      continue;
    }
    const double focal_px = IsPlausibleFocal(intrinsic.fx_px, size)
                                ? intrinsic.fy_px
                                : intrinsic.fx_px;
    if (IsPlausibleFocal(focal_px, size) || ++count > 1) continue;
    first = Format(
        "a focal length of %.4g px for photographs of %d x %d: %.3g degrees of "
        "view; it is meant in pixels, not in millimetres",
        focal_px, size.width_px, size.height_px,
        DegFromRad(2 * std::atan(0.5 * std::max(size.width_px, size.height_px) /
                                 focal_px)));
  }
  if (count == 0) return std::nullopt;
  if (count > 1) first += Format(" (and %zu more such cameras)", count - 1);
  return first;
}

double PrincipalPointOffset(const Intrinsic& intrinsic, const ImageSize& size) {
  const Vec2 middle(0.5 * (size.width_px - 1), 0.5 * (size.height_px - 1));
  const Vec2 offset = intrinsic.principal_point_px - middle;
  return std::max(std::abs(offset.x()) / size.width_px,
                  std::abs(offset.y()) / size.height_px);
}

Result<FittedIntrinsic> FitToPhotograph(const Intrinsic& given,
                                        const std::string& path,
                                        const ImageSize& size) {
  const ImageSize made_for{given.width_px, given.height_px};
  if (made_for.width_px == size.width_px &&
      made_for.height_px == size.height_px) {
    return FittedIntrinsic{given, {}};
  }
  const auto scaled_by = [&](const Intrinsic& from) {
    return from.width_px == size.width_px
               ? std::string()
               : Format("scaled by %.4g",
                        static_cast<double>(size.width_px) / from.width_px);
  };
  if (HasShapeOf(size, made_for)) {
    return FittedIntrinsic{Resized(given, size), scaled_by(given)};
  }
  const auto refuse = [&](const std::string& why) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the photograph has " + Text(size) +
                         " pixels, its calibration is for " + Text(made_for) +
                         ": " + why +
                         "; exclude it, or give intrinsics of its own",
                     path);
  };
  if (!HasShapeOf(size, {made_for.height_px, made_for.width_px})) {
    return refuse("the shapes differ");
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto exif, ReadExif(path, size));
  // The upright picture is the stored one turned clockwise (6) or against (8).
  if (exif.orientation != 6 && exif.orientation != 8) {
    return refuse("it was turned, and its EXIF data do not say which way");
  }
  const QuarterTurn back = exif.orientation == 6
                               ? QuarterTurn::kCounterclockwise
                               : QuarterTurn::kClockwise;
  const std::optional<Intrinsic> turned = Turned(given, back);
  if (!turned) {
    return refuse("its distortion cannot be turned with it");
  }
  std::string change =
      std::string("turned a quarter ") +
      (back == QuarterTurn::kClockwise ? "clockwise" : "counterclockwise") +
      ", as its EXIF orientation says";
  if (const std::string scaled = scaled_by(*turned); !scaled.empty()) {
    change += ", and " + scaled;
  }
  return FittedIntrinsic{Resized(*turned, size), std::move(change)};
}

Result<CalibratedSize> FindCalibratedSize(const Intrinsic& calibration,
                                          const std::vector<std::string>& paths,
                                          const std::vector<ImageSize>& sizes) {
  const std::vector<ImageSize> candidates = ByFrequency(sizes);
  std::optional<ImageSize> stored;
  double least_offset = kCentredShare;
  for (const ImageSize& size : candidates) {
    const double offset = PrincipalPointOffset(calibration, size);
    if (offset <= kSureShare) return CalibratedSize{size, {}};
    if (!stored && offset <= kCentredShare) {
      stored = size;
      least_offset = 0.5 * offset;
    }
  }
  // Shrunk copies often keep the size of the original in their EXIF data;
  // turned ones are all there is where every photograph stands. If a stored
  // size would do, another must do clearly better.
  for (std::size_t n = 0; n < paths.size(); ++n) {
    LOWLAP_ASSIGN_OR_RETURN(const auto exif, ReadExif(paths[n], sizes[n]));
    const ImageSize upright{sizes[n].height_px, sizes[n].width_px};
    for (const ImageSize& size :
         {exif.taken, ImageSize{exif.taken.height_px, exif.taken.width_px},
          upright}) {
      if (size.width_px > 0 && size.height_px > 0 &&
          PrincipalPointOffset(calibration, size) <= least_offset) {
        return CalibratedSize{size, {}};
      }
    }
  }
  if (stored) return CalibratedSize{*stored, {}};
  const Vec2& point = calibration.principal_point_px;
  const ImageSize& size = candidates.front();
  const double offset = PrincipalPointOffset(calibration, size);
  if (offset <= kCroppedShare) {
    return CalibratedSize{
        size,
        Format("the principal point (%.1f, %.1f) lies %.0f %% of the "
               "photographs' side from their middle: unless they are crops, "
               "the calibration is that of other photographs",
               point.x(), point.y(), 100 * offset)};
  }
  const std::size_t first = static_cast<std::size_t>(
      std::find_if(sizes.begin(), sizes.end(),
                   [&](const ImageSize& s) {
                     return s.width_px == size.width_px &&
                            s.height_px == size.height_px;
                   }) -
      sizes.begin());
  return MakeError(
      ErrorCode::kInvalidArgument,
      Format("the calibration does not fit this photograph: the principal "
             "point (%.1f, %.1f) would be the middle of about %.0f x %.0f "
             "pixels, it has %d x %d; scale fx, fy, cx and cy to the size of "
             "the photographs",
             point.x(), point.y(), 2 * point.x() + 1, 2 * point.y() + 1,
             size.width_px, size.height_px),
      paths[first]);
}

Result<ImageSize> FindCommonSize(const std::vector<std::string>& paths,
                                 const std::vector<ImageSize>& sizes) {
  std::vector<ImageSize> lying = sizes;
  for (ImageSize& size : lying) {
    if (size.height_px > size.width_px) {
      std::swap(size.width_px, size.height_px);
    }
  }
  const ImageSize common = ByFrequency(lying).front();
  const auto is_common = [&](const ImageSize& size) {
    return size.width_px == common.width_px &&
           size.height_px == common.height_px;
  };
  if (2 * std::count_if(lying.begin(), lying.end(), is_common) >
      static_cast<std::ptrdiff_t>(lying.size())) {
    return common;
  }
  const auto other = std::find_if_not(lying.begin(), lying.end(), is_common);
  return MakeError(
      ErrorCode::kInvalidArgument,
      "the photographs have different sizes, most of them not " + Text(common) +
          ": one focal length does not say which it is for; this one has " +
          Text(*other),
      paths[static_cast<std::size_t>(other - lying.begin())]);
}

}  // namespace lowlap
