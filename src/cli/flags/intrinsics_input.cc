#include "cli/flags/intrinsics_input.h"

#include "third_party_adapters/internal/camera_files.h"

namespace lowlap::cli {

void AddIntrinsicsFlags(CLI::App* command, IntrinsicsFlags* flags) {
  Option matrix = AddOption(
      command, "--intrinsics", flags->file,
      "K.txt: the 3x3 calibration matrix of all photographs, in pixels "
      "(fx and fy are both used); or a scene file whose views, by file name, "
      "have intrinsics of any model. Without it and --focal: from EXIF data");
  Option focal =
      AddOption(command, "--focal", flags->focal_px,
                "Focal length in pixels; principal point in the middle")
          .Must(Check::Positive());
  matrix.Excludes(focal);
}

Result<IntrinsicSource> ReadIntrinsics(const IntrinsicsFlags& flags) {
  if (!flags.file.empty()) return ReadIntrinsicSource(flags.file);
  IntrinsicSource source;
  source.focal_px = flags.focal_px;
  return source;
}

}  // namespace lowlap::cli
