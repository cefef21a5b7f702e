#pragma once

#include <cstdint>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// A patch of one grey on a surface, in metres from the corner of its cell.
struct TonePatch {
  Vec2 corner_m = Vec2::Zero();
  Vec2 size_m = Vec2::Zero();
  double tone = 0;  // 0 black, 1 white
};

/// A picture that is found nowhere else: noise of several octaves.
struct Poster {
  Vec2 corner_m = Vec2::Zero();
  Vec2 size_m = Vec2::Zero();
  std::uint64_t seed = 0;
};

/// What is painted on a surface: a ground of one grey with some grain, on it
/// the patches of a cell that repeats without end along both axes, and over all
/// of it the posters.
struct Texture {
  double tone = 0.7;
  double grain = 0;  // amplitude of the ground's noise, found nowhere else
  std::uint64_t grain_seed = 0;
  /// The cell's size; zero: nothing repeats.
  Vec2 cell_m = Vec2::Zero();
  Vec2 cell_origin_m = Vec2::Zero();
  std::vector<TonePatch> cell;  // later ones over earlier ones
  std::vector<Poster> posters;

  /// The grey at a place of the surface, in [0, 1].
  double ToneAt(const Vec2& place_m) const;
};

}  // namespace lowlap
