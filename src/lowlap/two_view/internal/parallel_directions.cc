#include "lowlap/two_view/internal/parallel_directions.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

constexpr int kMinVotes = 2;
constexpr int kMinVotesForAll = 8;
constexpr int kMaxDigits = 10;
constexpr std::size_t kMaxPossible = 4;
/// By how much lines of different walls that count as parallel are not.
const double kWallStddevRad = RadFromDeg(0.3);

// The direction of every segment that has one.
std::map<FeatureIndex, std::size_t> DirectionOfSegment(
    const std::vector<VanishingDirection>& directions) {
  std::map<FeatureIndex, std::size_t> result;
  for (std::size_t n = 0; n < directions.size(); ++n) {
    for (const int segment : directions[n].segments) {
      result[static_cast<FeatureIndex>(segment)] = n;
    }
  }
  return result;
}

// Of one view: to within their deviations.
bool AreOne(const VanishingDirection& a, const VanishingDirection& b) {
  const DirectionPair pair{a.direction, b.direction,
                           WidenedCovariance(a, kWallStddevRad),
                           WidenedCovariance(b, kWallStddevRad), 0};
  return DirectionResidual(pair, Mat3::Identity()).norm() <=
         kDirectionLossScale;
}

// Rotation that takes a, b to +-c, +-d: the frames of both couples aligned.
Mat3 AlignFrames(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto frame = [](const Vec3& p, const Vec3& q) {
    Mat3 m;
    m.col(0) = (p + q).normalized();
    m.col(2) = p.cross(q).normalized();
    m.col(1) = m.col(2).cross(m.col(0));
    return m;
  };
  return frame(c, d) * frame(a, b).transpose();
}

Mat3 RefineRotation(const std::vector<DirectionPair>& pairs, Mat3 rotation) {
  for (int iteration = 0; iteration < 10; ++iteration) {
    Mat3 hessian = 1e-9 * Mat3::Identity();
    Vec3 gradient = Vec3::Zero();
    for (const DirectionPair& pair : pairs) {
      Eigen::Matrix<double, 2, 3> jacobian;
      const Vec2 m = DirectionResidual(pair, rotation, &jacobian);
      const double x =
          m.squaredNorm() / (kDirectionLossScale * kDirectionLossScale);
      const double weight = 1 / ((1 + x) * (1 + x));
      hessian += weight * jacobian.transpose() * jacobian;
      gradient += weight * jacobian.transpose() * m;
    }
    const Vec3 step = -hessian.ldlt().solve(gradient);
    rotation = RotationFromAngleAxis(step) * rotation;
    if (step.norm() < 1e-10) break;
  }
  return NearestRotation(rotation);
}

}  // namespace

std::vector<DirectionPair> PairDirections(
    const NormalizedFeatures& features1, const NormalizedFeatures& features2,
    const std::vector<VanishingDirection>& directions1,
    const std::vector<VanishingDirection>& directions2,
    const std::vector<FeatureMatch>& line_matches) {
  const auto of1 = DirectionOfSegment(directions1);
  const auto of2 = DirectionOfSegment(directions2);
  std::map<std::pair<std::size_t, std::size_t>, std::vector<FeatureMatch>>
      votes;
  std::vector<int> most1(directions1.size(), 0), most2(directions2.size(), 0);
  for (const FeatureMatch& match : line_matches) {
    const auto n1 = of1.find(match.first);
    const auto n2 = of2.find(match.second);
    if (n1 == of1.end() || n2 == of2.end()) continue;
    std::vector<FeatureMatch>& matches = votes[{n1->second, n2->second}];
    matches.push_back(match);
    const int count = static_cast<int>(matches.size());
    most1[n1->second] = std::max(most1[n1->second], count);
    most2[n2->second] = std::max(most2[n2->second], count);
  }
  std::vector<DirectionPair> pairs;
  for (const auto& [indices, matches] : votes) {
    const auto [n1, n2] = indices;
    const int count = static_cast<int>(matches.size());
    if (count < kMinVotes || 2 * count < std::max(most1[n1], most2[n2])) {
      continue;
    }
    // Deviations are the lines' own in both views, and cancel.
    VanishingOptions matched;
    matched.parallel_stddev_deg = 0.05;
    std::vector<int> segments1, segments2;
    for (const FeatureMatch& match : matches) {
      segments1.push_back(static_cast<int>(match.first));
      segments2.push_back(static_cast<int>(match.second));
    }
    const VanishingDirection d1 =
        FitDirection(features1, segments1, directions1[n1].direction, matched);
    const VanishingDirection d2 =
        FitDirection(features2, segments2, directions2[n2].direction, matched);
    pairs.push_back(
        {d1.direction, d2.direction, d1.covariance, d2.covariance, count});
    // That the two sets are one direction is known from the matched ones alone,
    // which may be but a part that is parallel to itself.
    const VanishingDirection &a1 = directions1[n1], &a2 = directions2[n2];
    if (count < kMinVotesForAll || !AreOne(d1, a1) || !AreOne(d2, a2)) continue;
    pairs.push_back({a1.direction, a2.direction, a1.covariance, a2.covariance,
                     count, true});
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const DirectionPair& a, const DirectionPair& b) {
                     return a.num_matches > b.num_matches;
                   });
  return pairs;
}

