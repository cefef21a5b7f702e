#pragma once

#include <optional>
#include <string>

#include "cli/flags/command_line.h"
#include "lowlap/core/result.h"
#include "lowlap/pipeline/image_collection.h"

namespace lowlap::cli {

/// Where the interior orientation of photographs comes from; without any of
/// these, from EXIF data.
struct IntrinsicsFlags {
  std::string file;
  std::optional<double> focal_px;

  bool AreGiven() const { return !file.empty() || focal_px.has_value(); }
};

/// --intrinsics and --focal
void AddIntrinsicsFlags(CLI::App* command, IntrinsicsFlags* flags);

/// Reads the calibration matrix, or the scene whose intrinsics are meant.
Result<IntrinsicSource> ReadIntrinsics(const IntrinsicsFlags& flags);

}  // namespace lowlap::cli
