#include "lowlap/io/internal/obj.h"

#include <gtest/gtest.h>

#include <limits>

#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;

TEST(FormatObj, SegmentsComeFirst) {
  Scene scene;
  scene.views[0].pose_id = 0;
  scene.poses[0].center = Vec3(0, 0, -1);
  scene.structure[3].position = Vec3(1, 2, 3.5);
  scene.line_structure[1].start = Vec3(5, 6, 7);
  scene.line_structure[1].end = Vec3(8, 9, 0.1);
  scene.line_structure[4] = scene.line_structure[1];
  EXPECT_EQ(*FormatObj(scene),
            "v 5 6 7\nv 8 9 0.10000000000000001\n"
            "v 5 6 7\nv 8 9 0.10000000000000001\nl 1 2\nl 3 4\n"
            "v 1 2 3.5\np 5\n"
            "v 0 0 -1\np 6\n");
}

TEST(FormatObj, CamerasAreFrusta) {
  Scene scene = testing::FullScene();
  scene.line_structure.clear();
  scene.structure.clear();
  const std::string text = *FormatObj(scene);
  std::size_t num_edges = 0;
  for (std::size_t n = 0; (n = text.find("\nl ", n)) != text.npos; ++n) {
    ++num_edges;
  }
  EXPECT_EQ(num_edges, 4u * 8u);  // four perspective cameras with poses
}

TEST(FormatObj, NumbersThatAreNotFiniteAreRefused) {
  Scene scene = testing::FullScene();
  scene.structure[0].position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(FormatObj(scene),
              IsError(ErrorCode::kInvalidScene, "not finite"));
}

}  // namespace
}  // namespace lowlap
