#include "lowlap/report/internal/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lowlap {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t Count(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + what.size())) {
    ++count;
  }
  return count;
}

// Widths of the bars in the order of drawing; legend samples and the
// background are not bars.
std::vector<double> BarWidths(const std::string& svg) {
  const std::regex bar(
      "<rect x=\"[^\"]*\" y=\"[^\"]*\" width=\"([0-9.]+)\" height=\"13.00\"");
  std::vector<double> widths;
  for (std::sregex_iterator each(svg.begin(), svg.end(), bar), end; each != end;
       ++each) {
    widths.push_back(std::atof((*each)[1].str().c_str()));
  }
  return widths;
}

BarPlot TwoByTwo() {
  BarPlot plot;
  plot.title = "Errors";
  plot.value.label = "position error (m)";
  plot.groups = {"graph", "chain"};
  plot.series = {{"before", {2.0, 4.0}}, {"after", {1.0, std::nullopt}}};
  return plot;
}

TEST(BarPlotTest, BarsAreAsLongAsTheirValues) {
  const auto svg = DrawBarPlot(TwoByTwo());
  ASSERT_TRUE(svg) << svg.error().ToString();
  const std::vector<double> widths = BarWidths(*svg);
  ASSERT_EQ(widths.size(), 3u);  // one value is absent
  EXPECT_NEAR(widths[0] / widths[1], 2, 0.01);
  EXPECT_NEAR(widths[2] / widths[0], 2, 0.01);
  for (const char* text : {"Errors", "position error (m)", ">graph<", ">chain<",
                           ">before<", ">after<", "–"}) {
    EXPECT_THAT(*svg, HasSubstr(text));
  }
}

TEST(BarPlotTest, LongNamesOfGroupsAreNotCutOff) {
  BarPlot plot = TwoByTwo();
  plot.groups[0] =
      "up to 0.1 % (2103 of 2110, 1510 of 1600, 4000 of 5000, 8000 of 8000)";
  const auto svg = DrawBarPlot(plot);
  ASSERT_TRUE(svg);
  const std::regex name("<text x=\"([0-9.]+)\"[^>]*>up to");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(*svg, found, name));
  constexpr double kMinCharacterWidth = 6.5;  // at 13 px
  EXPECT_GT(std::atof(found[1].str().c_str()),
            kMinCharacterWidth * static_cast<double>(plot.groups[0].size()));
  // Only names that leave nothing for the bars are.
  plot.groups[0] = std::string(300, 'm');
  EXPECT_GT(BarWidths(*DrawBarPlot(plot))[2], 150);
}

TEST(BarPlotTest, LogarithmicBarsDifferByEqualLengthsForEqualFactors) {
  BarPlot plot = TwoByTwo();
  plot.value.scale = AxisScale::kLog10;
  plot.groups = {"a", "b", "c"};
  plot.series = {{"x", {2.0, 20.0, 200.0}}};
  const auto svg = DrawBarPlot(plot);
  ASSERT_TRUE(svg);
  const std::vector<double> widths = BarWidths(*svg);
  ASSERT_EQ(widths.size(), 3u);
  EXPECT_GT(widths[0], 0);
  EXPECT_NEAR(widths[2] - widths[1], widths[1] - widths[0], 0.05);
}

TEST(BarPlotTest, ValuesWithoutAPlaceOnALogarithmicAxisHaveADash) {
  BarPlot plot = TwoByTwo();
  plot.value.scale = AxisScale::kLog10;
  plot.series = {{"x", {0.0, std::nan("")}}};
  const auto svg = DrawBarPlot(plot);
  ASSERT_TRUE(svg);
  EXPECT_TRUE(BarWidths(*svg).empty());
  EXPECT_EQ(Count(*svg, "–"), 2u);
  EXPECT_THAT(*svg, Not(HasSubstr("nan")));
  EXPECT_THAT(*svg, Not(HasSubstr("inf")));
}

TEST(BarPlotTest, NegativeValuesGoToTheOtherSideOfZero) {
  BarPlot plot = TwoByTwo();
  plot.series = {{"x", {-1.0, 1.0}}};
  const auto svg = DrawBarPlot(plot);
  ASSERT_TRUE(svg);
  const std::vector<double> widths = BarWidths(*svg);
  ASSERT_EQ(widths.size(), 2u);
  EXPECT_NEAR(widths[0], widths[1], 0.02);
  EXPECT_THAT(*svg, HasSubstr(">-1<"));
}

TEST(BarPlotTest, TextIsEscapedAndBytesRepeat) {
  BarPlot plot = TwoByTwo();
  plot.title = "a < b & c";
  const auto first = DrawBarPlot(plot), second = DrawBarPlot(plot);
  ASSERT_TRUE(first);
  EXPECT_THAT(*first, HasSubstr("a &lt; b &amp; c"));
  EXPECT_EQ(*first, *second);
}

TEST(BarPlotTest, NothingToDrawIsAnEmptyPlot) {
  const auto svg = DrawBarPlot({});
  ASSERT_TRUE(svg);
  EXPECT_TRUE(BarWidths(*svg).empty());
}

