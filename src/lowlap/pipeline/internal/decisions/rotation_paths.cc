#include "lowlap/pipeline/internal/decisions/rotation_paths.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <set>
#include <utility>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr double kMaxStddevDeg = 5;

}  // namespace

RotationPaths::RotationPaths(const Scene& scene, double floor_rad)
    : floor_rad_(floor_rad) {
  for (const auto& entry : scene.relative_poses) Connect(entry.second);
}

double RotationPaths::VarianceOf(const RelativePose& pose) const {
  const double stated = RotationStddev(pose);
  return stated * stated + floor_rad_ * floor_rad_;
}

std::optional<PathPrior> RotationPaths::Find(const ViewPair& views) const {
  struct Reached {
    double variance;
    Mat3 here_from_first;
    ViewId from;
  };
  using State = std::pair<double, ViewId>;
  const double max_variance = std::pow(RadFromDeg(kMaxStddevDeg), 2);
  std::map<ViewId, Reached> reached;
  std::set<ViewId> done;
  std::priority_queue<State, std::vector<State>, std::greater<>> open;
  reached[views.first] = {0, Mat3::Identity(), views.first};
  open.push({0, views.first});
  while (!open.empty() && open.top().second != views.second) {
    const ViewId here = open.top().second;
    open.pop();
    const auto links = links_.find(here);
    if (!done.insert(here).second || links == links_.end()) continue;
    const Reached at_here = reached.at(here);
    for (const Link& link : links->second) {
      const double variance = at_here.variance + link.variance;
      const auto known = reached.find(link.to);
      if (OrderedPair(here, link.to) == views || variance > max_variance ||
          (known != reached.end() && known->second.variance <= variance)) {
        continue;
      }
      reached[link.to] = {variance, link.to_from_here * at_here.here_from_first,
                          here};
      open.push({variance, link.to});
    }
  }
  if (open.empty()) return std::nullopt;
  const Reached& end = reached.at(views.second);
  PathPrior prior{{end.here_from_first, std::sqrt(end.variance)}, {}};
  for (ViewId view = views.second; view != views.first;) {
    const ViewId from = reached.at(view).from;
    prior.path.push_back(OrderedPair(from, view));
    view = from;
  }
  return prior;
}

void RotationPaths::Replace(const RelativePose& pose) {
  const auto [first, second] = pose.views;
  for (const auto& [here, there] :
       {std::pair(first, second), std::pair(second, first)}) {
    std::vector<Link>& links = links_[here];
    links.erase(std::remove_if(links.begin(), links.end(),
                               [&, to = there](const Link& link) {
                                 return link.to == to;
                               }),
                links.end());
  }
  Connect(pose);
}

void RotationPaths::Connect(const RelativePose& pose) {
  if (!pose.covariance) return;
  const double variance = VarianceOf(pose) + std::pow(RotationSpread(pose), 2);
  links_[pose.views.first].push_back(
      {pose.views.second, pose.rotation, variance});
  links_[pose.views.second].push_back(
      {pose.views.first, pose.rotation.transpose(), variance});
}

}  // namespace lowlap
