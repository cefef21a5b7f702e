#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "cli/cli_fixture.h"
#include "lowlap/io/internal/scene_binary.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// A simulated room with a grey picture for each of its views.
class DrawCommand : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    ASSERT_EQ(Lowlap("simulate --kind room --views 4 --pairs chain -o " +
                     Path("room.lowlap"))
                  .exit_code,
              0);
    const auto scene = ReadSceneBinary(Path("room.lowlap"));
    ASSERT_TRUE(scene);
    fs::create_directory(Path("images"));
    for (const auto& [id, view] : scene->views) {
      cv::imwrite(
          Path("images/" + view.filename),
          cv::Mat(view.height_px, view.width_px, CV_8UC1, cv::Scalar(90)));
    }
  }

  Outcome Draw(const std::string& arguments) const {
    return Lowlap("draw " + Path("room.lowlap") + " --images " +
                  Path("images") + " -o " + Path("drawn") + " " + arguments);
  }
};

TEST_F(DrawCommand, DrawsAllViewsUnlessSomeAreNamed) {
  const Outcome all = Draw("--width 200");
  ASSERT_EQ(all.exit_code, 0) << all.output;
  EXPECT_EQ(FilesIn("drawn"), 4u);
  const cv::Mat view = cv::imread(Path("drawn/view_0_000000.png"));
  EXPECT_EQ(view.cols, 200);

  fs::remove_all(Path("drawn"));
  const Outcome some =
      Draw("--views 000002 --pairs 000000-000001,000002-000001");
  ASSERT_EQ(some.exit_code, 0) << some.output;
  EXPECT_EQ(FilesIn("drawn"), 3u);
  EXPECT_TRUE(fs::exists(Path("drawn/view_2_000002.png")));
  const cv::Mat pair = cv::imread(Path("drawn/pair_0_000000-1_000001.png"));
  ASSERT_FALSE(pair.empty());
  EXPECT_GT(pair.cols, pair.rows);
  EXPECT_TRUE(fs::exists(Path("drawn/pair_1_000001-2_000002.png")));
}

TEST_F(DrawCommand, RefusesWhatItCannotDrawAndWritesNothing) {
  const auto refused = [&](const std::string& arguments, const char* why) {
    const Outcome outcome = Draw(arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr(why));
    EXPECT_EQ(FilesIn("drawn"), 0u) << arguments;
    EXPECT_FALSE(fs::exists(Path("drawn"))) << arguments;
  };
  refused("--views nobody", "nobody");
  refused("--pairs 000000", "joined by a hyphen");
  refused("--pairs 000000-000003", "no relative pose between");
  cv::imwrite(Path("images/000001.png"), cv::Mat(10, 10, CV_8UC1));
  refused("", "000001.png: the image has 10 x 10 pixels");
  fs::remove(Path("images/000001.png"));
  refused("", "000001.png");
}

}  // namespace
}  // namespace lowlap
