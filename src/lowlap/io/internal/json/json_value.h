#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/types.h"
#include "lowlap/io/internal/failure.h"
#include "lowlap/io/internal/json/json_tree.h"

namespace lowlap {

/// A value of a JsonTree with typed access. Every failure throws a Failure
/// whose place is the path of the value.
class JsonValue {
 public:
  JsonValue(const JsonTree& tree, std::uint32_t index)
      : tree_(&tree), index_(index) {}

  [[noreturn]] void Fail(std::string message,
                         ErrorCode code = ErrorCode::kParse) const;

  /// A member of an object.
  JsonValue At(std::string_view name) const;
  std::optional<JsonValue> Find(std::string_view name) const;
  /// Fails on a member that is not listed.
  void AllowOnly(const std::vector<std::string_view>& names) const;

  std::uint32_t Id() const;  // 0 ... 2^32 - 1
  int Count() const;         // 0 ... 2^31 - 1
  double Real() const;
  bool Bool() const;
  const std::string& String() const;

  /// The elements of an array, for range-based loops.
  class Iterator {
   public:
    Iterator(const JsonTree& tree, std::uint32_t index)
        : tree_(&tree), index_(index) {}
    JsonValue operator*() const { return {*tree_, index_}; }
    Iterator& operator++() {
      index_ = tree_->Next(index_);
      return *this;
    }
    bool operator!=(const Iterator& other) const {
      return index_ != other.index_;
    }

   private:
    const JsonTree* tree_;
    std::uint32_t index_;
  };
  struct Range {
    Iterator first, last;
    Iterator begin() const { return first; }
    Iterator end() const { return last; }
  };
  Range Elements() const;

  /// The length of an array of scalars that must be a multiple of `stride`.
  std::size_t FlatSize(std::size_t stride) const;

  template <int kRows>
  Eigen::Matrix<double, kRows, 1> Vector() const {
    Eigen::Matrix<double, kRows, 1> vector;
    int row = 0;
    for (const JsonValue element : Elements()) {
      if (row < kRows) vector(row) = element.Real();
      ++row;
    }
    if (row != kRows) FailSize(kRows, row);
    return vector;
  }

  /// A matrix as an array of rows.
  template <int kRows, int kCols>
  Eigen::Matrix<double, kRows, kCols> Matrix() const {
    Eigen::Matrix<double, kRows, kCols> matrix;
    int row = 0;
    for (const JsonValue element : Elements()) {
      if (row < kRows) {
        matrix.row(row) = element.Vector<kCols>().transpose();
      }
      ++row;
    }
    if (row != kRows) FailSize(kRows, row);
    return matrix;
  }

 private:
  const JsonNode& node() const { return tree_->nodes[index_]; }
  [[noreturn]] void FailSize(int expected, int actual) const;
  std::uint64_t Integer(std::uint64_t largest) const;
  void RequireObject() const;

  const JsonTree* tree_;
  std::uint32_t index_;
};

}  // namespace lowlap
