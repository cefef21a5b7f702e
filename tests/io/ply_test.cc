#include "lowlap/io/internal/ply.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::VectorNear;

struct Vertex {
  Vec3 position;
  std::array<unsigned char, 3> color;
};

struct Ply {
  std::string header;
  std::vector<Vertex> vertices;
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
};

std::size_t CountOf(const std::string& header, const std::string& element) {
  const std::string line = "element " + element + " ";
  return std::stoul(header.substr(header.find(line) + line.size()));
}

// Reads what the header announces; the test machine is little-endian.
Ply PlyOf(const Scene& scene) {
  const std::string bytes = FormatPly(scene).value();
  const std::string end = "end_header\n";
  std::size_t offset = bytes.find(end) + end.size();
  Ply ply;
  ply.header = bytes.substr(0, offset);
  ply.vertices.resize(CountOf(ply.header, "vertex"));
  for (Vertex& vertex : ply.vertices) {
    std::memcpy(vertex.position.data(), &bytes.at(offset), 24);
    std::memcpy(vertex.color.data(), &bytes.at(offset + 24), 3);
    offset += 27;
  }
  ply.edges.resize(CountOf(ply.header, "edge"));
  for (auto& edge : ply.edges) {
    std::memcpy(&edge.first, &bytes.at(offset), 4);
    std::memcpy(&edge.second, &bytes.at(offset + 4), 4);
    offset += 11;
  }
  EXPECT_EQ(offset, bytes.size());
  return ply;
}

TEST(FormatPly, PointsSegmentsAndFrusta) {
  Scene scene;
  scene.intrinsics[0].width_px = 600;
  scene.intrinsics[0].height_px = 400;
  scene.intrinsics[0].fx_px = scene.intrinsics[0].fy_px = 300;
  scene.intrinsics[0].principal_point_px = {300, 200};
  for (const std::uint32_t id : {0u, 1u, 2u}) {
    scene.views[id].intrinsic_id = 0;
    scene.views[id].pose_id = id;
    // The second camera looks along the world's -x.
    scene.poses[id].center = Vec3(4.0 * id, 0, 0);
  }
  scene.poses[1].rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  scene.poses.erase(2);
  scene.structure[3].position = Vec3(1, 2, 3);
  scene.line_structure[1].start = Vec3(5, 6, 7);
  scene.line_structure[1].end = Vec3(8, 9, 10);
  const Ply ply = PlyOf(scene);
  EXPECT_THAT(ply.header,
              ::testing::StartsWith("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(ply.header, ::testing::HasSubstr("property int vertex1\n"
                                               "property int vertex2\n"));
  ASSERT_EQ(ply.vertices.size(), 1u + 2u + 2u * 5u);
  ASSERT_EQ(ply.edges.size(), 1u + 2u * 8u);
  EXPECT_EQ(ply.vertices[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(ply.edges[0], (std::pair<std::int32_t, std::int32_t>(1, 2)));
  EXPECT_EQ(ply.vertices[1].position, Vec3(5, 6, 7));
  EXPECT_EQ(ply.vertices[2].position, Vec3(8, 9, 10));
  EXPECT_NE(ply.vertices[0].color, ply.vertices[1].color);
  EXPECT_NE(ply.vertices[1].color, ply.vertices[3].color);
  // Depth 1, a quarter of the distance 4: half width 1, half height 2/3.
  EXPECT_EQ(ply.vertices[3].position, Vec3(0, 0, 0));
  EXPECT_THAT(ply.vertices[4].position,
              VectorNear(Vec3(-1, -2.0 / 3, 1), 1e-12));
  EXPECT_THAT(ply.vertices[6].position, VectorNear(Vec3(1, 2.0 / 3, 1), 1e-12));
  EXPECT_EQ(ply.vertices[8].position, Vec3(4, 0, 0));
  EXPECT_THAT(ply.vertices[9].position,
              VectorNear(Vec3(3, -2.0 / 3, -1), 1e-12));
  for (const auto& [a, b] : ply.edges) {
    EXPECT_NE(a, b);
    EXPECT_LT(std::max(a, b), static_cast<int>(ply.vertices.size()));
    EXPECT_GE(std::min(a, b), 0);
  }
}

TEST(FormatPly, ViewsWithoutFrustumAreTheirCentre) {
  const Scene scene =
      testing::FullScene();  // a panorama, no intrinsic, no pose
  Scene cameras = scene;
  cameras.structure.clear();
  cameras.line_structure.clear();
  EXPECT_EQ(PlyOf(cameras).vertices.size(), 4u * 5u + 2u);
}

TEST(FormatPly, EmptyAndSingleCameraScenes) {
  EXPECT_TRUE(PlyOf(Scene()).vertices.empty());
  Scene scene = testing::FullScene();
  scene = WithoutViews(scene, {4, 7, 10, 13, 16, 19});
  EXPECT_EQ(PlyOf(scene).vertices.size(), 5u);
}

TEST(FormatPly, NumbersThatAreNotFiniteAreRefused) {
  Scene scene = testing::FullScene();
  scene.structure[0].position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(FormatPly(scene),
              IsError(ErrorCode::kInvalidScene, "not finite"));
}

}  // namespace
}  // namespace lowlap
