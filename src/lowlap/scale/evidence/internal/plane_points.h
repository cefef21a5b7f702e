#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/scale/evidence/evidence_kind.h"
#include "lowlap/scale/internal/planes/planes_by_pair.h"

namespace lowlap {

/// A virtual trifocal point: a place of the middle view whose depth comes from
/// a plane of one pair, and from features of the other pair that lie in the
/// plane's extent, none of which is seen in three views.
struct PlanePoint {
  /// The place, and its images in i (at the depth of pair (i, j)) and in k (at
  /// that of pair (j, k)); `point_in_middle` means nothing.
  TripletPoint point;
  RatioCandidate ratio;  // always kValid
  /// Of which pair the plane is: (i, j), else (j, k).
  bool plane_is_first = true;
  int plane = 0;  // index in that pair's planes
  /// The other pair's plane on which most of its samples lie; kNoPlane: none.
  int other_plane = PairPlanes::kNoPlane;
  int num_samples = 0;  // of the other pair that agree on the ratio
};

/// For every plane of either pair that has samples of the other in its extent,
/// the ratio on which most of them agree.
///
/// A sample with inverse depth rho at the ray x, in the extent of a plane with
/// p . x of the other pair, says (Salaün et al. 2017, conclusion: points that
/// are coplanar with lines, and with points)
///   tau = z_ij / z_jk = rho_jk / rho_ij,
/// with, to first order, var(log tau) = (s_plane / p . x)^2 + (s_rho / rho)^2:
/// the fit of the plane and the two measurements. As with pairs of lines, it
/// is used unless hopeless (kMaxPlaneLogRatioStddev). Features matched in
/// both pairs are passed over: they are trifocal.
///
/// What lies on one plane agrees with each other, also if it is a wrong one
/// (of two parallel planes, say), so a plane is one piece of evidence: its
/// samples are joined, and of the planes that are connected by lying on each
/// other (a wall of (i, j), its like in (j, k), the parts into which either has
/// fallen) only the surest is kept. The ratio of a plane is the weighted mean
/// of the largest set that agrees with one of them within kAgree standard
/// deviations. The errors of the samples average out, and are scaled by their
/// scatter; that of the plane does not. Left out: planes with fewer than
/// kMinSamples that agree, or whose set is not the majority.
///
/// Sorted: planes of (i, j), then those of (j, k), each by index.
std::vector<PlanePoint> FindPlanePoints(const TripletGeometry& geometry,
                                        const PairPlanes& planes_ij,
                                        const PairPlanes& planes_jk);

/// Plane points as evidence, for triplets that nothing else decides: the errors
/// are those of trifocal points. Knows the planes that it was given, or those
/// of the triplets that it was prepared for; about others it says nothing.
class PlanePointsKind : public EvidenceKind {
 public:
  explicit PlanePointsKind(PlanesByPair planes = {})
      : planes_(std::move(planes)) {}
  std::string Name() const override { return "plane_points"; }
  EvidenceRound Round() const override { return EvidenceRound::kUndecided; }
  std::unique_ptr<Evidence> Gather(const TripletView& triplet) const override;
  /// PairsOverlap.
  bool MaySpeak(const SceneFeatures& scene,
                const ViewTriplet& views) const override;
  Result<std::shared_ptr<const EvidenceKind>> Prepare(
      const SceneFeatures& scene, const std::vector<ViewTriplet>& triplets,
      const RunContext& context) const override;

 private:
  PlanesByPair planes_;
};

}  // namespace lowlap
