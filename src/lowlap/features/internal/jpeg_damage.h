#pragma once

#include <optional>
#include <string>

namespace lowlap {

/// What is lost of the image in a JPEG file, in libjpeg's words, such as
/// "Corrupt JPEG data: premature end of data segment"; nullopt where nothing
/// is, for other files, and for files of more than a hundred scans, which are
/// not read through. Decoders fill what is lost with grey, or with what belongs
/// elsewhere, and call that an image. A few bytes behind the image, or padding,
/// as some cameras leave it, are no loss.
///
/// It decodes the image at an eighth of its size.
std::optional<std::string> JpegDamage(const std::string& bytes);

}  // namespace lowlap
