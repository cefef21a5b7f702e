#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

enum class DrawnKind { kPoint, kLine, kCamera };

/// What a scene looks like, in world coordinates.
struct SceneDrawing {
  struct Vertex {
    Vec3 position;
    DrawnKind kind;
  };
  /// Between two vertices of one kind.
  struct Edge {
    std::uint32_t start;
    std::uint32_t end;
  };
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
};

/// Vertices in this order: the points of `structure`, the two ends of every
/// line of `line_structure`, and five per posed view that has an intrinsic: the
/// centre and the corners of a small viewing frustum. Edges draw the segments
/// and the frusta. A view without intrinsic, and a spherical one, is its centre
/// alone.
///
/// The frusta are a quarter as deep as the median distance from a camera centre
/// to its nearest neighbour. kInvalidScene for a number that is not finite.
Result<SceneDrawing> DrawScene(const Scene& scene);

}  // namespace lowlap
