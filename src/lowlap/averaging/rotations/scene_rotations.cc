#include "lowlap/averaging/rotations/scene_rotations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "lowlap/averaging/rotations/internal/bridges.h"
#include "lowlap/core/median.h"
#include "lowlap/core/union_find.h"
#include "lowlap/geometry/rotation.h"

namespace lowlap {
namespace {

constexpr double kRotationFloorRad = 5e-4;
constexpr double kDefaultRotationRad = 5e-3;
// The median of the norm of a 3-vector of normal errors, in deviations.
constexpr double kMedianOfNorm = 1.54;

double Evidence(const RelativePose& pose) {
  return std::max(0.0, -pose.log10_nfa);
}

// The views of the largest connected component of the given edges.
std::set<ViewId> LargestComponent(const std::set<ViewPair>& edges) {
  std::map<ViewId, std::size_t> index;
  for (const ViewPair& edge : edges) {
    index.emplace(edge.first, index.size());
    index.emplace(edge.second, index.size());
  }
  UnionFind sets(index.size());
  for (const ViewPair& edge : edges) {
    sets.Union(index.at(edge.first), index.at(edge.second));
  }
  const std::vector<std::size_t> labels = sets.Labels();
  std::map<std::size_t, std::set<ViewId>> components;
  for (const auto& [view, n] : index) components[labels[n]].insert(view);
  std::set<ViewId> largest;
  for (auto& entry : components) {
    if (entry.second.size() > largest.size()) largest = std::move(entry.second);
  }
  return largest;
}

class SceneRotationSolver {
 public:
  SceneRotationSolver(const Scene& scene,
                      const RotationAveragingOptions& options, double reach,
                      double least_false_rad)
      : scene_(scene),
        options_(options),
        reach_(reach),
        least_false_rad_(least_false_rad) {
    for (const auto& entry : scene.relative_poses) kept_.insert(entry.first);
  }

  Result<SceneRotations> Solve() {
    do {
      if (const Status averaged = Average(); !averaged) {
        return tl::unexpected<Error>(averaged.error());
      }
      // Leaving one out may take a view with it, so start over after it.
    } while (RejectByRotation() || SettleLoops() || RejectByEvidence());
    Report();
    return result_;
  }

 private:
  const RelativePose& PoseOf(const ViewPair& views) const {
    return scene_.relative_poses.at(views);
  }

  Status Average() {
    const std::set<ViewId> component = LargestComponent(kept_);
    if (component.empty()) {
      return MakeError(ErrorCode::kInsufficientData,
                       "no two relative rotations agree");
    }
    views_.assign(component.begin(), component.end());
    std::map<ViewId, std::size_t> index;
    for (const ViewId view : views_) index.emplace(view, index.size());
    used_.clear();
    graph_.clear();
    is_kept_.clear();
    std::vector<RotationMeasurement> measurements;
    for (const auto& [views, pose] : scene_.relative_poses) {
      const auto first = index.find(views.first);
      const auto second = index.find(views.second);
      if (first == index.end() || second == index.end()) continue;
      used_.push_back(views);
      graph_.push_back({first->second, second->second});
      is_kept_.push_back(kept_.count(views) > 0);
      if (!is_kept_.back()) continue;
      RotationMeasurement m;
      m.first = first->second;
      m.second = second->second;
      m.second_from_first = pose.rotation;
      m.stddev_rad = RotationStddev(pose);
      m.cost = pose.log10_nfa;
      m.trusted = trusted_.count(views) > 0;
      measurements.push_back(m);
    }
    const auto solved = AverageRotations(views_.size(), measurements, options_);
    if (!solved) return tl::unexpected<Error>(solved.error());
    for (std::size_t n = 0; n < views_.size(); ++n) {
      rotations_[views_[n]] = solved->cam_from_world[n];
    }
    if (sigma_ == 0) {
      std::vector<double> near;
      for (std::size_t e = 0; e < measurements.size(); ++e) {
        const double r = solved->residuals_rad[e];
        if (r <= 5 * solved->deviation_scale * measurements[e].stddev_rad) {
          near.push_back(r);
        }
      }
      sigma_ =
          std::max(Median(std::move(near)) / kMedianOfNorm, kRotationFloorRad);
    }
    result_.median_residual_rad = Median(solved->residuals_rad);
    return {};
  }

  double ResidualRad(const ViewPair& views) const {
    return RotationAngleBetween(
        PoseOf(views).rotation,
        rotations_.at(views.second) * rotations_.at(views.first).transpose());
  }

  void LeaveOut(const ViewPair& views, OutlierReason reason) {
    kept_.erase(views);
    OutlierEdge& outlier = outliers_[views];
    outlier = {views, reason, 0};
    if (reason == OutlierReason::kRotation) {
      outlier.error_deg = DegFromRad(ResidualRad(views));
    }
  }

  bool RejectByRotation() {
    bool changed = false;
    for (std::size_t e = 0; e < used_.size(); ++e) {
      if (!is_kept_[e] || settled_.count(used_[e]) > 0) continue;
      const double own = std::max(sigma_, RotationStddev(PoseOf(used_[e])));
      if (ResidualRad(used_[e]) > std::max(reach_ * own, least_false_rad_)) {
        LeaveOut(used_[e], OutlierReason::kRotation);
        changed = true;
      }
    }
    return changed;
  }

