#pragma once

#include <string>

#include "lowlap/core/result.h"

namespace lowlap {

/// A JPEG file of an image file's bytes, in colour, at most `max_width_px` wide
/// and of the same shape, as stored (ReadGrayImage). `path` is for messages.
/// The same bytes give the same thumbnail.
/// Errors: those of DecodeGrayImage.
Result<std::string> MakeThumbnail(const std::string& bytes, int max_width_px,
                                  const std::string& path);

}  // namespace lowlap
