#pragma once

#include <optional>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/directions/internal/vanishing_directions.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// Residuals of directions lose their hold beyond this many deviations.
inline constexpr double kDirectionLossScale = 3;

/// A direction in space as both views of a pair show it: +-direction2 =
/// cam2_from_cam1 direction1. It says nothing about the translation.
struct DirectionPair {
  Vec3 direction1 = Vec3::UnitZ();
  Vec3 direction2 = Vec3::UnitZ();
  Mat3 covariance1 = Mat3::Zero();
  Mat3 covariance2 = Mat3::Zero();
  /// Matched lines that run along it in both views.
  int num_matches = 0;
  /// Of the same matches as the pair before it, seen in more lines.
  bool repeats_matches = false;
  /// For a possible pair, without matches: how unlikely it is, in decimal
  /// digits, that a wrong rotation brings the two together.
  double agreement_digits = 0;
};

/// The vanishing directions of two views that the matched lines connect: each
/// match of a segment of one with a segment of the other is a vote. A pair is
/// kept with at least two votes, and half as many as any other pair that its
/// two directions are part of; the most voted first.
///
/// Both directions are fitted anew to the matched segments, so that what these
/// lines deviate from parallel is the same in both views. From eight votes on
/// the directions of all segments come as a second pair: more lines, but not
/// the same ones in both views.
std::vector<DirectionPair> PairDirections(
    const NormalizedFeatures& features1, const NormalizedFeatures& features2,
    const std::vector<VanishingDirection>& directions1,
    const std::vector<VanishingDirection>& directions2,
    const std::vector<FeatureMatch>& line_matches);

/// Pairs of vanishing directions that no matched line connects, which may be
/// one direction in space nonetheless: of the most meaningful four of either
/// view, those that are in none of the `connected` pairs. Where two views look
/// along one wall, its lines turn up in both even if none of them is matched.
/// With n1 and n2 directions to choose from, horizontal as most are, a wrong
/// rotation brings two together to within their deviation sigma with
/// probability
///   n1 n2 sigma sqrt(2 pi) / pi,
/// the agreement_digits of which are kept where there are any.
std::vector<DirectionPair> PossibleDirections(
    const std::vector<VanishingDirection>& directions1,
    const std::vector<VanishingDirection>& directions2,
    const std::vector<DirectionPair>& connected);

/// The disagreement of a pair under a rotation in its own standard deviations:
///   e = B^T (+-R direction1 - direction2),  B = TangentBasis(direction2),
///   m = W e,  W^T W = (B^T (R C1 R^T + C2) B)^-1,
/// and, if asked for, dm/dw for R <- exp([w]x) R with W held.
Vec2 DirectionResidual(const DirectionPair& pair, const Mat3& rotation,
                       Eigen::Matrix<double, 2, 3>* jacobian = nullptr);

/// What a rotation has against it, in decimal digits: for every pair
///   min(|m|^2 / (2 ln 10), min(num_matches, 10)),
/// or at most the agreement_digits of a possible one; of two pairs of the same
/// matches, the greater.
/// A pair whose directions disagree can still be a false one, if all of its
/// matches are wrong; the chance of one is taken as a tenth, and matches beyond
/// ten, parallel neighbours as they are, as no further evidence.
double DirectionPenalty(const std::vector<DirectionPair>& pairs,
                        const Mat3& rotation);

/// Every rotation that two of the pairs agree on (two per couple of pairs,
/// since directions have no sign), brought to the optimum over all pairs that
/// support it; without repetitions, least penalty first. Two pairs must be at
/// least ten degrees apart.
std::vector<Mat3> RotationsFromDirections(
    const std::vector<DirectionPair>& pairs);

}  // namespace lowlap
