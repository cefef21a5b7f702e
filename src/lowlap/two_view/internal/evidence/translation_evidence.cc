#include "lowlap/two_view/internal/evidence/translation_evidence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/log_combinatorics.h"
#include "lowlap/two_view/internal/search/chance_support.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {
namespace {

/// Parameters of a rotation, and of a relative pose.
constexpr double kRotationFreedom = 3, kPoseFreedom = 5;
/// Pairs of which at most one may be taken for a translation wrongly.
constexpr double kLog10Pairs = 3;

/// The votes of two directions have little in common if their epipolar lines
/// differ by 45 degrees, where along and across begin to change places. So many
/// caps of half that radius cover as much as the half sphere of directions.
double Log10Directions() { return -std::log10(1 - std::cos(kPi / 8)); }

/// The rotation that takes the bearings x1 closest to x2, with Cauchy weights
/// (iterated orthogonal Procrustes).
Mat3 FitRotation(const PointPairs& pairs, const std::vector<int>& indices,
                 const Mat3& start, double scale_rad) {
  Mat3 rotation = start;
  for (int iteration = 0; iteration < 10; ++iteration) {
    Mat3 correlation = Mat3::Zero();
    for (const int i : indices) {
      const Vec3 a = pairs.x1[i].normalized();
      const Vec3 b = pairs.x2[i].normalized();
      const double ratio = (rotation * a - b).norm() / scale_rad;
      correlation += b * a.transpose() / (1 + ratio * ratio);
    }
    rotation = NearestRotation(correlation);
  }
  return rotation;
}

/// What a rotation leaves of match i along its epipolar line, in pixels of
/// variance 1 like those of SampsonResidual; nullopt behind camera 2 or at the
/// epipole.
std::optional<double> ErrorAlong(const PointPairs& pairs, int i,
                                 const Mat3& rotation, const Vec3& direction) {
  const Vec3 p = rotation * pairs.x1[i];
  if (p.z() <= 1e-6 * p.norm()) return std::nullopt;
  const Vec2 u = p.head<2>() / p.z();
  const Vec2 epipolar = direction.head<2>() - direction.z() * u;
  const double norm = epipolar.norm();
  if (!(norm > 1e-9)) return std::nullopt;
  const Vec2 along = epipolar / norm;
  // du/dx1 of the transfer.
  const Mat2 transfer =
      (rotation.topLeftCorner<2, 2>() - u * rotation.bottomLeftCorner<1, 2>()) /
      p.z();
  const Vec2 along1 = transfer.transpose() * along;
  const double variance = along.dot(pairs.Covariance2(i) * along) /
                              (pairs.focal2_px * pairs.focal2_px) +
                          along1.dot(pairs.Covariance1(i) * along1) /
                              (pairs.focal1_px * pairs.focal1_px);
  return along.dot(pairs.x2[i].head<2>() / pairs.x2[i].z() - u) /
         std::sqrt(variance);
}

/// Takes the lines of match i; false if others have taken one before.
bool TakeLines(const PointPairs& pairs, int i, std::set<int>* taken) {
  if (pairs.lines.empty() || pairs.lines[i][0] < 0) return true;
  const auto [first, second] = pairs.lines[i];
  if (taken->count(first) || taken->count(second)) return false;
  taken->insert({first, second});
  return true;
}

}  // namespace

TranslationEvidence TestTranslation(const PointPairs& pairs,
                                    const RigidTransform& cam2_from_cam1,
                                    const std::vector<int>& inliers,
                                    double threshold_px, double precision_px) {
  TranslationEvidence evidence;
  const double scale = 3 * threshold_px / pairs.focal2_px;
  const Mat3 rotation =
      FitRotation(pairs, inliers, cam2_from_cam1.rotation, scale);
  for (const int i : inliers) {
    if (AngleBetween(rotation * pairs.x1[i], pairs.x2[i]) <= scale) {
      ++evidence.num_rotation_inliers;
    }
  }
  const double count = static_cast<double>(inliers.size());
  if (2 * evidence.num_rotation_inliers < count) return evidence;
  evidence.log10_nfa = 0;
  if (count <= kPoseFreedom) return evidence;

  const SampsonResidual across(cam2_from_cam1, pairs);
  const double along_scale = 1 / std::sqrt(1 - kRotationFreedom / (2 * count));
  const double across_scale = 1 / std::sqrt(1 - kPoseFreedom / count);
  std::vector<bool> is_inlier(pairs.size(), false);
  for (const int i : inliers) is_inlier[i] = true;
  std::set<int> taken_lines;
  int num_asked = 0, num_along = 0;
  for (int i = 0; i < pairs.size(); ++i) {
    const std::optional<double> along =
        ErrorAlong(pairs, i, rotation, cam2_from_cam1.translation);
    if (!along || (!is_inlier[i] && std::abs(*along) > threshold_px) ||
        !TakeLines(pairs, i, &taken_lines)) {
      continue;
    }
    ++num_asked;
    num_along += along_scale * std::abs(*along) >
                 std::max(precision_px, across_scale * std::abs(across(i)));
  }
  // Wrong matches among the inliers lie anywhere along their lines.
  const double num_outliers = pairs.size() - count;
  const double wrong_share =
      std::min(0.9, ChanceShare(pairs, cam2_from_cam1, threshold_px) *
                        num_outliers / count);
  evidence.log10_nfa = std::min(
      0.0,
      kLog10Pairs + Log10Directions() +
          Log10BinomialTail(num_asked, num_along, 0.5 * (1 + wrong_share)));
  return evidence;
}

}  // namespace lowlap
