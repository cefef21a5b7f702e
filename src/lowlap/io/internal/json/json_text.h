#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "lowlap/geometry/types.h"

namespace lowlap {

// Appending JSON values to a text. Reals get the fewest digits that restore
// them exactly, and always look like reals ("500.0").
void AppendReal(double value, std::string& text);
void AppendInteger(std::uint32_t value, std::string& text);
void AppendString(std::string_view utf8, std::string& text);

/// ", " unless the text ends with an opening bracket.
void AppendComma(std::string& text);

/// `"name": `, after a comma where one is due.
void AppendKey(std::string_view name, std::string& text);

template <class Vector>
void AppendVector(const Vector& vector, std::string& text) {
  text += '[';
  for (Eigen::Index n = 0; n < vector.size(); ++n) {
    AppendComma(text);
    AppendReal(vector(n), text);
  }
  text += ']';
}

/// A matrix as an array of rows.
template <class Matrix>
void AppendMatrix(const Matrix& matrix, std::string& text) {
  text += '[';
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    AppendComma(text);
    AppendVector(matrix.row(row), text);
  }
  text += ']';
}

/// A section `"name": [...]` with one record per line; `append(item, text)`
/// writes a record.
template <class Items, class Append>
void AppendSection(std::string_view name, const Items& items,
                   const Append& append, std::string& text) {
  AppendString(name, text);
  text += ": [";
  const char* separator = "\n";
  for (const auto& item : items) {
    text += separator;
    separator = ",\n";
    append(item, text);
  }
  text += items.empty() ? "]" : "\n]";
}

}  // namespace lowlap
