#include "lowlap/report/internal/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/report/internal/markup.h"
#include "lowlap/report/internal/plot_axis.h"

namespace lowlap {
namespace {

constexpr double kWidth = 860;
constexpr double kPadding = 16;
constexpr double kFontSize = 13;
// Browsers know the width of a text, a file does not: a generous guess.
constexpr double kCharacterWidth = 0.58 * kFontSize;

// Told apart by readers who do not see all colours (Okabe and Ito 2008); the
// pale ones are darkened to stand on white.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#1d2733", "#8c7a00"};
constexpr std::size_t kNumColors = sizeof kColors / sizeof kColors[0];
constexpr const char* kDashes[] = {"", "7 4", "2 3", "9 3 2 3"};

const char* ColorOf(std::size_t n) { return kColors[n % kNumColors]; }

std::string Coordinate(double value) { return Format("%.2f", value); }

double TextWidth(const std::string& text) {
  return kCharacterWidth * static_cast<double>(text.size());
}

/// A document under construction; y points down.
class Svg {
 public:
  void Text(double x, double y, const std::string& text,
            const std::string& attributes = "") {
    body_ += "<text x=\"" + Coordinate(x) + "\" y=\"" + Coordinate(y) + "\"" +
             (attributes.empty() ? "" : " " + attributes) + ">" +
             EscapeMarkup(text) + "</text>\n";
  }

  void Line(double x1, double y1, double x2, double y2,
            const std::string& attributes) {
    body_ += "<line x1=\"" + Coordinate(x1) + "\" y1=\"" + Coordinate(y1) +
             "\" x2=\"" + Coordinate(x2) + "\" y2=\"" + Coordinate(y2) + "\" " +
             attributes + "/>\n";
  }

  void Rectangle(double x, double y, double width, double height,
                 const std::string& attributes) {
    body_ += "<rect x=\"" + Coordinate(x) + "\" y=\"" + Coordinate(y) +
             "\" width=\"" + Coordinate(width) + "\" height=\"" +
             Coordinate(height) + "\" " + attributes + "/>\n";
  }

  void Add(const std::string& element) { body_ += element; }

  std::string Finish(double height) const {
    const std::string size = Coordinate(kWidth) + " " + Coordinate(height);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
           Coordinate(kWidth) + "\" height=\"" + Coordinate(height) +
           "\" viewBox=\"0 0 " + size +
           "\" font-family=\"system-ui, sans-serif\" font-size=\"" +
           Coordinate(kFontSize) +
           "\" fill=\"#1d2733\">\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" +
           body_ + "</svg>\n";
  }

