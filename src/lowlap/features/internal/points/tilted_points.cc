#include "lowlap/features/internal/points/tilted_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/features/internal/points/tilted_image.h"
#include "lowlap/geometry/types.h"

namespace lowlap {
namespace {

constexpr double kSamePlacePx = 1;
constexpr double kSamePlaceScales = 0.25;
constexpr double kSameScaleFactor = 1.5;
// Blobs that reach this far, in their scale, beyond the border are left out.
constexpr double kReachScales = 2;

// Points by their place.
class PlaceIndex {
 public:
  explicit PlaceIndex(const std::vector<Keypoint>& keypoints) {
    for (const Keypoint& keypoint : keypoints) Add(keypoint);
  }

  FeatureIndex Add(const Keypoint& keypoint) {
    const auto index = static_cast<FeatureIndex>(keypoints_.size());
    keypoints_.push_back(keypoint);
    cells_[CellOf(keypoint.position_px, {0, 0})].push_back(index);
    return index;
  }

  /// The nearest point at the same place and of nearly the same scale.
  std::optional<FeatureIndex> Find(const Keypoint& keypoint) const {
    // Cells are as wide as the largest radius looked at.
    const double radius =
        std::clamp(kSamePlaceScales * keypoint.scale_px, kSamePlacePx, kCellPx);
    std::optional<FeatureIndex> best;
    double least = radius;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const auto cell = cells_.find(CellOf(keypoint.position_px, {dx, dy}));
        if (cell == cells_.end()) continue;
        for (const FeatureIndex index : cell->second) {
          const Keypoint& other = keypoints_[index];
          const double distance =
              (other.position_px - keypoint.position_px).norm();
          const double factor = other.scale_px / keypoint.scale_px;
          if (distance < least && factor < kSameScaleFactor &&
              factor > 1 / kSameScaleFactor) {
            least = distance;
            best = index;
          }
        }
      }
    }
    return best;
  }

 private:
  static constexpr double kCellPx = 4;

  static std::uint64_t CellOf(const Vec2& position, const Eigen::Vector2i& by) {
    const auto column =
        static_cast<std::int32_t>(std::floor(position.x() / kCellPx) + by.x());
    const auto row =
        static_cast<std::int32_t>(std::floor(position.y() / kCellPx) + by.y());
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(row)) << 32) |
           static_cast<std::uint32_t>(column);
  }

  std::vector<Keypoint> keypoints_;
  std::unordered_map<std::uint64_t, std::vector<FeatureIndex>> cells_;
};

bool LiesWithin(const Keypoint& keypoint, const GrayImage& image) {
  const double reach = kReachScales * keypoint.scale_px;
  const Vec2& p = keypoint.position_px;
  return p.x() >= reach && p.y() >= reach && p.x() <= image.width - 1 - reach &&
         p.y() <= image.height - 1 - reach;
}

struct TiltAndTurn {
  double tilt;
  double turn_rad;
};

// From the image itself on, without it.
std::vector<TiltAndTurn> Looks(double max_tilt) {
  std::vector<TiltAndTurn> looks;
  const int steps =
      static_cast<int>(std::floor(2 * std::log2(max_tilt) + 1e-9));
  for (int step = 1; step <= steps; ++step) {
    const double tilt = std::pow(2, 0.5 * step);
    const int turns = static_cast<int>(std::ceil(180 * tilt / 72 - 1e-9));
    for (int n = 0; n < turns; ++n) looks.push_back({tilt, kPi * n / turns});
  }
  return looks;
}

// In the pixels of the image.
Result<PointFeatures> DetectInLook(const GrayImage& image,
                                   const TiltAndTurn& look,
                                   const PointOptions& points,
                                   const TiltOptions& tilts) {
  const double scale = std::min(1.0, static_cast<double>(tilts.max_side_px) /
                                         std::max(image.width, image.height));
  LOWLAP_ASSIGN_OR_RETURN(const TiltedImage tilted,
                          TiltImage(image, scale, look.tilt, look.turn_rad));
  PointOptions of_look = points;
  of_look.max_points = tilts.max_points;
  LOWLAP_ASSIGN_OR_RETURN(const PointFeatures found,
                          DetectPoints(tilted.image, of_look));
  PointFeatures in_image;
  for (std::size_t n = 0; n < found.keypoints.size(); ++n) {
    Keypoint keypoint = Untilted(found.keypoints[n], tilted);
    keypoint.tilt = look.tilt;
    if (!LiesWithin(keypoint, image)) continue;
    in_image.keypoints.push_back(keypoint);
    in_image.descriptors.push_back(found.descriptors[n]);
  }
  return in_image;
}

}  // namespace

Status TiltOptions::Validate() const {
  return Require(
      {{max_tilt >= 1 && max_tilt <= 16, "max_tilt must lie in [1, 16]"},
       {max_side_px >= 16, "max_side_px must be at least 16"},
       {max_points >= 1, "max_points of tilts must be at least 1"}});
}

Result<TiltedPoints> DetectTiltedPoints(const GrayImage& image,
                                        const PointFeatures& untilted,
                                        const PointOptions& points,
                                        const TiltOptions& tilts,
                                        const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(tilts.Validate());
  LOWLAP_RETURN_IF_ERROR(image.Validate());
  TiltedPoints result;
  result.looks.emplace_back();
  result.looks[0].descriptors = untilted.descriptors;
  result.looks[0].points.resize(untilted.keypoints.size());
  std::iota(result.looks[0].points.begin(), result.looks[0].points.end(),
            FeatureIndex{0});
  PlaceIndex places(untilted.keypoints);
  const auto looks = Looks(tilts.max_tilt);
  std::vector<Result<PointFeatures>> found(looks.size());
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, "tilted views", looks.size(), [&](std::size_t n) {
        found[n] = DetectInLook(image, looks[n], points, tilts);
      }));
  for (const Result<PointFeatures>& of_look : found) {
    if (!of_look) return tl::unexpected<Error>(of_look.error());
    TiltedPoints::Look look;
    look.descriptors = of_look->descriptors;
    for (std::size_t n = 0; n < of_look->keypoints.size(); ++n) {
      const Keypoint& keypoint = of_look->keypoints[n];
      std::optional<FeatureIndex> point = places.Find(keypoint);
      if (!point) {
        point = places.Add(keypoint);
        result.added.keypoints.push_back(keypoint);
        result.added.descriptors.push_back(of_look->descriptors[n]);
      }
      look.points.push_back(*point);
    }
    result.looks.push_back(std::move(look));
  }
  return result;
}

}  // namespace lowlap
