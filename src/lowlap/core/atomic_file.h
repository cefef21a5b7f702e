#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "lowlap/core/result.h"

namespace lowlap {

/// Writes a file so that it appears whole or not at all: `write` fills a
/// stream on a temporary name in the same folder, which is then renamed. On
/// any failure the temporary file is removed and `path` is left as it was.
Status WriteFileAtomically(const std::string& path,
                           const std::function<Status(std::ostream&)>& write);

/// The whole file as bytes; kNotFound or kIo with the path otherwise.
Result<std::string> ReadWholeFile(const std::string& path);

}  // namespace lowlap
