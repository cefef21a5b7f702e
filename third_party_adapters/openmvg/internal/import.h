#pragma once

#include <string>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"
#include "third_party_adapters/openmvg/internal/matches.h"

namespace lowlap::openmvg {

struct ImportOptions {
  /// The match file: a path, or a name within the matches folder. Empty: the
  /// first that exists of matches.f.txt, matches.f.bin, matches.e.txt,
  /// matches.e.bin (the order of openMVG_main_SfM), matches.putative.txt,
  /// matches.putative.bin.
  std::string match_file;
};

/// What OpenMVG's files hold before any pose is known: the input of the
/// two-view stage.
struct ImportedProject {
  /// Views, intrinsics, and features[view].points_px whose index is the line of
  /// the .feat file.
  Scene scene;
  PairMatches matches;
  std::string match_file;  // the path that was read
  /// Pairs of the match file that name a view the listing does not have.
  int num_dropped_pairs = 0;
};

/// Reads a listing (sfm_data.json, .bin or .xml) and, from `matches_dir`, the
/// features of its views (<image name without extension>.feat) and a match
/// file.
///
/// Errors, each with its file: kNotFound for a missing listing, .feat or match
/// file; kInvalidScene for a match whose index lies beyond the features of its
/// view, and for two views whose images share a name in different folders
/// (OpenMVG gives both the same .feat); and those of the single readers.
Result<ImportedProject> ImportProject(const std::string& sfm_data_path,
                                      const std::string& matches_dir,
                                      const ImportOptions& options = {});

}  // namespace lowlap::openmvg
