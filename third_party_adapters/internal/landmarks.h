#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "lowlap/io/scene_format.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Adds "COUNT what" unless the count is 0.
void AddNote(std::size_t count, const std::string& what, SceneNotes* notes);

/// The points of a scene for programs that know observations by solved views
/// only: those by views with a pose and an intrinsic, of points that have two
/// or more of them. What is left out is noted.
std::map<PointTrackId, Landmark> SolvedLandmarks(const Scene& scene,
                                                 SceneNotes* notes);

/// Makes points of files, which list observations in any order, those of a
/// scene, and counts what has to go.
class LandmarkSorter {
 public:
  /// Sorts the observations by view, the first of each view; false for a
  /// landmark with fewer than two views, which a scene does not hold.
  bool Sort(Landmark* landmark);
  void Note(SceneNotes* notes) const;

 private:
  std::size_t num_repeated_ = 0;
  std::size_t num_single_ = 0;
};

}  // namespace lowlap
