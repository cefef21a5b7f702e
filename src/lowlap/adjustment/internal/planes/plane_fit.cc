#include "lowlap/adjustment/internal/planes/plane_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {

Across AcrossPlane(const FreeLandmark& landmark, const Plane& plane) {
  Across across;
  for (const FreePlace& place : landmark.places) {
    const double distance = plane.normal.dot(place.point) - plane.offset;
    if (std::abs(distance) >= std::abs(across.distance)) {
      across.distance = distance;
    }
    across.stddev = std::max(across.stddev, place.Stddev(plane.normal));
  }
  return across;
}

Plane FitPlane(const std::vector<const FreeLandmark*>& members,
               const Plane& plane, double thickness) {
  double total = 0;
  Vec3 mean = Vec3::Zero();
  Mat3 squares = Mat3::Zero();
  // About a point among them, so that nothing cancels.
  const Vec3 origin = members.front()->Center();
  for (const FreeLandmark* member : members) {
    for (const FreePlace& place : member->places) {
      const double stddev = place.Stddev(plane.normal);
      const double weight = 1 / (stddev * stddev + thickness * thickness);
      const Vec3 arm = place.point - origin;
      total += weight;
      mean += weight * arm;
      squares += weight * arm * arm.transpose();
    }
  }
  mean /= total;
  const Mat3 scatter = squares / total - mean * mean.transpose();
  Plane fitted;
  fitted.normal =
      Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvectors().col(0);
  if (fitted.normal.dot(plane.normal) < 0) fitted.normal = -fitted.normal;
  fitted.offset = fitted.normal.dot(origin + mean);
  return fitted;
}

double PlaneThickness(const std::vector<const FreeLandmark*>& members,
                      const Plane& plane) {
  std::vector<Across> across;
  std::vector<double> stddevs;
  double high = 0;
  for (const FreeLandmark* member : members) {
    across.push_back(AcrossPlane(*member, plane));
    stddevs.push_back(across.back().stddev);
    high = std::max(high, 2 * std::abs(across.back().distance));
  }
  double low = 0.25 * Median(std::move(stddevs));
  const auto median_at = [&](double thickness) {
    std::vector<double> normalised;
    normalised.reserve(across.size());
    for (const Across& one : across) {
      normalised.push_back(std::abs(one.distance) /
                           std::hypot(one.stddev, thickness));
    }
    return Median(std::move(normalised));
  };
  if (high <= low || median_at(low) <= kMedianOfNorm<1>) return low;
  constexpr int kBisections = 20;
  for (int n = 0; n < kBisections; ++n) {
    const double middle = std::sqrt(low * high);
    (median_at(middle) > kMedianOfNorm<1> ? low : high) = middle;
  }
  return high;
}

Mat3 FitBend(const std::vector<PlaneMember>& members, const Plane& plane,
             const Vec3& anchor, double thickness) {
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  const auto basis = TangentBasis(plane.normal);
  double sum = 0, count = 0;
  for (const PlaneMember& member : members) {
    for (const FreePlace& place : member.landmark->places) {
      sum += (basis.transpose() * (place.point - anchor)).squaredNorm();
      ++count;
    }
  }
  if (!(sum > 0)) return Mat3::Zero();
  const double extent = std::sqrt(sum / count);
  // The bend's three unknowns in thicknesses at the extent, of which the prior
  // is the same whatever way the basis is turned; then the plane's.
  Mat6 information = Mat6::Zero();
  information.diagonal().head<3>().setOnes();
  Vec6 gradient = Vec6::Zero();
  for (const PlaneMember& member : members) {
    for (const FreePlace& place : member.landmark->places) {
      const Vec2 x = basis.transpose() * (place.point - anchor) / extent;
      Vec6 row;
      row << x.x() * x.x(), std::sqrt(2) * x.x() * x.y(), x.y() * x.y(), 1, x;
      row *= thickness;
      const double stddev = place.Stddev(plane.normal);
      const double weight = 1 / (stddev * stddev + member.slack * member.slack);
      information += weight * row * row.transpose();
      gradient += weight * row * (plane.normal.dot(place.point) - plane.offset);
    }
  }
  const Vec6 solved =
      information.completeOrthogonalDecomposition().solve(gradient);
  Mat2 along;
  along << solved[0], solved[1] / std::sqrt(2), solved[1] / std::sqrt(2),
      solved[2];
  return thickness / (extent * extent) * basis * along * basis.transpose();
}

}  // namespace lowlap
