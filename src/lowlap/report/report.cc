#include "lowlap/report/internal/report.h"

#include "lowlap/report/internal/markup.h"
#include "lowlap/report/internal/report_page.h"
#include "lowlap/report/internal/scene_drawing.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxPoints = 30000;

std::string FormatList(const std::string& style,
                       const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string html = "<ul class=\"" + style + "\">\n";
  for (const std::string& line : lines) {
    html += "<li>" + EscapeMarkup(line) + "</li>\n";
  }
  return html + "</ul>\n";
}

std::string FormatTable(const ReportTable& table) {
  std::string html = "<h2>" + EscapeMarkup(table.title) + "</h2>\n";
  if (!table.note.empty()) html += "<p>" + EscapeMarkup(table.note) + "</p>\n";
  html += "<div class=\"table\"><table><thead><tr>";
  for (const std::string& column : table.columns) {
    html += "<th>" + EscapeMarkup(column) + "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) {
      html += "<td>" + EscapeMarkup(cell) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string FormatReport(const Scene& scene, const ReportContent& content) {
  const std::string title = EscapeMarkup(content.title);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n"
      "<meta charset=\"utf-8\">\n<title>" +
      title + "</title>\n<style>" + kReportStyle +
      "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n<dl>\n";
  for (const auto& [name, value] : content.figures) {
    html += "<div><dt>" + EscapeMarkup(name) + "</dt><dd>" +
            EscapeMarkup(value) + "</dd></div>\n";
  }
  html += "</dl>\n" + FormatList("warnings", content.warnings) +
          FormatList("notes", content.notes);
  html +=
      "<canvas id=\"drawing\"></canvas>\n"
      "<p class=\"key\">Cameras are green, points blue, lines orange. Drag to "
      "turn, scroll to zoom.</p>\n";
  for (const ReportTable& table : content.tables) html += FormatTable(table);
  return html + "<script>\nconst drawing = " + DrawingData(scene, kMaxPoints) +
         ";" + kReportScript + "</script>\n</body>\n</html>\n";
}

}  // namespace lowlap
