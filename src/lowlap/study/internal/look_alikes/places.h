#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "lowlap/features/internal/image.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// What repeats without end in two photographs: the tiles of a floor, the
/// windows of a facade, or the goods on a wall of shelves.
enum class RepeatedKind { kTiles, kWindows, kShelves };

inline constexpr std::array<RepeatedKind, 3> kRepeatedKinds = {
    RepeatedKind::kTiles, RepeatedKind::kWindows, RepeatedKind::kShelves};

/// "tiles", "windows", "shelves", and back.
const char* RepeatedKindName(RepeatedKind kind);
std::optional<RepeatedKind> RepeatedKindFromName(const std::string& name);

/// Two photographs, with what repeats in both of them.
struct PhotographPair {
  Intrinsic intrinsic;
  std::array<GrayImage, 2> images;
  /// They show one place, by these cameras; else two places that have the
  /// repeated pattern in common and nothing else.
  bool is_same_place = false;
  RigidTransform cam2_from_cam1;  // of one place only
};

/// Draws cells, places and cameras, and renders them: 800 x 600 pixels, at 64
/// degrees of view. The same kind and seed give the same photographs, and the
/// first photograph is that of the other choice of `is_same_place`, too.
PhotographPair MakePhotographPair(RepeatedKind kind, bool is_same_place,
                                  std::uint64_t seed);

}  // namespace lowlap
