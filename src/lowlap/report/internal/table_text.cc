#include "lowlap/report/internal/table_text.h"

#include <algorithm>
#include <cstddef>

#include "lowlap/core/internal/format.h"

namespace lowlap {
namespace {

// Characters of UTF-8 text: bytes that do not continue one.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(),
      [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string Quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string ToAlignedText(const TextTable& table) {
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) {
    widths.push_back(Width(column));
  }
  const std::size_t num_columns = widths.size();
  for (const auto& row : table.rows) {
    for (std::size_t n = 0; n < std::min(row.size(), num_columns); ++n) {
      widths[n] = std::max(widths[n], Width(row[n]));
    }
  }
  std::string text;
  const auto append = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t n = 0; n < num_columns; ++n) {
      const std::string cell = n < row.size() ? row[n] : std::string();
      const std::string pad(widths[n] - Width(cell), ' ');
      if (n == 0) {
        line.append(cell).append(pad);
      } else {
        line.append("  ").append(pad).append(cell);
      }
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  };
  append(table.columns);
  for (const auto& row : table.rows) append(row);
  return text;
}

std::string ToCsv(const TextTable& table) {
  std::string text;
  const auto append = [&](const std::vector<std::string>& row) {
    for (std::size_t n = 0; n < table.columns.size(); ++n) {
      if (n > 0) text += ',';
      if (n < row.size()) text += Quoted(row[n]);
    }
    text += '\n';
  };
  append(table.columns);
  for (const auto& row : table.rows) append(row);
  return text;
}

std::string NumberText(double value, int digits) {
  return Format("%.*g", digits, value);
}

}  // namespace lowlap
