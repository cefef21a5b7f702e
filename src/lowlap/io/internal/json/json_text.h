#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

// Appending JSON values to a text. Reals get the fewest digits that restore
// them exactly, and always look like reals ("500.0").
void AppendValue(double value, std::string& text);
void AppendValue(std::uint32_t value, std::string& text);
void AppendValue(int value, std::string& text);  // not negative
void AppendValue(std::string_view utf8, std::string& text);

void AppendValue(const ViewPair& views, std::string& text);
void AppendValue(const ViewTriplet& views, std::string& text);

template <class Tag>
void AppendValue(Id<Tag> id, std::string& text) {
  AppendValue(id.value(), text);
}

/// ", " unless the text ends with an opening bracket.
void AppendComma(std::string& text);

/// `"name": `, after a comma where one is due.
void AppendKey(std::string_view name, std::string& text);

/// The elements of a container or vector, without brackets.
template <class Elements>
void AppendElements(const Elements& elements, std::string& text) {
  for (const auto& element : elements) {
    AppendComma(text);
    AppendValue(element, text);
  }
}

template <class Element>
void AppendValue(const std::vector<Element>& elements, std::string& text) {
  text += '[';
  AppendElements(elements, text);
  text += ']';
}

/// A vector as an array, a matrix as an array of rows.
template <class Matrix>
void AppendValue(const Eigen::MatrixBase<Matrix>& matrix, std::string& text) {
  text += '[';
  if constexpr (Matrix::IsVectorAtCompileTime) {
    AppendElements(matrix.derived(), text);
  } else {
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      AppendComma(text);
      AppendValue(matrix.row(row), text);
    }
  }
  text += ']';
}

template <class Value>
void AppendMember(std::string_view name, const Value& value,
                  std::string& text) {
  AppendKey(name, text);
  AppendValue(value, text);
}

/// A section `,\n"name": [...]` with one record per line; `append(key, value,
/// text)` writes the record of an entry of a map, `append(item, text)` that of
/// another item.
template <class Items, class Append>
void AppendSection(std::string_view name, const Items& items,
                   const Append& append, std::string& text) {
  text += ",\n";
  AppendValue(name, text);
  text += ": [";
  const char* separator = "\n";
  for (const auto& item : items) {
    text += separator;
    separator = ",\n";
    if constexpr (std::is_invocable_v<Append, decltype(item), std::string&>) {
      append(item, text);
    } else {
      append(item.first, item.second, text);
    }
  }
  text += items.empty() ? "]" : "\n]";
}

}  // namespace lowlap
