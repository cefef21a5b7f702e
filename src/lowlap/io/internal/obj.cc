#include "lowlap/io/internal/obj.h"

#include <cstddef>
#include <vector>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/scene_drawing.h"

namespace lowlap {

Result<std::string> FormatObj(const Scene& scene) {
  LOWLAP_ASSIGN_OR_RETURN(const SceneDrawing drawing, DrawScene(scene));
  const auto& vertices = drawing.vertices;
  std::vector<bool> has_edge(vertices.size());
  for (const SceneDrawing::Edge& edge : drawing.edges) {
    has_edge[edge.start] = has_edge[edge.end] = true;
  }
  std::string text;
  std::vector<std::size_t> numbers(vertices.size());
  std::size_t num_written = 0;
  for (const DrawnKind kind :
       {DrawnKind::kLine, DrawnKind::kPoint, DrawnKind::kCamera}) {
    for (std::size_t n = 0; n < vertices.size(); ++n) {
      if (vertices[n].kind != kind) continue;
      numbers[n] = ++num_written;
      const Vec3& x = vertices[n].position;
      text += Format("v %.17g %.17g %.17g\n", x.x(), x.y(), x.z());
    }
    for (const SceneDrawing::Edge& edge : drawing.edges) {
      if (vertices[edge.start].kind != kind) continue;
      text += "l " + std::to_string(numbers[edge.start]) + " " +
              std::to_string(numbers[edge.end]) + "\n";
    }
    for (std::size_t n = 0; n < vertices.size(); ++n) {
      if (vertices[n].kind != kind || has_edge[n]) continue;
      text += "p " + std::to_string(numbers[n]) + "\n";
    }
  }
  return text;
}

}  // namespace lowlap
