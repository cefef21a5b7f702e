#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/matching/internal/loops/place_transfer.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// What other pairs of photographs say of a match.
enum class LoopVerdict {
  kUntold,
  /// Through third photographs one comes to the same place.
  kCloses,
  /// One comes to other places: one of them is a copy.
  kLeadsElsewhere,
};

/// Loops of matches through a third photograph. Two windows of a wall look
/// alike, and a walk along the wall keeps one of them on the epipolar lines of
/// the other, so that the geometry of two views cannot tell them apart. If a
/// third view sees both, the matches with it do: a match of a in view i and c
/// in view k closes if the place of a and that of c in view j, as the matches
/// of (i, j) and (k, j) near a and c tell them, are the same.
class MatchLoops {
 public:
  struct View {
    const ViewFeatures* features = nullptr;  // not owned
    double longer_side_px = 0;
  };
  explicit MatchLoops(std::map<ViewId, View> views);

  /// Point matches of a pair with none yet; they tell of those of others, if
  /// the size of the images is known.
  void Add(const ViewPair& pair, const std::vector<FeatureMatch>& points);

  /// For each of the matches of a pair the verdict of most third views. Places
  /// within 3 % of the longer side of an image are the same, beyond 8 % others;
  /// between, as without matches near, nothing is told.
  std::vector<LoopVerdict> OfPoints(
      const ViewPair& pair, const std::vector<FeatureMatch>& matches) const;
  /// The same of segments: each seen in the third view as the line through its
  /// end points, and compared across the lines.
  std::vector<LoopVerdict> OfLines(
      const ViewPair& pair, const std::vector<FeatureMatch>& matches) const;

 private:
  // Through a third view.
  struct Detour {
    const PlaceTransfer* from_first = nullptr;
    const PlaceTransfer* from_second = nullptr;
    double longer_side_px = 0;
  };
  std::vector<Detour> DetoursOf(const ViewPair& pair) const;

  std::map<ViewId, View> views_;
  std::map<ViewId, std::map<ViewId, PlaceTransfer>> transfers_;  // from, to
};

}  // namespace lowlap
