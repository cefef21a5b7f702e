// The page in Chromium, where that is installed: it is used by events as by a
// person (page_self_test.js).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "cli/cli_fixture.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/io/internal/scene_binary.h"
#include "lowlap/report/internal/page_source.h"
#include "support/data_folder.h"

namespace lowlap {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

bool HasChromium() {
  return std::system("command -v chromium > /dev/null 2>&1") == 0;
}

class ReportPage : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    if (!HasChromium()) GTEST_SKIP() << "there is no chromium";
    ASSERT_EQ(Lowlap("simulate --kind room --views 8 --noise 0.3 --pairs "
                     "window:3 -o " +
                     Path("room.lowlap") + " --truth " + Path("truth.lowlap"))
                  .exit_code,
              0);
  }

  // A picture of its own for every view.
  void WritePhotographs(Scene* scene) {
    std::filesystem::create_directory(Path("images"));
    int shade = 40;
    for (auto& [id, view] : scene->views) {
      cv::Mat image(view.height_px, view.width_px, CV_8UC3,
                    cv::Scalar(shade, 120, 200 - shade));
      cv::imwrite(Path("images/" + view.filename), image);
      shade += 15;
    }
    scene->root_path = Path("images");
  }

  // The scene, and its views in the truth.
  void WriteWithTruth(const Scene& scene, const std::string& name) {
    ASSERT_TRUE(
        WriteFileAtomically(Path(name), FormatSceneBinary(scene).value()));
    auto truth = ReadSceneBinary(Path("truth.lowlap"));
    ASSERT_TRUE(truth);
    truth->views = scene.views;
    ASSERT_TRUE(WriteFileAtomically(Path("truth.lowlap"),
                                    FormatSceneBinary(*truth).value()));
  }

  // Solves the scene and runs the self test on its page.
  json Test(const std::string& scene) {
    const Outcome solved = Lowlap("solve " + Path(scene) + " --gt " +
                                  Path("truth.lowlap") + " -o " + Path("out"));
    EXPECT_EQ(solved.exit_code, 0) << solved.output;
    std::string page = ReadText(Path("out/report.html"));
    const std::string test =
        ReadText(SourceFolder() + "/tests/report/page_self_test.js");
    page.insert(page.rfind("</body>"), "<script>" + test + "</script>");
    // The browser's virtual time runs ahead of its frames.
    page.insert(page.find("<head>") + 6,
                "<script>window.requestAnimationFrame = callback => setTimeout("
                "() => callback(performance.now()), 16);</script>");
    Write("page.html", page);
    const std::string line =
        "chromium --headless=new --no-sandbox --disable-gpu-sandbox "
        "--use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader "
        "--enable-logging=stderr --virtual-time-budget=20000 "
        "--window-size=1400,900 --user-data-dir=" +
        Path("profile") + " --dump-dom file://" + Path("page.html") + " > " +
        Path("dom.html") + " 2> " + Path("log.txt");
    EXPECT_EQ(std::system(line.c_str()), 0) << ReadText(Path("log.txt"));
    EXPECT_THAT(ReadText(Path("log.txt")), Not(HasSubstr("CONSOLE")));
    const std::string dom = ReadText(Path("dom.html"));
    const std::string head = "<pre id=\"self-test\">";
    const std::size_t at = dom.rfind(head);
    if (at == std::string::npos) {
      ADD_FAILURE() << "the test did not end\n" << ReadText(Path("log.txt"));
      return json::object();
    }
    const std::size_t begin = at + head.size();
    return json::parse(dom.substr(begin, dom.find("</pre>", begin) - begin));
  }
};

TEST_F(ReportPage, DoesWhatClicksAskFor) {
  auto scene = ReadSceneBinary(Path("room.lowlap"));
  ASSERT_TRUE(scene);
  WritePhotographs(&*scene);
  ASSERT_TRUE(WriteFileAtomically(Path("shown.lowlap"),
                                  FormatSceneBinary(*scene).value()));
  const json seen = Test("shown.lowlap");
  EXPECT_EQ(seen["errors"], json::array()) << seen;
  EXPECT_EQ(seen["title"], "lowlap solve");
  EXPECT_EQ(seen["thumbnails"], 8);
  EXPECT_EQ(seen["hasSpace"], !kPageSource.three.empty());
  if (seen["hasSpace"]) {
    EXPECT_GT(seen["spaceColors"], 50);
    EXPECT_EQ(seen["colorsOfNothing"], 1);
    EXPECT_GT(seen["colorsOfCameras"], 1);
    EXPECT_EQ(seen["pickedCamera"], true);
    EXPECT_EQ(seen["shareBefore"], 0);
    EXPECT_EQ(seen["shareAfter"], 1);
  }
  EXPECT_THAT(seen["viewHead"].get<std::string>(),
              HasSubstr(std::next(scene->views.begin())->second.filename));
  EXPECT_EQ(seen["viewAddress"], "#view=1");
  EXPECT_EQ(seen["bareColors"], 1);  // the photograph alone
  EXPECT_GT(seen["photographColors"], 5);
  EXPECT_GE(seen["edges"], 7);
  EXPECT_EQ(seen["nodes"], 8);
  EXPECT_EQ(seen["profiles"], 2);
  EXPECT_GT(seen["profilePath"], 200);
  EXPECT_THAT(seen["pairHead"].get<std::string>(), HasSubstr(" – "));
  EXPECT_GT(seen["matchColors"], 50);
  EXPECT_EQ(seen["histograms"], 3);
  EXPECT_EQ(seen["barSelects"], "view");
  EXPECT_EQ(seen["camerasRows"], 8);
  EXPECT_GE(seen["pairsRows"], 7);
  EXPECT_GE(seen["ratiosRows"], 6);
  EXPECT_THAT(seen["rowSelects"].get<std::string>(), HasSubstr("#view="));
}

// Names that would end the script, and no photographs.
TEST_F(ReportPage, TakesHostileNamesAndNoPhotographs) {
  auto scene = ReadSceneBinary(Path("room.lowlap"));
  ASSERT_TRUE(scene);
  int n = 0;
  for (auto& [id, view] : scene->views) {
    view.filename = "</script><script>throw 'bad'</script>" +
                    std::to_string(n++) + "\"'&.png";
  }
  WriteWithTruth(*scene, "hostile.lowlap");
  const json seen = Test("hostile.lowlap");
  EXPECT_EQ(seen["errors"], json::array()) << seen;
  EXPECT_EQ(seen["scripts"], 5);  // data, three.js, the page's, the test's two
  EXPECT_EQ(seen["thumbnails"], 8);
  EXPECT_GT(seen["photographColors"], 5);  // outline and features
  EXPECT_GT(seen["matchColors"], 50);
}

TEST_F(ReportPage, TellsViewsOfOneNameApart) {
  auto scene = ReadSceneBinary(Path("room.lowlap"));
  ASSERT_TRUE(scene);
  const std::vector<std::string> names = {"a/1.jpg", "b/1.jpg",   "a/2.jpg",
                                          "a/2.png", "x/c/3.jpg", "y/c/3.jpg",
                                          "c/4.jpg", "5.jpg"};
  auto name = names.begin();
  for (auto& [id, view] : scene->views) view.filename = *name++;
  WriteWithTruth(*scene, "named.lowlap");
  const json seen = Test("named.lowlap");
  EXPECT_EQ(seen["errors"], json::array()) << seen;
  EXPECT_EQ(seen["nodeNames"],
            json({"a/1", "b/1", "2.jpg", "2.png", "x/c/3", "y/c/3", "4", "5"}));
}

}  // namespace
}  // namespace lowlap
