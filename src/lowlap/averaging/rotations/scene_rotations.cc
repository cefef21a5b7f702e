#include "lowlap/averaging/rotations/scene_rotations.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/rotations/internal/bridges.h"
#include "lowlap/averaging/rotations/internal/rotation_averaging.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr double kDefaultRotationRad = 5e-3;

double EvidenceOf(const RelativePose& pose) {
  return std::max(0.0, -pose.log10_nfa);
}

class SceneRotationSolver {
 public:
  SceneRotationSolver(const Scene& scene,
                      const RotationAveragingOptions& options,
                      const ErrorLimits& limits, const RunContext& context,
                      ThirdViewVerdicts third_views)
      : scene_(scene), options_(options), context_(context), limits_(limits) {
    result_.third_views = std::move(third_views);
    for (const auto& [views, pose] : scene.relative_poses) {
      if (IsOutweighed(views)) {
        outliers_[views] = {views, OutlierReason::kOutweighed, 0};
      } else {
        kept_.insert(views);
      }
    }
  }

  Result<SceneRotations> Solve() {
    do {
      LOWLAP_RETURN_IF_ERROR(Average());
      // Leaving one out may take a view with it, so start over after it.
    } while (RejectByRotation() || SettleLoops() || RejectByEvidence());
    Report();
    return result_;
  }

 private:
  bool IsOutweighed(const ViewPair& views) const {
    return result_.third_views.outweighed.count(views) > 0;
  }

  const RelativePose& PoseOf(const ViewPair& views) const {
    return scene_.relative_poses.at(views);
  }

  Status Average() {
    const std::vector<ViewPair> all_kept(kept_.begin(), kept_.end());
    const auto components = ConnectedComponents(ViewGraph(all_kept));
    if (components.empty()) {
      return MakeError(ErrorCode::kInsufficientData,
                       "no two relative rotations agree");
    }
    views_ = components.front();
    std::map<ViewId, std::size_t> index;
    for (const ViewId view : views_) index.emplace(view, index.size());
    std::vector<ViewPair> kept;
    rejected_.clear();
    std::vector<RotationMeasurement> measurements;
    for (const auto& [views, pose] : scene_.relative_poses) {
      const auto first = index.find(views.first);
      const auto second = index.find(views.second);
      if (first == index.end() || second == index.end()) continue;
      if (kept_.count(views) == 0) {
        if (!IsOutweighed(views)) rejected_.push_back(views);
        continue;
      }
      kept.push_back(views);
      RotationMeasurement m;
      m.first = first->second;
      m.second = second->second;
      m.second_from_first = pose.rotation;
      m.stddev_rad = RotationStddev(pose);
      m.cost = pose.log10_nfa;
      m.trusted = trusted_.count(views) > 0;
      measurements.push_back(m);
    }
    graph_ = ViewGraph(std::move(kept));
    LOWLAP_ASSIGN_OR_RETURN(
        const auto solved,
        AverageRotations(views_.size(), measurements, options_, context_));
    for (std::size_t n = 0; n < views_.size(); ++n) {
      rotations_[views_[n]] = solved.cam_from_world[n];
    }
    if (sigma_ == 0) {
      std::vector<double> near;
      for (std::size_t e = 0; e < measurements.size(); ++e) {
        const double r = solved.residuals_rad[e];
        if (r <= 5 * solved.deviation_scale * measurements[e].stddev_rad) {
          near.push_back(r);
        }
      }
      sigma_ = ResidualStddev<3>(std::move(near));
    }
    result_.median_residual_rad = Median(solved.residuals_rad);
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
    for (const ViewPair& views : graph_.pairs()) {
      if (settled_.count(views) > 0) continue;
      if (ResidualRad(views) >
          limits_.RotationRad(sigma_, RotationStddev(PoseOf(views)))) {
        LeaveOut(views, OutlierReason::kRotation);
        changed = true;
      }
    }
    return changed;
  }

  // Decides on rejected edges whose loop holds two unchecked edges or more, if
  // no other rejected edge crosses any of them: see AverageSceneRotations.
  bool SettleLoops() {
    const BridgeReport report = ExamineBridges(graph_, rejected_);
    bool changed = false;
    for (const auto& [closing, bridges] : report.crossed) {
      const bool alone = std::all_of(
          bridges.begin(), bridges.end(), [&](const ViewPair& bridge) {
            return report.bridges.at(bridge).size() == 1;
          });
      if (bridges.size() < 2 || !alone || settled_.count(closing) > 0) {
        continue;
      }
      SettleLoop(closing, bridges);
      changed = true;
    }
    return changed;
  }

