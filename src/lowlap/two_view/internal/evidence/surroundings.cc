#include "lowlap/two_view/internal/evidence/surroundings.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/triangulation.h"
#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

// A share of the diagonal of the features' box: some fifty squares a view, each
// of them a place of its own. Half of that counts one unmatched wall as
// several.
constexpr double kSquareSide = 0.1;
// What is nearer to the box's border may be cut off.
constexpr double kMargin = 0.04;
constexpr double kMinExpected = 2;

using Box = Eigen::AlignedBox2d;

Box BoxOf(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& point : points) {
    if (point.allFinite()) box.extend(point.head<2>());
  }
  return box;
}

// An inlier in one view.
struct Seen {
  FeatureIndex feature = 0;
  double depth = 0;
};

struct Squares {
  int num_present = 0, num_missing = 0;
};

class SquaresOfView {
 public:
  SquaresOfView(const std::vector<Vec3>& points, const Box& box,
                const std::vector<Seen>& inliers)
      : points_(points),
        origin_(box.min()),
        side_(kSquareSide * box.diagonal().norm()),
        inliers_(inliers) {
    for (std::size_t n = 0; n < points.size(); ++n) {
      if (points[n].allFinite()) squares_[SquareOf(points[n])].push_back(n);
    }
    for (const Seen& inlier : inliers) {
      depths_[SquareOf(points[inlier.feature])].push_back(inlier.depth);
    }
  }

  Squares Count(const RigidTransform& other_from_this,
                const Box& other_box) const {
    const Vec2 margin = kMargin * other_box.diagonal();
    const Box inner(other_box.min() + margin, other_box.max() - margin);
    Squares squares;
    double num_visible_of_present = 0;
    std::vector<int> num_visible_of_others;
    for (const auto& [square, features] : squares_) {
      const auto depths = depths_.find(square);
      const double depth = depths != depths_.end()
                               ? Median(depths->second)
                               : DepthNear(CenterOf(square));
      int num_visible = 0;
      for (const std::size_t n : features) {
        const Vec3 point = other_from_this * (depth * points_[n]);
        num_visible +=
            point.z() > 0 && inner.contains(Vec2(point.hnormalized()));
      }
      if (depths == depths_.end()) {
        num_visible_of_others.push_back(num_visible);
      } else {
        ++squares.num_present;
        num_visible_of_present += std::max<double>(
            num_visible, static_cast<double>(depths->second.size()));
      }
    }
    const double share =
        static_cast<double>(inliers_.size()) / num_visible_of_present;
    for (const int num_visible : num_visible_of_others) {
      squares.num_missing += num_visible * share >= kMinExpected;
    }
    return squares;
  }

 private:
  using Square = std::pair<int, int>;

  Square SquareOf(const Vec3& point) const {
    const Vec2 place = (point.head<2>() - origin_) / side_;
    return {static_cast<int>(place.x()), static_cast<int>(place.y())};
  }

  Vec2 CenterOf(const Square& square) const {
    return origin_ + side_ * Vec2(square.first + 0.5, square.second + 0.5);
  }

  double DepthNear(const Vec2& center) const {
    double depth = 0, least = std::numeric_limits<double>::infinity();
    for (const Seen& inlier : inliers_) {
      const double distance =
          (points_[inlier.feature].head<2>() - center).squaredNorm();
      if (distance < least) {
        least = distance;
        depth = inlier.depth;
      }
    }
    return depth;
  }

  const std::vector<Vec3>& points_;
  const Vec2 origin_;
  const double side_;
  const std::vector<Seen>& inliers_;
  std::map<Square, std::vector<std::size_t>> squares_;
  std::map<Square, std::vector<double>> depths_;
};

}  // namespace

double Log10ChanceOfSurroundings(const NormalizedFeatures& features1,
                                 const NormalizedFeatures& features2,
                                 const RelativePose& pose) {
  const std::vector<Vec3>&points1 = features1.points,
        &points2 = features2.points;
  const RayTriangulator triangulator(pose.Cam2FromCam1());
  std::vector<Seen> inliers1, inliers2;
  for (const FeatureMatch& match : pose.point_inliers) {
    const std::optional<Vec2> depths =
        triangulator.Depths(points1[match.first], points2[match.second]);
    if (!depths || !(depths->minCoeff() > 0)) continue;
    inliers1.push_back({match.first, (*depths)(0)});
    inliers2.push_back({match.second, (*depths)(1)});
  }
  if (inliers1.empty()) return 0;
  const Box box1 = BoxOf(points1), box2 = BoxOf(points2);
  if (!(box1.diagonal().norm() > 0 && box2.diagonal().norm() > 0)) return 0;
  const Squares of_first =
      SquaresOfView(points1, box1, inliers1).Count(pose.Cam2FromCam1(), box2);
  const Squares of_second = SquaresOfView(points2, box2, inliers2)
                                .Count(pose.Cam2FromCam1().Inverse(), box1);
  const int num_missing = of_first.num_missing + of_second.num_missing;
  const int num = of_first.num_present + of_second.num_present + num_missing;
  return Log10BinomialTail(num, num_missing, 0.5);
}

}  // namespace lowlap
