#pragma once

#include <string>
#include <vector>

namespace lowlap {

/// Rows of cells under named columns; missing cells at the end of a row are
/// empty.
struct TextTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// For a terminal: the first column to the left, the others to the right.
std::string ToAlignedText(const TextTable& table);

/// For programs, as RFC 4180 says, but with plain line feeds: a header, one
/// record a line, cells with commas, quotes or line feeds in quotes.
std::string ToCsv(const TextTable& table);

/// `value` with at most so many significant digits, without trailing zeros.
std::string NumberText(double value, int digits);

}  // namespace lowlap
