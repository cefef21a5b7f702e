#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/geometry/types.h"
#include "support/random_vectors.h"

namespace lowlap::testing {

/// An image of a function of the position in pixels.
inline GrayImage Render(int width, int height,
                        const std::function<double(const Vec2&)>& value,
                        double noise_stddev = 0, std::uint64_t seed = 1) {
  Random random(seed);
  GrayImage image;
  image.width = width;
  image.height = height;
  image.pixels.reserve(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double noise = noise_stddev > 0 ? random.Gaussian(noise_stddev) : 0;
      image.pixels.push_back(static_cast<std::uint8_t>(
          std::clamp(std::floor(value(Vec2(x, y)) + noise + 0.5), 0.0, 255.0)));
    }
  }
  return image;
}

inline GrayImage Uniform(int width, int height, double value) {
  return Render(width, height, [value](const Vec2&) { return value; });
}

/// The image turned clockwise by 90 degrees: (x, y) moves to (h - 1 - y, x).
inline GrayImage Turned(const GrayImage& image) {
  return Render(image.height, image.width, [&](const Vec2& p) {
    const int x = static_cast<int>(p.y());
    const int y = image.height - 1 - static_cast<int>(p.x());
    return static_cast<double>(image.pixels[y * image.width + x]);
  });
}

/// A sum of random blobs on grey: texture for SIFT that can be evaluated at
/// any place, so that it can be moved, turned and scaled without resampling.
class BlobTexture {
 public:
  BlobTexture(std::uint64_t seed, int count, double extent_px) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
      blobs_.push_back({UniformVec2(random, {0, 0}, {extent_px, extent_px}),
                        random.Uniform(1.5, 6), random.Uniform(-90, 90)});
    }
  }

  double operator()(const Vec2& p) const {
    double value = 128;
    for (const Blob& blob : blobs_) {
      const double u =
          (p - blob.center).squaredNorm() / (blob.sigma * blob.sigma);
      if (u < 20) value += blob.height * std::exp(-0.5 * u);
    }
    return value;
  }

 private:
  struct Blob {
    Vec2 center;
    double sigma;
    double height;
  };
  std::vector<Blob> blobs_;
};

/// Position across the directed line from `start` to `end`; positive on its
/// left as seen in the image.
inline double LeftOf(const Vec2& p, const Vec2& start, const Vec2& end) {
  const Vec2 d = (end - start).normalized();
  const Vec2 v = p - start;
  return d.y() * v.x() - d.x() * v.y();
}

/// A filled convex polygon with edges blurred by about `blur_px`; 0 outside, 1
/// inside. The corners go round so that the inside is on the left of every
/// edge as seen in the image.
inline double PolygonCover(const Vec2& p, const std::vector<Vec2>& corners,
                           double blur_px) {
  double cover = 1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double left =
        LeftOf(p, corners[i], corners[(i + 1) % corners.size()]);
    cover *= 0.5 * (1 + std::erf(left / (std::sqrt(2.0) * blur_px)));
  }
  return cover;
}

}  // namespace lowlap::testing