 private:
  std::string body_;
};

constexpr const char* kGrid = "stroke=\"#dfe4ea\" stroke-width=\"1\"";
constexpr const char* kFrame = "stroke=\"#5c6b7a\" stroke-width=\"1\"";

/// The title and the note; returns where the next thing begins.
double DrawHead(const std::string& title, const std::string& note, Svg* svg) {
  double y = kPadding + 16;
  svg->Text(kPadding, y, title, "font-size=\"18\" font-weight=\"600\"");
  if (!note.empty()) {
    y += 20;
    svg->Text(kPadding, y, note, "fill=\"#5c6b7a\"");
  }
  return y + 12;
}

/// A marker of its own for every eighth series.
std::string Marker(std::size_t series, double x, double y) {
  const std::string fill = std::string("fill=\"") + ColorOf(series) + "\"";
  constexpr double kSize = 3.5;
  if ((series / kNumColors) % 2 == 1) {
    return "<rect x=\"" + Coordinate(x - kSize) + "\" y=\"" +
           Coordinate(y - kSize) + "\" width=\"" + Coordinate(2 * kSize) +
           "\" height=\"" + Coordinate(2 * kSize) + "\" " + fill + "/>\n";
  }
  return "<circle cx=\"" + Coordinate(x) + "\" cy=\"" + Coordinate(y) +
         "\" r=\"" + Coordinate(kSize) + "\" " + fill + "/>\n";
}

// Dashes shift where the colours repeat.
std::string Stroke(std::size_t series) {
  constexpr std::size_t kNumDashes = sizeof kDashes / sizeof kDashes[0];
  const char* dash = kDashes[(series + series / kNumColors) % kNumDashes];
  return std::string("fill=\"none\" stroke=\"") + ColorOf(series) +
         "\" stroke-width=\"2\"" +
         (*dash == '\0' ? std::string()
                        : std::string(" stroke-dasharray=\"") + dash + "\"");
}

/// Names of the series in rows from `y` on, but for empty ones; returns where
/// they end. Of bars, the sample is a square.
double DrawLegend(const std::vector<std::string>& names, bool bars, double y,
                  Svg* svg) {
  constexpr double kSample = 30, kGap = 22, kRow = 20;
  double x = kPadding;
  y += kRow / 2;
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (names[n].empty()) continue;
    const double width = kSample + TextWidth(names[n]) + kGap;
    if (x > kPadding && x + width > kWidth - kPadding) {
      x = kPadding;
      y += kRow;
    }
    if (bars) {
      svg->Rectangle(x + 8, y - 6, 12, 12,
                     std::string("fill=\"") + ColorOf(n) + "\"");
    } else {
      svg->Line(x, y, x + kSample - 6, y, Stroke(n));
      svg->Add(Marker(n, x + (kSample - 6) / 2, y));
    }
    svg->Text(x + kSample, y + 4.5, names[n]);
    x += width;
  }
  return y + kRow;
}

}  // namespace

Result<std::string> DrawBarPlot(const BarPlot& plot) {
  std::vector<double> values;
  std::vector<std::string> names;
  double left = 40;
  for (const std::string& group : plot.groups) {
    left = std::max(left, TextWidth(group));
  }
  constexpr double kBar = 15, kGroupGap = 10, kValueRoom = 70;
  const double right = kWidth - kPadding - kValueRoom;
  // The bars keep a quarter.
  left = std::min(left + kPadding + 8, right - kWidth / 4);
  for (const BarSeries& series : plot.series) {
    if (series.values.size() != plot.groups.size()) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "plot: '" + series.name + "' has " +
                           std::to_string(series.values.size()) +
                           " values for " + std::to_string(plot.groups.size()) +
                           " groups");
    }
    names.push_back(series.name);
    for (const std::optional<double>& value : series.values) {
      if (value) values.push_back(*value);
    }
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto range,
                          AxisRange::Make(plot.value, values));

  const auto x_of = [&](double value) {
    return left + (right - left) * std::clamp(range.Position(value), 0.0, 1.0);
  };
  Svg svg;
  double y = DrawHead(plot.title, plot.note, &svg);
  if (names.size() > 1) y = DrawLegend(names, true, y, &svg);
  const double top = y + 4;
  const double group_height =
      kBar * static_cast<double>(plot.series.size()) + kGroupGap;
  const double bottom =
      top + group_height * static_cast<double>(plot.groups.size()) + kGroupGap;
  for (const double tick : range.Ticks()) {
    svg.Line(x_of(tick), top, x_of(tick), bottom, kGrid);
    svg.Text(x_of(tick), bottom + 17, TickLabel(tick),
             "text-anchor=\"middle\"");
  }
  svg.Text((left + right) / 2, bottom + 38, plot.value.label,
           "text-anchor=\"middle\"");
  const double zero = range.Contains(0) ? x_of(0) : left;
  for (std::size_t g = 0; g < plot.groups.size(); ++g) {
    const double group_top =
        top + kGroupGap + group_height * static_cast<double>(g);
    svg.Text(left - 8, group_top + (group_height - kGroupGap) / 2 + 4.5,
             plot.groups[g], "text-anchor=\"end\"");
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
      const double bar_top = group_top + kBar * static_cast<double>(s);
      const std::optional<double>& value = plot.series[s].values[g];
      if (!value || !range.Shows(*value)) {
        svg.Text(zero + 5, bar_top + kBar - 3, "–",
                 "fill=\"#5c6b7a\" font-size=\"11\"");
        continue;
      }
      const double end = x_of(*value);
      svg.Rectangle(std::min(zero, end), bar_top + 1, std::abs(end - zero),
                    kBar - 2, std::string("fill=\"") + ColorOf(s) + "\"");
      svg.Text(std::max(zero, end) + 5, bar_top + kBar - 3.5,
               Format("%.3g", *value), "font-size=\"11\"");
    }
  }
  svg.Line(zero, top, zero, bottom, kFrame);
  svg.Line(left, bottom, right, bottom, kFrame);
  return svg.Finish(bottom + 38 + kPadding);
}

