#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "third_party_adapters/colmap/internal/camera.h"
#include "third_party_adapters/colmap/internal/sqlite.h"

namespace lowlap::colmap {

inline constexpr std::int64_t kMaxImages = 2147483647;

/// Of a pair of image ids, first < second.
inline std::int64_t PairId(std::uint32_t first, std::uint32_t second) {
  return kMaxImages * first + second;
}
inline std::pair<std::uint32_t, std::uint32_t> ImagesOfPair(std::int64_t pair) {
  return {static_cast<std::uint32_t>(pair / kMaxImages),
          static_cast<std::uint32_t>(pair % kMaxImages)};
}

/// The numbers of a blob, which are stored little-endian, as here.
template <class T>
std::vector<T> Numbers(std::string_view blob) {
  std::vector<T> numbers(blob.size() / sizeof(T));
  if (!numbers.empty()) {
    std::memcpy(numbers.data(), blob.data(), numbers.size() * sizeof(T));
  }
  return numbers;
}
template <class T>
std::string_view Bytes(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()),
          numbers.size() * sizeof(T)};
}

/// A matrix of three columns, rows, cols and data, the first of which is
/// `column`. Blobs of another size are kParse.
template <class T>
std::vector<T> ReadRows(const Statement& row, int column,
                        std::uint32_t* num_columns) {
  const std::uint64_t rows = row.Unsigned(column);
  *num_columns = row.Unsigned(column + 1);
  const std::string_view blob = row.Blob(column + 2);
  if (rows * *num_columns != blob.size() / sizeof(T) ||
      blob.size() % sizeof(T) != 0) {
    row.FailRow("data has " + std::to_string(blob.size()) + " bytes, not the " +
                    std::to_string(rows) + " x " +
                    std::to_string(*num_columns) + " numbers of " +
                    std::to_string(sizeof(T)) + " bytes it says",
                ErrorCode::kParse);
  }
  return Numbers<T>(blob);
}

/// The columns camera_id, model, width, height and params, the first of which
/// is `column`.
inline Camera CameraOfRow(const Statement& row, int column) {
  Camera camera;
  camera.id = row.Unsigned(column);
  camera.model = static_cast<int>(row.Unsigned(column + 1));
  camera.width_px = row.Unsigned(column + 2);
  camera.height_px = row.Unsigned(column + 3);
  const std::string_view params = row.Blob(column + 4);
  if (params.size() % sizeof(double) != 0) {
    row.FailRow("params are cut off", ErrorCode::kParse);
  }
  camera.params = Numbers<double>(params);
  return camera;
}

/// Keypoints: x and y first, in pixels of COLMAP.
inline std::vector<std::pair<float, float>> ReadKeypoints(const Statement& row,
                                                          int column) {
  std::uint32_t cols = 0;
  const std::vector<float> numbers = ReadRows<float>(row, column, &cols);
  if (!numbers.empty() && cols != 2 && cols != 4 && cols != 6) {
    row.FailRow("keypoints have 2, 4 or 6 columns, not " +
                std::to_string(cols));
  }
  std::vector<std::pair<float, float>> points;
  for (std::size_t n = 0; n < numbers.size(); n += cols) {
    if (!std::isfinite(numbers[n]) || !std::isfinite(numbers[n + 1])) {
      row.FailRow("keypoint " + std::to_string(n / cols) + " is not finite");
    }
    points.emplace_back(numbers[n], numbers[n + 1]);
  }
  return points;
}

}  // namespace lowlap::colmap
