#include "lowlap/io/internal/ply.h"

#include <array>
#include <cstdint>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/byte_archive.h"
#include "lowlap/io/internal/scene_drawing.h"

namespace lowlap {
namespace {

void AddColor(DrawnKind kind, ByteWriter* writer) {
  // Points white, lines orange, cameras green.
  constexpr std::array<std::array<std::uint8_t, 3>, 3> kColors = {
      {{255, 255, 255}, {255, 160, 0}, {0, 200, 0}}};
  for (const std::uint8_t channel : kColors[static_cast<std::size_t>(kind)]) {
    writer->Integer(channel);
  }
}

}  // namespace

Result<std::string> FormatPly(const Scene& scene) {
  LOWLAP_ASSIGN_OR_RETURN(const SceneDrawing drawing, DrawScene(scene));
  std::string text =
      "ply\nformat binary_little_endian 1.0\ncomment lowlap scene\n"
      "element vertex " +
      std::to_string(drawing.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element edge " +
      std::to_string(drawing.edges.size()) +
      "\nproperty int vertex1\nproperty int vertex2\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n";
  ByteWriter writer(text);
  for (const SceneDrawing::Vertex& vertex : drawing.vertices) {
    writer.Reals(vertex.position.data(), 3);
    AddColor(vertex.kind, &writer);
  }
  for (const SceneDrawing::Edge& edge : drawing.edges) {
    writer.Integer(edge.start);
    writer.Integer(edge.end);
    AddColor(drawing.vertices[edge.start].kind, &writer);
  }
  return text;
}

}  // namespace lowlap
