#include "lowlap/report/report.h"

#include <ostream>

#include "lowlap/core/atomic_file.h"
#include "lowlap/report/internal/markup.h"
#include "lowlap/report/internal/report_page.h"
#include "lowlap/report/internal/scene_drawing.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxPoints = 30000;

void WriteTable(const ReportTable& table, std::ostream& out) {
  out << "<h2>" << EscapeMarkup(table.title) << "</h2>\n";
  if (!table.note.empty()) out << "<p>" << EscapeMarkup(table.note) << "</p>\n";
  out << "<div class=\"table\"><table><thead><tr>";
  for (const std::string& column : table.columns) {
    out << "<th>" << EscapeMarkup(column) << "</th>";
  }
  out << "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    out << "<tr>";
    for (const std::string& cell : row)
      out << "<td>" << EscapeMarkup(cell) << "</td>";
    out << "</tr>\n";
  }
  out << "</tbody></table></div>\n";
}

}  // namespace

Status WriteReport(const Scene& scene, const ReportContent& content,
                   const std::string& path) {
  return WriteFileAtomically(path, [&](std::ostream& out) -> Status {
    out << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n"
           "<meta charset=\"utf-8\">\n<title>"
        << EscapeMarkup(content.title) << "</title>\n<style>" << kReportStyle
        << "</style>\n</head>\n<body>\n<h1>" << EscapeMarkup(content.title)
        << "</h1>\n<dl>\n";
    for (const auto& [name, value] : content.figures) {
      out << "<div><dt>" << EscapeMarkup(name) << "</dt><dd>"
          << EscapeMarkup(value) << "</dd></div>\n";
    }
    out << "</dl>\n";
    if (!content.warnings.empty()) {
      out << "<ul class=\"warnings\">\n";
      for (const std::string& warning : content.warnings) {
        out << "<li>" << EscapeMarkup(warning) << "</li>\n";
      }
      out << "</ul>\n";
    }
    out << "<canvas id=\"drawing\"></canvas>\n"
           "<p class=\"key\">Cameras are green, points blue, lines orange. "
           "Drag "
           "to turn, scroll to zoom.</p>\n";
    for (const ReportTable& table : content.tables) WriteTable(table, out);
    out << "<script>\nconst drawing = " << DrawingData(scene, kMaxPoints) << ";"
        << kReportScript << "</script>\n</body>\n</html>\n";
    return {};
  });
}

}  // namespace lowlap
