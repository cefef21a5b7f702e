#pragma once

#include <optional>
#include <string>

#include "lowlap/features/internal/image.h"

namespace lowlap {

/// What the bytes of an image file say of it before anything is decoded.
struct ImageHead {
  ImageSize size;           // both positive
  bool is_cut_off = false;  // a JPEG file whose end is not there
};

/// Of JPEG, PNG, TIFF, BMP, WebP, and PBM, PGM or PPM files; nullopt for
/// anything else.
std::optional<ImageHead> ReadImageHead(const std::string& bytes);

/// The bytes of a TIFF file that asks to be turned or mirrored, without that;
/// nullopt for all other files.
std::optional<std::string> WithoutTiffOrientation(const std::string& bytes);

}  // namespace lowlap
