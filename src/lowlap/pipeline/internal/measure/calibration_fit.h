#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The intrinsic of the image shrunk or enlarged to `size` (pixel centres are
/// integers: x' + 1/2 = s (x + 1/2)).
Intrinsic Resized(const Intrinsic& intrinsic, const ImageSize& size);

/// The intrinsic of the image turned by a quarter, clockwise or against it.
/// nullopt for the models that are not symmetric about the axis.
enum class QuarterTurn { kClockwise, kCounterclockwise };
std::optional<Intrinsic> Turned(const Intrinsic& intrinsic, QuarterTurn turn);

/// Whether `size` is `of` shrunk or enlarged: the same shape to within a pixel.
bool HasShapeOf(const ImageSize& size, const ImageSize& of);

/// Whether a focal length is one of a lens without distortion: 136 degrees of
/// view at most along the longer side, and two at least. Millimetres are not,
/// nor are lengths from the resolution of a print.
bool IsPlausibleFocal(double focal_px, const ImageSize& size);

/// What is wrong with the first focal length of the views that is not
/// plausible, and with how many more; nullopt: none. Fisheye lenses may see
/// more; panoramas have none.
std::optional<std::string> ImplausibleFocals(const Scene& scene);

/// How far a principal point lies from the middle of an image, as a share of
/// its width or height, whichever is more.
double PrincipalPointOffset(const Intrinsic& intrinsic, const ImageSize& size);

/// A principal point within the first bound of the middle is that of the image;
/// within the second, if no other size fits better: the lenses of cameras are
/// centred to a few percent. Between this and the third, only a crop explains
/// it; beyond, nothing does (the calibration of an image twice as large puts it
/// into the corner).
inline constexpr double kSureShare = 0.03;
inline constexpr double kCentredShare = 0.1;
inline constexpr double kCroppedShare = 0.25;

/// The calibration of one photograph, and what was done for it.
struct FittedIntrinsic {
  Intrinsic intrinsic;
  std::string change;  // for people: "scaled by 0.5 ..."; empty: nothing
};

/// `given`, made for an image of its own size, for the photograph at `path`:
/// itself if the sizes agree; resized where the shapes do; turned where the
/// photograph's EXIF orientation says that its pixels lie on their side.
/// kInvalidArgument, with the path, where neither is certain.
Result<FittedIntrinsic> FitToPhotograph(const Intrinsic& given,
                                        const std::string& path,
                                        const ImageSize& size);

/// The size of the photographs that a calibration matrix was made for, which it
/// does not say: the most frequent one whose middle is at the principal point,
/// or the size at which a photograph was taken (EXIF) if it is at the middle of
/// that, or nearer to it by half. Without one, the most frequent size, and a
/// warning, if the point lies as off the middle as crops have it.
/// kInvalidArgument otherwise.
struct CalibratedSize {
  ImageSize size;
  std::string warning;  // empty: none
};
Result<CalibratedSize> FindCalibratedSize(const Intrinsic& calibration,
                                          const std::vector<std::string>& paths,
                                          const std::vector<ImageSize>& sizes);

/// The size that a single focal length is meant for: that of more than half of
/// the photographs, lying or standing. kInvalidArgument if there is none.
Result<ImageSize> FindCommonSize(const std::vector<std::string>& paths,
                                 const std::vector<ImageSize>& sizes);

}  // namespace lowlap
