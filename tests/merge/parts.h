#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lowlap/geometry/similarity.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// The poses of some views as a model.
inline PartialModel PartOf(const std::map<ViewId, Pose>& poses,
                           const std::vector<ViewId>& views,
                           std::string name = "part") {
  PartialModel part;
  part.name = std::move(name);
  for (const ViewId view : views) part.poses[view] = poses.at(view);
  return part;
}

inline std::vector<ViewId> Range(std::uint32_t first, std::uint32_t last) {
  std::vector<ViewId> views;
  for (std::uint32_t view = first; view <= last; ++view) views.push_back(view);
  return views;
}

/// The poses in another frame and unit.
inline std::map<ViewId, Pose> Moved(std::map<ViewId, Pose> poses,
                                    const Similarity& new_from_old) {
  for (auto& entry : poses) {
    entry.second.center = new_from_old * entry.second.center;
    entry.second.rotation =
        entry.second.rotation * new_from_old.rotation.transpose();
  }
  return poses;
}

/// Scales and turns the poses of views >= `first` about the centre of the view
/// before: what a program does that glues two parts together at one camera.
inline PartialModel Glued(PartialModel model, ViewId first, double scale,
                          const Mat3& turn) {
  const Vec3 pivot = model.poses.at(first.value() - 1).center;
  Similarity wrong;
  wrong.scale = scale;
  wrong.rotation = turn;
  wrong.translation = pivot - scale * (turn * pivot);
  std::map<ViewId, Pose> beyond(model.poses.lower_bound(first),
                                model.poses.end());
  for (auto& [view, pose] : Moved(std::move(beyond), wrong)) {
    model.poses[view] = pose;
  }
  return model;
}

/// An open chain of nine views along the walls of a room, each related to the
/// next two, with noise.
inline SyntheticScene NoisyChain(std::uint64_t seed) {
  SyntheticOptions options;
  options.num_views = 9;
  options.pairs = "window:2";
  options.noise_px = 0.5;
  options.pose_noise_factor = 1;
  options.wrong_point_share = 0.05;
  options.seed = seed;
  return *Simulate(options);
}

}  // namespace lowlap
