#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "lowlap/core/result.h"

namespace lowlap::limap {

// What stands where in a folder of LIMAP:
//
//   image_list.txt                                   ids and names
//   sparse/                                          a model of COLMAP
//   line_detections/D/segments/segments_ID.txt
//   line_matchings/D/E/M/matches_ID.txt
//   finaltracks/track_N.txt
//
// D is the detector, E the descriptor, M the matcher. sparse/ and the matches
// as text are ours: LIMAP keeps cameras and matches in pickled .npy files,
// which limap_text.py translates.

inline constexpr char kImageList[] = "image_list.txt";
inline constexpr char kModelFolder[] = "sparse";
inline constexpr char kSegmentFolder[] = "line_detections/lowlap/segments";
inline constexpr char kMatchFolder[] =
    "line_matchings/lowlap/feats_lowlap/lowlap";
inline constexpr char kTrackFolder[] = "finaltracks";

/// Whether the path is a folder of LIMAP.
bool IsLimapFolder(const std::string& path);

/// Files PREFIX_<number>EXTENSION of a folder by their numbers; none if there
/// is no such folder.
std::map<std::uint32_t, std::string> NumberedFiles(
    const std::string& folder, const std::string& prefix,
    const std::string& extension);

/// The only folder `depth` levels below `folder`; empty if there is none.
/// kUnsupported, with the names, if there are several.
Result<std::string> OnlyFolderBelow(const std::string& folder, int depth);

}  // namespace lowlap::limap
