#include "lowlap/report/internal/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/report/internal/scene_drawing.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The numbers of one list of the drawing.
std::vector<double> Numbers(const std::string& drawing,
                            const std::string& name) {
  std::vector<double> numbers;
  std::size_t at = drawing.find(name + ":[") + name.size() + 2;
  while (drawing[at] != ']') {
    numbers.push_back(std::stod(drawing.substr(at)));
    at = drawing.find(',', at) + 1;
  }
  return numbers;
}

TEST(DrawingData, HoldsEveryCameraLineAndTheRightShareOfPoints) {
  SyntheticOptions options;
  options.num_views = 7;
  const Scene scene = TrueSolution(*Simulate(options));
  const std::string drawing = DrawingData(scene, 50);
  EXPECT_EQ(Numbers(drawing, "cameras").size(), 7u * 5 * 3);
  EXPECT_EQ(Numbers(drawing, "segments").size(),
            scene.line_structure.size() * 6);
  const std::size_t points = Numbers(drawing, "points").size() / 3;
  EXPECT_LE(points, 50u);
  EXPECT_GE(points, 25u);
  // All cameras lie within the frame, their frusta a little outside at most.
  for (const double x : Numbers(drawing, "cameras")) EXPECT_LT(x, 1.2);
}

TEST(DrawingData, AnEmptySceneIsAnEmptyDrawing) {
  EXPECT_EQ(DrawingData(Scene(), 10), "{points:[],segments:[],cameras:[]}");
}

TEST(FormatReport, EscapesTextAndHoldsTheTables) {
  ReportContent content;
  content.title = "a <b> & c";
  content.figures.emplace_back("cameras", "3 of 4");
  content.warnings.emplace_back("<script>bad</script>");
  content.notes.emplace_back("1 < 2");
  content.tables.push_back({"Ratios", "", {"name", "value"}, {{"x<y", "1.5"}}});
  const std::string page = FormatReport(Scene(), content);
  EXPECT_THAT(page, HasSubstr("<h1>a &lt;b&gt; &amp; c</h1>"));
  EXPECT_THAT(page, HasSubstr("3 of 4"));
  EXPECT_THAT(page, HasSubstr("<td>x&lt;y</td><td>1.5</td>"));
  EXPECT_THAT(page, Not(HasSubstr("<script>bad")));
  EXPECT_THAT(page, HasSubstr("<ul class=\"warnings\">\n<li>&lt;script"));
  EXPECT_THAT(page, HasSubstr("<ul class=\"notes\">\n<li>1 &lt; 2</li>"));
}

}  // namespace
}  // namespace lowlap
