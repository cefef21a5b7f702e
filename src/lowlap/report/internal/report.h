#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// A table of the report; the first column is text, the others are numbers.
struct ReportTable {
  std::string title;
  std::string note;  // one or two sentences below the title; may be empty
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct ReportContent {
  std::string title;
  /// The headline figures: what, and its value.
  std::vector<std::pair<std::string, std::string>> figures;
  /// What a reader must not overlook (unplaced views, contradictions).
  std::vector<std::string> warnings;
  /// What else there is to say.
  std::vector<std::string> notes;
  std::vector<ReportTable> tables;
};

/// A page that needs nothing but a browser: the figures and tables, and
/// a drawing of cameras, points and lines that can be turned with the mouse.
/// At most 30,000 points are drawn, evenly chosen. Text is escaped.
std::string FormatReport(const Scene& scene, const ReportContent& content);

}  // namespace lowlap
