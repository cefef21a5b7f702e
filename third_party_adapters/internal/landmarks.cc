#include "third_party_adapters/internal/landmarks.h"

#include <algorithm>
#include <utility>

namespace lowlap {

void AddNote(std::size_t count, const std::string& what, SceneNotes* notes) {
  if (count > 0) notes->push_back(std::to_string(count) + " " + what);
}

std::map<PointTrackId, Landmark> SolvedLandmarks(const Scene& scene,
                                                 SceneNotes* notes) {
  std::map<PointTrackId, Landmark> landmarks;
  std::size_t num_observations = 0, num_landmarks = 0;
  for (const auto& [id, landmark] : scene.structure) {
    Landmark kept;
    kept.position = landmark.position;
    for (const PointObservation& observation : landmark.observations) {
      if (scene.FindPose(observation.view) &&
          scene.FindIntrinsic(observation.view)) {
        kept.observations.push_back(observation);
      } else {
        ++num_observations;
      }
    }
    if (kept.observations.size() >= 2) {
      landmarks.emplace_hint(landmarks.end(), id, std::move(kept));
    } else {
      ++num_landmarks;
    }
  }
  AddNote(num_observations,
          "observations from views without a pose or an intrinsic were left "
          "out",
          notes);
  AddNote(num_landmarks,
          "landmarks with fewer than two observations were left out", notes);
  return landmarks;
}

bool LandmarkSorter::Sort(Landmark* landmark) {
  auto& all = landmark->observations;
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.view < b.view;
  });
  const auto end = std::unique(
      all.begin(), all.end(),
      [](const auto& a, const auto& b) { return a.view == b.view; });
  num_repeated_ += static_cast<std::size_t>(all.end() - end);
  all.erase(end, all.end());
  if (all.size() >= 2) return true;
  ++num_single_;
  return false;
}

void LandmarkSorter::Note(SceneNotes* notes) const {
  AddNote(num_repeated_,
          "observations of a point that its image observes once more were left "
          "out",
          notes);
  AddNote(num_single_,
          "points that fewer than two images observe were left out", notes);
}

}  // namespace lowlap