  void SettleLoop(const ViewPair& closing,
                  const std::vector<ViewPair>& bridges) {
    LoopClosing loop;
    loop.closing_deg = DegFromRad(ResidualRad(closing));
    loop.edges.push_back(closing);
    loop.edges.insert(loop.edges.end(), bridges.begin(), bridges.end());
    double variance = 0;
    for (const ViewPair& views : loop.edges) {
      variance += 3 * std::pow(RotationStddev(PoseOf(views)), 2);
      settled_.insert(views);
    }
    loop.expected_deg = DegFromRad(std::sqrt(variance));
    kept_.insert(closing);
    outliers_.erase(closing);
    if (loop.closing_deg > limits_.reach * loop.expected_deg) {
      loop.left_out = *std::min_element(
          loop.edges.begin(), loop.edges.end(),
          [&](const ViewPair& a, const ViewPair& b) {
            return EvidenceOf(PoseOf(a)) < EvidenceOf(PoseOf(b));
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
    bool changed = false;
    const BridgeReport report = ExamineBridges(graph_, rejected_);
    for (const auto& [views, contradictions] : report.bridges) {
      if (settled_.count(views) > 0) continue;
      double against = 0;
      for (const ViewPair& other : contradictions) {
        against += EvidenceOf(PoseOf(other));
      }
      if (against > EvidenceOf(PoseOf(views))) {
        LeaveOut(views, OutlierReason::kContradicted);
        changed = true;
      }
    }
    return changed;
  }

  void Report() {
    for (const ViewId view : views_) {
      result_.cam_from_world[view] = rotations_.at(view);
    }
    const BridgeReport report = ExamineBridges(graph_, rejected_);
    for (const auto& [views, contradictions] : report.bridges) {
      result_.unchecked.push_back(views);
      if (contradictions.empty() || settled_.count(views) > 0) continue;
      result_.contested.push_back(
          {views, contradictions, ViewsBeyond(graph_, views)});
    }
    for (const auto& entry : outliers_) {
      result_.outliers.push_back(entry.second);
    }
  }

  const Scene& scene_;
  const RotationAveragingOptions& options_;
  const RunContext& context_;
  const ErrorLimits limits_;

  std::set<ViewPair> kept_;
  std::map<ViewPair, OutlierEdge> outliers_;
  std::set<ViewPair> settled_;  // in a loop of `result_`
  std::set<ViewPair> trusted_;  // of these, those that share its closing error
  double sigma_ = 0;  // of the first average: it must not erode what is right

  // Of the last average: the component, and the relative poses in it.
  std::vector<ViewId> views_;
  ViewGraph graph_;  // of those that are kept
  std::vector<ViewPair> rejected_;
  std::map<ViewId, Mat3> rotations_;
  SceneRotations result_;
};

}  // namespace

double RotationStddev(const RelativePose& pose) {
  if (!pose.covariance) return kDefaultRotationRad;
  const double variance = pose.covariance->topLeftCorner<3, 3>().trace() / 3;
  return std::sqrt(std::max(variance, 0.0) +
                   kPoseErrorFloorRad * kPoseErrorFloorRad);
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
    case OutlierReason::kMatches:
      return "matches";
    case OutlierReason::kOutweighed:
      return "outweighed";
    case OutlierReason::kLookAlike:
      return "look_alike";
  }
  return "";
}

bool OutlierEdge::IsFalse() const {
  switch (reason) {
    case OutlierReason::kRotation:
      return error_deg > kLittleDeg;
    case OutlierReason::kDirection:
      return error_deg > kLittleOfDirectionsDeg;
    case OutlierReason::kContradicted:
    case OutlierReason::kOpenLoop:
    case OutlierReason::kOutweighed:
    case OutlierReason::kLookAlike:
      return true;
    case OutlierReason::kMatches:
      break;
  }
  return false;
}

std::vector<ViewId> LoopClosing::DoubtfulViews() const {
  std::set<ViewId> views;
  if (left_out) {
    for (const ViewPair& edge : edges) views.insert({edge.first, edge.second});
  }
  return {views.begin(), views.end()};
}

std::vector<ViewPair> PairsOf(const std::vector<OutlierEdge>& outliers) {
  std::vector<ViewPair> pairs;
  pairs.reserve(outliers.size());
  for (const OutlierEdge& outlier : outliers) pairs.push_back(outlier.views);
  return pairs;
}

Result<SceneRotations> AverageSceneRotations(
    const Scene& scene, const RotationAveragingOptions& options,
    double outlier_reach, double least_false_rad, const RunContext& context,
    ThirdViewVerdicts third_views) {
  if (scene.relative_poses.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     "the scene has no relative pose to build on");
  }
  return SceneRotationSolver(scene, options, {outlier_reach, least_false_rad},
                             context, std::move(third_views))
      .Solve();
}

void AddMatchVerdicts(MatchVerdicts verdicts, SceneRotations* rotations) {
  std::set<ViewPair> known;
  for (const OutlierEdge& edge : rotations->outliers) known.insert(edge.views);
  for (const ViewPair& views : verdicts.refuted) {
    if (known.count(views) > 0) continue;
    rotations->outliers.push_back({views, OutlierReason::kMatches, 0});
  }
  std::sort(rotations->outliers.begin(), rotations->outliers.end(),
            [](const OutlierEdge& a, const OutlierEdge& b) {
              return a.views < b.views;
            });
  rotations->matches = std::move(verdicts);
}

}  // namespace lowlap