  // Decides on rejected edges whose loop holds two unchecked edges or more, if
  // no other rejected edge crosses any of them: see AverageSceneRotations.
  bool SettleLoops() {
    const auto states = ExamineBridges(views_.size(), graph_, is_kept_);
    const auto loops = BridgesClosedBy(views_.size(), graph_, is_kept_);
    bool changed = false;
    for (std::size_t e = 0; e < loops.size(); ++e) {
      const bool alone = std::all_of(
          loops[e].begin(), loops[e].end(), [&](std::size_t bridge) {
            return states[bridge].contradictions.size() == 1;
          });
      if (loops[e].size() < 2 || !alone || settled_.count(used_[e]) > 0) {
        continue;
      }
      SettleLoop(used_[e], loops[e]);
      changed = true;
    }
    return changed;
  }

  void SettleLoop(const ViewPair& closing,
                  const std::vector<std::size_t>& bridges) {
    LoopClosing loop;
    loop.closing_deg = DegFromRad(ResidualRad(closing));
    loop.edges.push_back(closing);
    for (const std::size_t bridge : bridges)
      loop.edges.push_back(used_[bridge]);
    double variance = 0;
    for (const ViewPair& views : loop.edges) {
      variance += 3 * std::pow(RotationStddev(PoseOf(views)), 2);
      settled_.insert(views);
    }
    loop.expected_deg = DegFromRad(std::sqrt(variance));
    kept_.insert(closing);
    outliers_.erase(closing);
    if (loop.closing_deg > reach_ * loop.expected_deg) {
      loop.left_out =
          *std::min_element(loop.edges.begin(), loop.edges.end(),
                            [&](const ViewPair& a, const ViewPair& b) {
                              return Evidence(PoseOf(a)) < Evidence(PoseOf(b));
                            });
      LeaveOut(*loop.left_out, OutlierReason::kOpenLoop);
    } else {
      // A loop that also runs over checked edges must not bend these.
      std::set<ViewId> views;
      for (const ViewPair& edge : loop.edges) {
        views.insert({edge.first, edge.second});
      }
      if (views.size() == loop.edges.size()) {
        trusted_.insert(loop.edges.begin(), loop.edges.end());
      }
    }
    result_.loops.push_back(std::move(loop));
  }

  bool RejectByEvidence() {
    const auto states = ExamineBridges(views_.size(), graph_, is_kept_);
    bool changed = false;
    for (std::size_t e = 0; e < states.size(); ++e) {
      if (settled_.count(used_[e]) > 0) continue;
      double against = 0;
      for (const std::size_t c : states[e].contradictions) {
        against += Evidence(PoseOf(used_[c]));
      }
      if (against > Evidence(PoseOf(used_[e]))) {
        LeaveOut(used_[e], OutlierReason::kContradicted);
        changed = true;
      }
    }
    return changed;
  }

  void Report() {
    for (const ViewId view : views_) {
      result_.cam_from_world[view] = rotations_.at(view);
    }
    const auto states = ExamineBridges(views_.size(), graph_, is_kept_);
    for (std::size_t e = 0; e < states.size(); ++e) {
      if (!states[e].is_bridge) continue;
      result_.unchecked.push_back(used_[e]);
      if (states[e].contradictions.empty() || settled_.count(used_[e]) > 0) {
        continue;
      }
      ContestedLink link;
      link.edge = used_[e];
      for (const std::size_t c : states[e].contradictions) {
        link.contradictions.push_back(used_[c]);
      }
      for (const std::size_t n : states[e].beyond) {
        link.views.push_back(views_[n]);
      }
      result_.contested.push_back(std::move(link));
    }
    for (const auto& entry : outliers_) {
      result_.outliers.push_back(entry.second);
    }
  }

  const Scene& scene_;
  const RotationAveragingOptions& options_;
  const double reach_;
  const double least_false_rad_;

  std::set<ViewPair> kept_;
  std::map<ViewPair, OutlierEdge> outliers_;
  std::set<ViewPair> settled_;  // in a loop of `result_`
  std::set<ViewPair> trusted_;  // of these, those that share its closing error
  double sigma_ = 0;  // of the first average: it must not erode what is right

  // Of the last average: the component, and its relative poses.
  std::vector<ViewId> views_;
  std::vector<ViewPair> used_;
  std::vector<DifferenceEdge> graph_;
  std::vector<bool> is_kept_;
  std::map<ViewId, Mat3> rotations_;
  SceneRotations result_;
};

}  // namespace

double RotationStddev(const RelativePose& pose) {
  if (!pose.covariance) return kDefaultRotationRad;
  const double variance = pose.covariance->topLeftCorner<3, 3>().trace() / 3;
  return std::sqrt(std::max(variance, 0.0) +
                   kRotationFloorRad * kRotationFloorRad);
}

const char* OutlierReasonName(OutlierReason reason) {
  switch (reason) {
    case OutlierReason::kRotation:
      return "rotation";
    case OutlierReason::kDirection:
      return "direction";
    case OutlierReason::kContradicted:
      return "contradicted";
    case OutlierReason::kOpenLoop:
      return "open_loop";
  }
  return "";
}

std::vector<ViewPair> PairsOf(const std::vector<OutlierEdge>& outliers) {
  std::vector<ViewPair> pairs;
  pairs.reserve(outliers.size());
  for (const OutlierEdge& outlier : outliers) pairs.push_back(outlier.views);
  return pairs;
}

Result<SceneRotations> AverageSceneRotations(
    const Scene& scene, const RotationAveragingOptions& options,
    double outlier_reach, double least_false_rad) {
  if (scene.relative_poses.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     "the scene has no relative pose to build on");
  }
  return SceneRotationSolver(scene, options, outlier_reach, least_false_rad)
      .Solve();
}

}  // namespace lowlap
