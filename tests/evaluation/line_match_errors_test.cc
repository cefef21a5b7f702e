#include "lowlap/evaluation/internal/line_match_errors.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using testing::IsError;

// Two views side by side of upright edges; every image shows all of them.
class LineMatchErrorsTest : public ::testing::Test {
 protected:
  LineMatchErrorsTest() {
    Intrinsic intrinsic;
    intrinsic.width_px = 1200;
    intrinsic.height_px = 800;
    intrinsic.fx_px = intrinsic.fy_px = 1000;
    intrinsic.principal_point_px = Vec2(600, 400);
    scene_.intrinsics[0] = intrinsic;
    for (std::uint32_t id = 0; id < 2; ++id) {
      scene_.views[id].filename = "000" + std::to_string(id) + ".jpg";
      scene_.views[id].intrinsic_id = 0;
      truth_[id].center = Vec3(id, 0, 0);
    }
    for (int e = 0; e < 4; ++e) {
      const double x = -0.2 + 0.5 * e;
      TrueEdge edge;
      edge.name = std::to_string(e);
      edge.points_in_world = {Vec3(x, -0.5, 4), Vec3(x, 0, 4), Vec3(x, 0.5, 4)};
      edge.images = {0, 1};
      edges_.push_back(edge);
      for (ViewId id = 0; id < 2; ++id) {
        LineSegment segment;
        segment.start_px = Project(id, Vec3(x, -0.5, 4));
        segment.end_px = Project(id, Vec3(x, 0.5, 4));
        scene_.features[id].segments.push_back(segment);
      }
    }
    pose_.views = {0, 1};
  }

  Vec2 Project(ViewId id, const Vec3& point) const {
    return scene_.intrinsics.at(0).Project(point - truth_.at(id).center);
  }

  LineMatchCounts Count(const std::vector<FeatureMatch>& matches) {
    pose_.line_inliers = matches;
    scene_.relative_poses[pose_.views] = pose_;
    const auto evaluation =
        EvaluateLineMatches(scene_, truth_, edges_, {{0, 1}}, {});
    EXPECT_TRUE(evaluation.has_value());
    return evaluation ? evaluation->total : LineMatchCounts{};
  }

  Scene scene_;
  GroundTruth truth_;
  std::vector<TrueEdge> edges_;
  RelativePose pose_;
};

