#pragma once

#include <map>
#include <vector>

#include "lowlap/averaging/centers/internal/evidence.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/ids.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// A relative pose that contradicts the solution.
struct RejectedPose {
  double evidence = 0;  // as that of what is in use
  /// How the world about the first view would turn against that about the
  /// second if the pose R_21 were right: R_2^T R_21 R_1 with the solution's
  /// rotations R_n (cam_from_world); and its deviation per axis.
  Mat3 turn = Mat3::Identity();
  double stddev_rad = 0;
};
using RejectedPoses = std::map<ViewPair, RejectedPose>;

/// Sets of views that what is in use joins to the others with little more
/// evidence than others have that contradict it and were rejected.
///
/// For every rejected pair whose views are joined, the cut of least evidence
/// between the two is looked at: it is contested if the rejected pairs across
/// it have more than half the evidence of those in use. Views that more than
/// eight ways without a common pair join are not contested. Where one camera
/// joins a set of views to the others, the ratios across it say how large they
/// are: these are contested if the rejected pairs that pass the camera by have
/// more than half the evidence of the best of them (what misleads one ratio
/// across a camera misleads the next).
///
/// Rejected pairs that would turn the views in different ways are not right
/// together, as places that look alike by accident would: of those across a cut
/// the ones count that agree with one of them, to within six degrees or three
/// deviations, and have the most evidence together.
///
/// What the same pairs contradict is one contest: one relative pose contradicts
/// every link of a chain. Cost: nine searches of the graph for each rejected
/// pair, about as many more where eight ways or less join it, and one for each
/// camera that joins parts; for each of these cuts, the square of the rejected
/// pairs across it.
std::vector<Contest> FindContests(const EvidenceOfPairs& in_use,
                                  const EvidenceOfRatios& ratios,
                                  const RejectedPoses& rejected);

}  // namespace lowlap
