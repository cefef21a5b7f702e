#include "lowlap/study/internal/look_alikes/texture.h"

#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

/// Of the finest noise of a poster and of the grain, in metres.
constexpr double kFinestM = 0.02;

bool IsInside(const Vec2& place, const Vec2& corner, const Vec2& size) {
  const Vec2 inner = place - corner;
  return (inner.array() >= 0).all() && (inner.array() < size.array()).all();
}

/// Uniform in [0, 1), drawn for a knot of the lattice of noise.
double KnotValue(std::int64_t x, std::int64_t y, std::uint64_t seed) {
  const auto row = static_cast<std::uint64_t>(y) * 0x9e3779b97f4a7c15;
  return Random(seed + row, static_cast<std::uint64_t>(x)).Uniform();
}

/// Values at knots `step_m` apart, bilinear between them.
double Noise(const Vec2& place_m, double step_m, std::uint64_t seed) {
  const Vec2 at = place_m / step_m;
  const Vec2 knot = at.array().floor();
  const Vec2 share = at - knot;
  const auto x = static_cast<std::int64_t>(knot.x());
  const auto y = static_cast<std::int64_t>(knot.y());
  const double top = KnotValue(x, y, seed) * (1 - share.x()) +
                     KnotValue(x + 1, y, seed) * share.x();
  const double bottom = KnotValue(x, y + 1, seed) * (1 - share.x()) +
                        KnotValue(x + 1, y + 1, seed) * share.x();
  return top * (1 - share.y()) + bottom * share.y();
}

double PosterTone(const Poster& poster, const Vec2& place_m) {
  constexpr int kOctaves = 4;
  double sum = 0;
  for (int octave = 0; octave < kOctaves; ++octave) {
    sum += Noise(place_m, kFinestM * std::pow(2, octave),
                 poster.seed + static_cast<std::uint64_t>(octave));
  }
  return sum / kOctaves;
}

}  // namespace

double Texture::ToneAt(const Vec2& place_m) const {
  for (const Poster& poster : posters) {
    if (IsInside(place_m, poster.corner_m, poster.size_m)) {
      return PosterTone(poster, place_m);
    }
  }
  double result = tone;
  if (!cell_m.isZero()) {
    const Vec2 cells = (place_m - cell_origin_m).cwiseQuotient(cell_m);
    const Vec2 inner =
        (cells - Vec2(cells.array().floor())).cwiseProduct(cell_m);
    for (const TonePatch& patch : cell) {
      if (IsInside(inner, patch.corner_m, patch.size_m)) result = patch.tone;
    }
  }
  if (grain > 0) result += grain * (Noise(place_m, kFinestM, grain_seed) - 0.5);
  return std::clamp(result, 0.0, 1.0);
}

}  // namespace lowlap