std::vector<DirectionPair> PossibleDirections(
    const std::vector<VanishingDirection>& directions1,
    const std::vector<VanishingDirection>& directions2,
    const std::vector<DirectionPair>& connected) {
  const double same = std::cos(RadFromDeg(3));
  const auto free_of = [&](const std::vector<VanishingDirection>& directions,
                           Vec3 DirectionPair::*member) {
    std::vector<VanishingDirection> free;
    for (const VanishingDirection& direction : directions) {
      const bool is_connected = std::any_of(
          connected.begin(), connected.end(), [&](const DirectionPair& pair) {
            return std::abs((pair.*member).dot(direction.direction)) > same;
          });
      if (!is_connected && free.size() < kMaxPossible)
        free.push_back(direction);
    }
    return free;
  };
  const auto free1 = free_of(directions1, &DirectionPair::direction1);
  const auto free2 = free_of(directions2, &DirectionPair::direction2);
  std::vector<DirectionPair> pairs;
  for (const VanishingDirection& d1 : free1) {
    for (const VanishingDirection& d2 : free2) {
      DirectionPair pair{d1.direction, d2.direction,
                         WidenedCovariance(d1, kWallStddevRad),
                         WidenedCovariance(d2, kWallStddevRad)};
      const double stddev =
          std::sqrt((pair.covariance1 + pair.covariance2).trace());
      pair.agreement_digits =
          std::log10(std::sqrt(M_PI / 2) / stddev /
                     static_cast<double>(free1.size() * free2.size()));
      if (pair.agreement_digits > 0) pairs.push_back(pair);
    }
  }
  return pairs;
}

Vec2 DirectionResidual(const DirectionPair& pair, const Mat3& rotation,
                       Eigen::Matrix<double, 2, 3>* jacobian) {
  Vec3 turned = rotation * pair.direction1;
  if (turned.dot(pair.direction2) < 0) turned = -turned;
  const auto basis = TangentBasis(pair.direction2);
  const Mat2 covariance =
      basis.transpose() *
      (rotation * pair.covariance1 * rotation.transpose() + pair.covariance2) *
      basis;
  const Eigen::LLT<Mat2> factor(covariance);
  if (jacobian != nullptr) {
    const Eigen::Matrix<double, 2, 3> raw =
        -basis.transpose() * CrossMatrix(turned);
    *jacobian = factor.matrixL().solve(raw);
  }
  const Vec2 error = basis.transpose() * turned;
  // Beyond 90 degrees the tangent plane folds; the sign above excludes it.
  return factor.matrixL().solve(error);
}

double DirectionPenalty(const std::vector<DirectionPair>& pairs,
                        const Mat3& rotation) {
  double digits = 0;
  double of_last = 0;
  for (const DirectionPair& pair : pairs) {
    const double most = pair.num_matches > 0
                            ? std::min(pair.num_matches, kMaxDigits)
                            : pair.agreement_digits;
    const double of_pair = std::min(
        DirectionResidual(pair, rotation).squaredNorm() / (2 * std::log(10.0)),
        most);
    digits += pair.repeats_matches ? std::max(0.0, of_pair - of_last) : of_pair;
    of_last = of_pair;
  }
  return digits;
}

std::vector<Mat3> RotationsFromDirections(
    const std::vector<DirectionPair>& pairs) {
  const double min_sine = std::sin(RadFromDeg(10));
  std::vector<std::pair<double, Mat3>> found;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t j = i + 1; j < pairs.size(); ++j) {
      const DirectionPair &a = pairs[i], &b = pairs[j];
      if (a.direction1.cross(b.direction1).norm() < min_sine ||
          a.direction2.cross(b.direction2).norm() < min_sine) {
        continue;
      }
      // The angle between the two directions settles their relative sign; near
      // 90 degrees it does not, and both are tried.
      for (const double sign_a : {1.0, -1.0}) {
        for (const double sign_b : {1.0, -1.0}) {
          const Vec3 c = sign_a * a.direction2, d = sign_b * b.direction2;
          const double difference = std::abs(
              AngleBetween(a.direction1, b.direction1) - AngleBetween(c, d));
          if (difference > RadFromDeg(5)) continue;
          const Mat3 rotation = RefineRotation(
              pairs, AlignFrames(a.direction1, b.direction1, c, d));
          const bool known =
              std::any_of(found.begin(), found.end(), [&](const auto& f) {
                return RotationAngleBetween(f.second, rotation) < 1e-3;
              });
          if (!known) {
            found.emplace_back(DirectionPenalty(pairs, rotation), rotation);
          }
        }
      }
    }
  }
  std::stable_sort(
      found.begin(), found.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Mat3> rotations;
  rotations.reserve(found.size());
  for (const auto& entry : found) rotations.push_back(entry.second);
  return rotations;
}

}  // namespace lowlap
