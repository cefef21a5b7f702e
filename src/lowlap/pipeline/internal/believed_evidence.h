#pragma once

#include <map>
#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The relative poses that the others say are wrong, by views: their matches
/// are not believed.
std::vector<ViewPair> FalsePairs(const PoseSummary& summary);

/// While it lives, the scene's tracks are without what only relative poses join
/// that were left out: of the observations of a track, the largest set (the one
/// with the first view, of equal ones) that the matches of relative poses that
/// were not left out join, directly or over others. In a scene whose relative
/// poses state no matches any of them may. Matches of one wall agree with the
/// right poses and with a wrong one, which would bend the adjustment its way. A
/// track that keeps fewer than two views is gone. The relative poses that were
/// left out are gone as well, and the ratios across them: no prior may hold
/// what contradicts the others. All of it comes back in the end.
class BelievedEvidence {
 public:
  /// `scene` must outlive this.
  BelievedEvidence(const std::vector<ViewPair>& left_out, Scene* scene);
  ~BelievedEvidence();
  BelievedEvidence(const BelievedEvidence&) = delete;
  BelievedEvidence& operator=(const BelievedEvidence&) = delete;

 private:
  Scene* scene_;
  std::map<PointTrackId, Track> changed_points_;  // as they were
  std::map<LineTrackId, Track> changed_lines_;
  std::map<ViewPair, RelativePose> left_out_poses_;
  std::vector<ScaleRatio> scale_ratios_;  // as they were
};

}  // namespace lowlap
