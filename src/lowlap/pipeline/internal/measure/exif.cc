#include "lowlap/pipeline/internal/measure/exif.h"

#include <libexif/exif-data.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/measure/calibration_fit.h"

namespace lowlap {
namespace {

using ExifPointer = std::unique_ptr<ExifData, decltype(&exif_data_unref)>;

// The first value of a tag as a positive number; nullopt if there is none.
std::optional<double> PositiveNumber(ExifData* data, ExifTag tag,
                                     ExifIfd part = EXIF_IFD_EXIF) {
  const ExifEntry* entry = exif_content_get_entry(data->ifd[part], tag);
  if (entry == nullptr || entry->data == nullptr || entry->components < 1 ||
      entry->size < exif_format_get_size(entry->format)) {
    return std::nullopt;
  }
  const ExifByteOrder order = exif_data_get_byte_order(data);
  double value = 0;
  switch (entry->format) {
    case EXIF_FORMAT_SHORT:
      value = exif_get_short(entry->data, order);
      break;
    case EXIF_FORMAT_LONG:
      value = exif_get_long(entry->data, order);
      break;
    case EXIF_FORMAT_RATIONAL: {
      const ExifRational ratio = exif_get_rational(entry->data, order);
      if (ratio.denominator == 0) return std::nullopt;
      value = static_cast<double>(ratio.numerator) / ratio.denominator;
      break;
    }
    default:
      return std::nullopt;
  }
  if (!(value > 0)) return std::nullopt;
  return value;
}

// Millimetres per unit of the focal plane's resolution; inches unless told.
double ResolutionUnitMm(ExifData* data) {
  const double unit =
      PositiveNumber(data, EXIF_TAG_FOCAL_PLANE_RESOLUTION_UNIT).value_or(2);
  if (unit == 3) return 10;     // centimetre
  if (unit == 4) return 1;      // millimetre
  if (unit == 5) return 0.001;  // micrometre
  return 25.4;
}

std::optional<double> FocalFromSensor(ExifData* data, const ImageSize& size) {
  const auto focal_mm = PositiveNumber(data, EXIF_TAG_FOCAL_LENGTH);
  const auto resolution =
      PositiveNumber(data, EXIF_TAG_FOCAL_PLANE_X_RESOLUTION);
  if (!focal_mm || !resolution) return std::nullopt;
  const double longer_px = std::max(size.width_px, size.height_px);
  const double longer_taken_px =
      std::max(PositiveNumber(data, EXIF_TAG_PIXEL_X_DIMENSION).value_or(0),
               PositiveNumber(data, EXIF_TAG_PIXEL_Y_DIMENSION).value_or(0));
  const double scale = longer_taken_px > 0 ? longer_px / longer_taken_px : 1;
  return *focal_mm * *resolution / ResolutionUnitMm(data) * scale;
}

std::optional<double> FocalFromFilm(ExifData* data, const ImageSize& size) {
  const auto focal_mm =
      PositiveNumber(data, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
  if (!focal_mm) return std::nullopt;
  return *focal_mm * std::hypot(size.width_px, size.height_px) /
         std::hypot(36.0, 24.0);
}

}  // namespace

Result<ExifGeometry> ReadExif(const std::string& path, const ImageSize& size) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
  ExifGeometry geometry;
  if (bytes.compare(0, 2, "\xff\xd8") != 0 ||
      bytes.size() > std::numeric_limits<unsigned>::max()) {
    return geometry;
  }
  const ExifPointer data(
      exif_data_new_from_data(
          reinterpret_cast<const unsigned char*>(bytes.data()),
          static_cast<unsigned>(bytes.size())),
      &exif_data_unref);
  if (data == nullptr) return geometry;
  const auto plausible = [&](std::optional<double> focal_px) {
    return focal_px && IsPlausibleFocal(*focal_px, size) ? focal_px
                                                         : std::nullopt;
  };
  geometry.focal_px = plausible(FocalFromSensor(data.get(), size));
  if (const auto film_px = plausible(FocalFromFilm(data.get(), size));
      film_px && !(geometry.focal_px &&
                   std::abs(*geometry.focal_px - *film_px) <= 0.1 * *film_px)) {
    geometry.focal_px = film_px;
  }
  const auto whole = [&](ExifTag tag, ExifIfd part, double limit) {
    const double value = PositiveNumber(data.get(), tag, part).value_or(0);
    return value <= limit ? static_cast<int>(value) : 0;
  };
  geometry.taken = {whole(EXIF_TAG_PIXEL_X_DIMENSION, EXIF_IFD_EXIF, 1e6),
                    whole(EXIF_TAG_PIXEL_Y_DIMENSION, EXIF_IFD_EXIF, 1e6)};
  geometry.orientation =
      std::max(1, whole(EXIF_TAG_ORIENTATION, EXIF_IFD_0, 8));
  return geometry;
}

}  // namespace lowlap