Result<std::string> DrawLinePlot(const LinePlot& plot) {
  std::vector<double> all_x, all_y;
  std::vector<std::string> names;
  for (const LineSeries& series : plot.series) {
    for (const auto& [x, y] : series.points) {
      all_x.push_back(x);
      all_y.push_back(y);
    }
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto x_range, AxisRange::Make(plot.x, all_x));
  LOWLAP_ASSIGN_OR_RETURN(const auto y_range, AxisRange::Make(plot.y, all_y));

  for (const LineSeries& series : plot.series) {
    const bool is_drawn = std::any_of(
        series.points.begin(), series.points.end(), [&](const auto& point) {
          return x_range.Shows(point.first) && y_range.Shows(point.second);
        });
    names.push_back(is_drawn ? series.name : "");
  }

  constexpr double kHeight = 380, kLeft = 84, kRight = kWidth - 2 * kPadding;
  Svg svg;
  double top = DrawHead(plot.title, plot.note, &svg);
  if (names.size() > 1) top = DrawLegend(names, false, top, &svg);
  top += 4;
  const double bottom = top + kHeight;
  const auto x_of = [&](double value) {
    return kLeft + (kRight - kLeft) * x_range.Position(value);
  };
  const auto y_of = [&](double value) {
    return bottom - kHeight * y_range.Position(value);
  };
  for (const double tick : x_range.Ticks()) {
    svg.Line(x_of(tick), top, x_of(tick), bottom, kGrid);
    svg.Text(x_of(tick), bottom + 17, TickLabel(tick),
             "text-anchor=\"middle\"");
  }
  for (const double tick : y_range.Ticks()) {
    svg.Line(kLeft, y_of(tick), kRight, y_of(tick), kGrid);
    svg.Text(kLeft - 7, y_of(tick) + 4.5, TickLabel(tick),
             "text-anchor=\"end\"");
  }
  svg.Line(kLeft, top, kLeft, bottom, kFrame);
  svg.Line(kLeft, bottom, kRight, bottom, kFrame);
  svg.Text((kLeft + kRight) / 2, bottom + 38, plot.x.label,
           "text-anchor=\"middle\"");
  const std::string middle = Coordinate((top + bottom) / 2);
  svg.Text(
      20, (top + bottom) / 2, plot.y.label,
      "text-anchor=\"middle\" transform=\"rotate(-90 20 " + middle + ")\"");

  for (std::size_t s = plot.series.size(); s-- > 0;) {
    std::string path, markers;
    bool pen_down = false;
    for (const auto& [x, y] : plot.series[s].points) {
      if (!x_range.Shows(x) || !y_range.Shows(y) || !x_range.Contains(x) ||
          !y_range.Contains(y)) {
        pen_down = false;
        continue;
      }
      path += (pen_down ? "L" : "M") + Coordinate(x_of(x)) + " " +
              Coordinate(y_of(y)) + " ";
      markers += Marker(s, x_of(x), y_of(y));
      pen_down = true;
    }
    if (path.empty()) continue;
    path.pop_back();
    svg.Add("<path d=\"" + path + "\" " + Stroke(s) + "/>\n");
    // Markers of dense curves would hide them.
    constexpr std::size_t kMostMarkers = 60;
    if (plot.series[s].points.size() <= kMostMarkers) svg.Add(markers);
  }
  return svg.Finish(bottom + 38 + kPadding);
}

}  // namespace lowlap