TEST_F(LineMatchErrorsTest, CountsRightAndWrongMatches) {
  const LineMatchCounts counts = Count({{0, 0}, {1, 1}, {2, 3}});
  EXPECT_EQ(counts.num_matches, 3);
  EXPECT_EQ(counts.num_right, 2);
  EXPECT_EQ(counts.num_wrong, 1);
  EXPECT_EQ(counts.num_unknown, 0);
  EXPECT_EQ(counts.num_common_edges, 4);
  EXPECT_EQ(counts.num_matched_edges, 2);
  EXPECT_DOUBLE_EQ(counts.Precision(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(counts.Recall(), 0.5);
}

TEST_F(LineMatchErrorsTest, TwoPiecesOfAnEdgeMatchItOnce) {
  LineSegment& whole = scene_.features[1].segments[0];
  LineSegment piece = whole;
  const Vec2 middle = 0.5 * (whole.start_px + whole.end_px);
  whole.end_px = middle;
  piece.start_px = middle;
  scene_.features[1].segments.push_back(piece);
  const LineMatchCounts counts = Count({{0, 0}, {0, 4}});
  EXPECT_EQ(counts.num_right, 2);
  EXPECT_EQ(counts.num_matched_edges, 1);
}

TEST_F(LineMatchErrorsTest, AMatchOffTheListIsUnknownUnlessItLeavesAnEdge) {
  // Moved across by 20 px: on no edge, in either view.
  for (ViewId id = 0; id < 2; ++id) {
    LineSegment shadow = scene_.features[id].segments[1];
    shadow.start_px.x() += 20;
    shadow.end_px.x() += 20;
    scene_.features[id].segments.push_back(shadow);
  }
  LineMatchCounts counts = Count({{4, 4}});
  EXPECT_EQ(counts.num_unknown, 1);
  EXPECT_EQ(counts.num_excluded, 0);
  // Edge 1 is seen by view 1, but not there.
  counts = Count({{1, 4}});
  EXPECT_EQ(counts.num_wrong, 1);
  // 4 px off is near: not enough to be right, too little to be wrong.
  for (Vec2* end : {&scene_.features[1].segments[4].start_px,
                    &scene_.features[1].segments[4].end_px}) {
    end->x() -= 16;
  }
  counts = Count({{1, 4}});
  EXPECT_EQ(counts.num_unknown, 1);
  // View 1 does not list edge 1: nothing is known of it there.
  for (Vec2* end : {&scene_.features[1].segments[4].start_px,
                    &scene_.features[1].segments[4].end_px}) {
    end->x() += 16;
  }
  edges_[1].images = {0};
  counts = Count({{1, 4}});
  EXPECT_EQ(counts.num_unknown, 1);
  EXPECT_EQ(counts.num_common_edges, 3);
}

TEST_F(LineMatchErrorsTest, UnknownMatchesAgainstTheTrueGeometryAreExcluded) {
  for (ViewId id = 0; id < 2; ++id) {
    LineSegment shadow = scene_.features[id].segments[1];
    const Vec2 shift(20,
                     id == 0 ? 0 : 320);  // other rows: other epipolar lines
    shadow.start_px += shift;
    shadow.end_px += shift;
    scene_.features[id].segments.push_back(shadow);
  }
  const LineMatchCounts counts = Count({{4, 4}});
  EXPECT_EQ(counts.num_unknown, 1);
  EXPECT_EQ(counts.num_excluded, 1);
}

TEST_F(LineMatchErrorsTest, APairWithoutARelativePoseHasNoRecall) {
  const auto evaluation =
      EvaluateLineMatches(scene_, truth_, edges_, {{0, 1}, {1, 7}}, {});
  ASSERT_TRUE(evaluation.has_value());
  EXPECT_FALSE(evaluation->pairs[0].has_relative_pose);
  EXPECT_EQ(evaluation->total.num_common_edges, 4);
  EXPECT_EQ(evaluation->total.Recall(), 0);
  EXPECT_EQ(evaluation->num_without_truth, 1);
  EXPECT_THAT(ToText(*evaluation), HasSubstr("no relative pose"));
  EXPECT_THAT(ToJson(*evaluation), HasSubstr("\"recall\": 0.0"));
}

TEST_F(LineMatchErrorsTest, EdgesBehindTheCameraAreOnNoSegment) {
  for (Vec3& point : edges_[0].points_in_world) point.z() = -point.z();
  EXPECT_EQ(Count({{0, 0}}).num_right, 0);
}

TEST_F(LineMatchErrorsTest, RefusesScenesThatNoTruthIsKnownOf) {
  EXPECT_THAT(EvaluateLineMatches(scene_, {}, edges_, {{0, 1}}, {}),
              IsError(ErrorCode::kInsufficientData, "no pair"));
}

TEST(ImageNumberTest, IsTheFileNameIfItIsANumber) {
  View view;
  view.filename = "0012.jpg";
  EXPECT_EQ(ImageNumber(view), 12);
  view.filename = "a12.jpg";
  EXPECT_EQ(ImageNumber(view), std::nullopt);
}

TEST(ReadTrueEdgesTest, ReadsPolylinesAndNamesWhatIsWrong) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("lowlap_edges_" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << R"({"edges": [
    {"name": "a", "p0": [0,0,1], "p1": [0,1,1], "views": [[3, 1.0, 50]]},
    {"name": "b", "p0": [0,0,1], "p1": [0,1,1],
     "pts": [[0,0,1],[0,0.5,1.1],[0,1,1]], "views": []}]})";
  const auto edges = ReadTrueEdges(path.string());
  ASSERT_TRUE(edges.has_value());
  ASSERT_EQ(edges->size(), 2u);
  EXPECT_EQ((*edges)[0].points_in_world[1], Vec3(0, 1, 1));
  EXPECT_EQ((*edges)[0].images.count(3), 1u);
  EXPECT_EQ((*edges)[1].points_in_world.size(), 3u);
  std::ofstream(path) << R"({"edges": [{"p0": [0,0,1], "views": []}]})";
  EXPECT_THAT(ReadTrueEdges(path.string()),
              IsError(ErrorCode::kParse, "edge 0"));
  std::filesystem::remove(path);
  EXPECT_THAT(ReadTrueEdges(path.string()), IsError(ErrorCode::kNotFound, ""));
}

}  // namespace
}  // namespace lowlap
