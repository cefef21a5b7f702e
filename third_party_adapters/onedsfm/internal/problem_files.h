#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/types.h"

namespace lowlap::onedsfm {

using ImageIndex = std::uint32_t;

/// One line of EGs.txt, as the file has it.
struct RelativeGeometry {
  ImageIndex i = 0;
  ImageIndex j = 0;
  Mat3 rotation = Mat3::Identity();  // camera i from camera j
  Vec3 direction = Vec3::UnitX();    // of camera j, in camera i; unit
};
Result<std::vector<RelativeGeometry>> ParseGeometries(std::string_view text,
                                                      const std::string& file);

/// cc.txt: image indices.
Result<std::vector<ImageIndex>> ParseIndices(std::string_view text,
                                             const std::string& file);

/// One image of coords.txt.
struct ImageKeys {
  std::string name;
  Vec2 half_size_px = Vec2::Zero();
  double focal_px = 0;        // 0: unknown
  std::vector<Vec2> keys_px;  // first pixel's centre: (1, 1)
};
Result<std::map<ImageIndex, ImageKeys>> ParseCoords(std::string_view text,
                                                    const std::string& file);

/// tracks.txt: (image, key) pairs per track.
using KeyTrack = std::vector<std::pair<ImageIndex, std::uint32_t>>;
Result<std::vector<KeyTrack>> ParseTracks(std::string_view text,
                                          const std::string& file);

}  // namespace lowlap::onedsfm
