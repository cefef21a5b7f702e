#pragma once

#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// What takes part in a solve: indices into the tracks and pairs of the state.
/// Lines of two poses that are neither in a pair in use nor on a plane
/// constrain nothing and are left out.
struct ProblemSelection {
  std::vector<int> points;
  std::vector<int> lines;
  std::vector<int> pairs;
  std::vector<int> planes;
  /// Of every line of the state: the number of selected pairs it is in.
  std::vector<int> pair_degree;

  bool IsEmpty() const { return points.empty() && lines.empty(); }
};

ProblemSelection SelectForSolve(const CameraSet& cameras,
                                const StructureState& state,
                                const AdjustmentOptions& options);

/// Views that see a line with a segment in use, ascending, each once.
std::vector<int> ViewsOf(const LineTrackState& line);

/// The poses that share selected structure, and their gauge.
struct Component {
  std::vector<int> poses;
  std::vector<int> points;
  std::vector<int> lines;
  std::vector<int> planes;
  /// Those of which most sights are of its poses, at least two.
  std::vector<int> directions;
  int reference = -1;   // the pose that is held: that with most observations
  int partner = -1;     // the pose farthest from it
  double baseline = 0;  // their distance; 0 if all centres coincide

  /// The length of 1 in the component's frame.
  double Unit() const { return baseline > 0 ? baseline : 1; }
};

/// Components of at least two poses. Every selected landmark is in one.
std::vector<Component> FindComponents(const CameraSet& cameras,
                                      const StructureState& state,
                                      const ProblemSelection& selection);

/// Moves every component into the frame of its reference camera, with the
/// baseline as the unit, and back. In this frame the input's position,
/// orientation and scale have no influence on the solve. Returned, and asked
/// for on the way back, are the reference poses in the world.
std::vector<PoseState> EnterComponentFrames(
    const std::vector<Component>& components, CameraSet* cameras,
    StructureState* state);
void LeaveComponentFrames(const std::vector<Component>& components,
                          const std::vector<PoseState>& references,
                          CameraSet* cameras, StructureState* state);

}  // namespace lowlap
