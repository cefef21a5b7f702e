#include "lowlap/pipeline/internal/measure/cache/measurement_bytes.h"

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace lowlap {
namespace {

class Writer {
 public:
  static constexpr bool kReads = false;

  template <class Number>
  void Value(const Number& number) {
    static_assert(std::is_trivially_copyable_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  std::size_t Count(std::size_t count) {
    Value(static_cast<std::uint64_t>(count));
    return count;
  }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  static constexpr bool kReads = true;

  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  void Value(Number& number) {
    static_assert(std::is_trivially_copyable_v<Number>);
    if (bytes_.size() < sizeof number) {
      fits_ = false;
      return;
    }
    std::memcpy(&number, bytes_.data(), sizeof number);
    bytes_.remove_prefix(sizeof number);
  }
  /// Every item takes a byte at least, so a wrong count allocates little.
  std::size_t Count(std::size_t) {
    std::uint64_t count = 0;
    Value(count);
    if (count > bytes_.size()) fits_ = false;
    return fits_ ? static_cast<std::size_t>(count) : 0;
  }
  bool Fits() const { return fits_ && bytes_.empty(); }

 private:
  std::string_view bytes_;
  bool fits_ = true;
};

// One description of the bytes for both directions. Structured bindings make a
// new member of a record fail to compile until it is stored too.

template <class Archive, class List, class Item>
void TransferList(Archive& archive, List& list, const Item& item) {
  const std::size_t count = archive.Count(list.size());
  if constexpr (Archive::kReads) list.resize(count);
  for (auto& element : list) item(element);
}

template <class Archive, class Vector>
void TransferVector(Archive& archive, Vector& vector) {
  for (auto& number : vector.reshaped()) archive.Value(number);
}

template <class Archive, class Keypoints>
void TransferKeypoints(Archive& archive, Keypoints& keypoints) {
  TransferList(archive, keypoints, [&](auto& keypoint) {
    auto& [position_px, scale_px, angle_rad, covariance, tilt] = keypoint;
    TransferVector(archive, position_px);
    archive.Value(scale_px);
    archive.Value(angle_rad);
    TransferVector(archive, covariance);
    archive.Value(tilt);
  });
}

template <class Archive, class Features>
void TransferFeatures(Archive& archive, Features& detected) {
  auto& [features, keypoints, point_descriptors, line_descriptors] = detected;
  // What repeats is told from these, and later.
  auto& [points_px, point_covariances, segments, repeated_points,
         repeated_segments] = features;
  TransferList(archive, points_px,
               [&](auto& point) { TransferVector(archive, point); });
  TransferList(archive, point_covariances,
               [&](auto& shape) { TransferVector(archive, shape); });
  TransferList(archive, segments, [&](auto& segment) {
    auto& [start_px, end_px, stddev_px] = segment;
    TransferVector(archive, start_px);
    TransferVector(archive, end_px);
    archive.Value(stddev_px);
  });
  TransferKeypoints(archive, keypoints);
  const auto value = [&](auto& descriptor) { archive.Value(descriptor); };
  TransferList(archive, point_descriptors, value);
  TransferList(archive, line_descriptors, value);
}

template <class Archive, class Tilted>
void TransferTilted(Archive& archive, Tilted& tilted) {
  auto& [added, looks] = tilted;
  auto& [keypoints, added_descriptors] = added;
  const auto value = [&](auto& number) { archive.Value(number); };
  TransferKeypoints(archive, keypoints);
  TransferList(archive, added_descriptors, value);
  TransferList(archive, looks, [&](auto& look) {
    auto& [descriptors, points] = look;
    TransferList(archive, descriptors, value);
    TransferList(archive, points, value);
  });
}

template <class Archive, class Matches>
void TransferMatches(Archive& archive, Matches& matches) {
  auto& [points, lines] = matches;
  for (auto* list : {&points, &lines}) {
    TransferList(archive, *list, [&](auto& match) {
      auto& [first, second] = match;
      archive.Value(first);
      archive.Value(second);
    });
  }
}

template <class Record, class Transfer>
std::string Written(const Record& record, const Transfer& transfer) {
  Writer writer;
  transfer(writer, record);
  return writer.Take();
}

template <class Record, class Transfer>
std::optional<Record> Parsed(std::string_view bytes, const Transfer& transfer) {
  Reader reader(bytes);
  Record record;
  transfer(reader, record);
  if (!reader.Fits()) return std::nullopt;
  return record;
}

constexpr auto kFeatures = [](auto& archive, auto& record) {
  TransferFeatures(archive, record);
};
constexpr auto kTilted = [](auto& archive, auto& record) {
  TransferTilted(archive, record);
};
constexpr auto kMatches = [](auto& archive, auto& record) {
  TransferMatches(archive, record);
};

}  // namespace

std::string ToBytes(const DetectedFeatures& features) {
  return Written(features, kFeatures);
}

std::optional<DetectedFeatures> FeaturesFromBytes(std::string_view bytes) {
  return Parsed<DetectedFeatures>(bytes, kFeatures);
}

std::string ToBytes(const TiltedPoints& points) {
  return Written(points, kTilted);
}

std::optional<TiltedPoints> TiltedPointsFromBytes(std::string_view bytes) {
  return Parsed<TiltedPoints>(bytes, kTilted);
}

std::string ToBytes(const PairMatches& matches) {
  return Written(matches, kMatches);
}

std::optional<PairMatches> MatchesFromBytes(std::string_view bytes) {
  return Parsed<PairMatches>(bytes, kMatches);
}

}  // namespace lowlap
