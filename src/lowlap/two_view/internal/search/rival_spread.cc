#include "lowlap/two_view/internal/search/rival_spread.h"

#include <cmath>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// A quarter of what tells the two motions of a plane apart at least
// (MotionLead, ten digits).
constexpr double kScoreNoiseDigits = 2.5;

}  // namespace

double RivalWeight(double deficit_digits) {
  return 0.5 * std::erfc(deficit_digits / (kScoreNoiseDigits * std::sqrt(2.0)));
}

Eigen::Matrix<double, 5, 1> PoseError(const RigidTransform& pose,
                                      const RigidTransform& other) {
  Eigen::Matrix<double, 5, 1> error;
  error.head<3>() =
      AngleAxisFromRotation(other.rotation * pose.rotation.transpose());
  const Vec3 from = pose.translation.normalized();
  const Vec3 to = other.translation.normalized();
  const Vec2 across = TangentBasis(from).transpose() * to;
  const double sine = across.norm();
  const double angle = std::atan2(sine, to.dot(from));
  // The opposite direction lies to any side.
  error.tail<2>() = sine > 0 ? Vec2(angle / sine * across) : Vec2(angle, 0);
  return error;
}

Eigen::Matrix<double, 5, 5> SpreadOfRivals(
    const RigidTransform& best, const std::vector<RivalPose>& rivals) {
  Eigen::Matrix<double, 5, 5> sum = Eigen::Matrix<double, 5, 5>::Zero();
  double total = 1;
  for (const RivalPose& rival : rivals) {
    const Eigen::Matrix<double, 5, 1> error = PoseError(best, rival.pose);
    sum += rival.weight * error * error.transpose();
    total += rival.weight;
  }
  return sum / total;
}

}  // namespace lowlap