TEST(BarPlotTest, EverySeriesNeedsAValueForEachGroup) {
  BarPlot plot = TwoByTwo();
  plot.series[1].values.pop_back();
  const auto svg = DrawBarPlot(plot);
  ASSERT_FALSE(svg);
  EXPECT_EQ(svg.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(svg.error().message, HasSubstr("'after' has 1 values for 2"));
}

LinePlot OneCurve(std::vector<std::pair<double, double>> points) {
  LinePlot plot;
  plot.title = "Breakdown";
  plot.x.label = "outliers (%)";
  plot.y.label = "median error (m)";
  plot.series = {{"graph", std::move(points)}};
  return plot;
}

std::string PathOf(const std::string& svg) {
  std::smatch match;
  std::regex_search(svg, match, std::regex("<path d=\"([^\"]*)\""));
  return match[1];
}

TEST(LinePlotTest, PointsAreJoinedWhereTheAxesSay) {
  const auto svg = DrawLinePlot(OneCurve({{0, 0}, {50, 5}, {100, 10}}));
  ASSERT_TRUE(svg) << svg.error().ToString();
  double x[3], y[3];
  ASSERT_EQ(std::sscanf(PathOf(*svg).c_str(), "M%lf %lf L%lf %lf L%lf %lf",
                        &x[0], &y[0], &x[1], &y[1], &x[2], &y[2]),
            6);
  EXPECT_NEAR(x[1], (x[0] + x[2]) / 2, 0.02);
  EXPECT_NEAR(y[1], (y[0] + y[2]) / 2, 0.02);
  EXPECT_LT(y[2], y[0]);  // y points down in the file
  EXPECT_EQ(Count(*svg, "<circle"), 3u);
  EXPECT_THAT(*svg, HasSubstr(">0<"));
  EXPECT_THAT(*svg, Not(HasSubstr(">-0<")));
  EXPECT_THAT(*svg, HasSubstr("outliers (%)"));
  EXPECT_THAT(*svg, HasSubstr("median error (m)"));
}

TEST(LinePlotTest, PointsThatCannotBeShownAreGaps) {
  LinePlot plot = OneCurve({{1, 1},
                            {2, 10},
                            {3, std::numeric_limits<double>::infinity()},
                            {4, 0},
                            {5, 100},
                            {6, 10}});
  plot.y.scale = AxisScale::kLog10;
  const auto svg = DrawLinePlot(plot);
  ASSERT_TRUE(svg);
  const std::string path = PathOf(*svg);
  EXPECT_EQ(Count(path, "M"), 2u);
  EXPECT_EQ(Count(path, "L"), 2u);
  EXPECT_THAT(*svg, Not(HasSubstr("inf")));
}

TEST(LinePlotTest, GivenEndsCutTheCurve) {
  LinePlot plot = OneCurve({{0, 1}, {1, 2}, {2, 300}});
  plot.y.max = 10;
  const auto svg = DrawLinePlot(plot);
  ASSERT_TRUE(svg);
  EXPECT_EQ(Count(PathOf(*svg), "L"), 1u);
}

TEST(LinePlotTest, EndsMustIncrease) {
  LinePlot plot = OneCurve({{0, 1}});
  plot.x.min = 3;
  plot.x.max = 2;
  auto svg = DrawLinePlot(plot);
  ASSERT_FALSE(svg);
  EXPECT_THAT(svg.error().message, HasSubstr("'outliers (%)' must increase"));
  plot.x.min = 0;
  plot.x.scale = AxisScale::kLog10;
  svg = DrawLinePlot(plot);
  ASSERT_FALSE(svg);
  EXPECT_EQ(svg.error().code, ErrorCode::kInvalidArgument);
}

// The look of a curve says which it is in every plot of a set.
TEST(LinePlotTest, EmptySeriesKeepTheirLookAndAreNotNamed) {
  LinePlot plot = OneCurve({{0, 1}, {1, 2}});
  plot.series.push_back({"second", {{0, 2}, {1, 3}}});
  const auto look_of_second = [&] {
    const auto svg = DrawLinePlot(plot);
    EXPECT_TRUE(svg);
    // The last series is drawn first, below the others.
    std::smatch match;
    std::regex_search(*svg, match,
                      std::regex("<path d=\"[^\"]*\" fill=\"none\" ([^/]*)/>"));
    EXPECT_THAT(*svg, HasSubstr(">second<"));
    return match[1].str();
  };
  const std::string look = look_of_second();
  plot.series[0].points = {{0, std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(look_of_second(), look);
  EXPECT_THAT(*DrawLinePlot(plot), Not(HasSubstr(">graph<")));
}

TEST(LinePlotTest, ManySeriesAreToldApart) {
  LinePlot plot = OneCurve({{0, 1}, {1, 2}});
  for (int n = 1; n < 12; ++n) {
    plot.series.push_back({"s" + std::to_string(n), {{0, 1}, {1, n}}});
  }
  const auto svg = DrawLinePlot(plot);
  ASSERT_TRUE(svg);
  EXPECT_EQ(Count(*svg, "<path"), 12u);
  const std::regex stroke("<path d=\"[^\"]*\" fill=\"none\" ([^/]*)/>");
  std::set<std::string> looks;
  for (std::sregex_iterator each(svg->begin(), svg->end(), stroke), end;
       each != end; ++each) {
    looks.insert((*each)[1].str());
  }
  EXPECT_EQ(looks.size(), 12u);
  EXPECT_GT(Count(*svg, "<circle"), 0u);
  EXPECT_GT(Count(*svg, "width=\"7.00\" height=\"7.00\""), 0u);
}

}  // namespace
}  // namespace lowlap
