#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "third_party_adapters/internal/file_lines.h"

namespace lowlap::limap {

// A line of LIMAP, finaltracks/track_N.txt:
//
//   start, end                          6 numbers
//   number of segments, number of images
//   image_id_list  ids of the images
//   line_id_list   numbers of the segments in their images
//   line2d_list    x1 y1 x2 y2 of each
//   [node_id_list ..., score_list ..., line3d_list ...]
//   END

/// Errors: kParse with file and line, also for a line without length.
Result<FileLine> ParseLineTrack(std::string_view text, const std::string& file);

/// Numbers have ten decimals, as LIMAP writes them.
std::string FormatLineTrack(const FileLine& line);

}  // namespace lowlap::limap
