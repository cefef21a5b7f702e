#include "lowlap/merge/internal/trusted_pieces.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/merge/internal/agreement.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

double OwnDeviation(double of_residuals, std::vector<double> stated) {
  const double measured = Median(std::move(stated));
  return std::sqrt(
      std::max(0.0, of_residuals * of_residuals - measured * measured));
}

TrustedPiece MakeTrusted(const Scene& measured, const ModelCheck& check,
                         const RigidPiece& piece) {
  const std::set<ViewPair> inside(piece.pairs.begin(), piece.pairs.end());
  std::vector<double> rotations, directions, rotation_stddevs,
      direction_stddevs;
  for (const PairAgreement& pair : check.pairs) {
    if (inside.count(pair.views) == 0) continue;
    const RelativePose motion =
        WithHypothesis(measured.relative_poses.at(pair.views), pair.hypothesis);
    rotations.push_back(pair.rotation_error_rad);
    rotation_stddevs.push_back(RotationStddev(motion));
    directions.push_back(pair.direction_error_rad);
    direction_stddevs.push_back(DirectionStddev(motion));
  }
  TrustedPiece trusted;
  trusted.piece = piece;
  trusted.rotation_stddev_rad =
      OwnDeviation(Median(std::move(rotations)) / kMedianOfNorm<3>,
                   std::move(rotation_stddevs));
  trusted.direction_stddev_rad =
      OwnDeviation(Median(std::move(directions)) / kMedianOfNorm<2>,
                   std::move(direction_stddevs));
  return trusted;
}

// What a model says of a relative pose, with the matches that were measured.
RelativePose OfModel(RelativePose measured, const PartialModel& model,
                     const TrustedPiece& trusted) {
  const Pose& first = model.poses.at(measured.views.first);
  const Pose& second = model.poses.at(measured.views.second);
  measured.alternatives.clear();
  measured.rotation = second.rotation * first.rotation.transpose();
  measured.direction =
      (second.rotation * (first.center - second.center)).normalized();
  Eigen::Matrix<double, 5, 1> deviations;
  deviations << Vec3::Constant(trusted.rotation_stddev_rad),
      Vec2::Constant(trusted.direction_stddev_rad);
  const Eigen::Matrix<double, 5, 5> covariance =
      deviations.cwiseAbs2().asDiagonal();
  measured.covariance = covariance;
  return measured;
}

// The ratio of two baselines of a piece. Of the measured one, if it agrees, the
// coplanar lines stay.
ScaleRatio RatioOfModel(const ViewTriplet& views, const PartialModel& model,
                        const TrustedPiece& trusted, double log10_nfa,
                        const ScaleRatio* measured) {
  ScaleRatio ratio;
  ratio.views = views;
  ratio.verdict = RatioVerdict::kMeaningful;
  ratio.log_ratio = LogRatioOf(model.poses, views);
  // Centres that err across a baseline err as much along it.
  ratio.log_ratio_stddev =
      std::sqrt(2.0) *
      std::hypot(trusted.direction_stddev_rad, kPoseErrorFloorRad);
  ratio.log10_nfa = log10_nfa;
  KindSupport support;
  support.kind = "model";
  support.candidates = support.inliers =
      static_cast<int>(trusted.piece.pairs.size());
  support.log10_nfa = log10_nfa;
  support.information_share = 1;
  ratio.kinds = {support};
  if (measured != nullptr) ratio.coplanar_inliers = measured->coplanar_inliers;
  return ratio;
}

std::map<ViewTriplet, const ScaleRatio*> AgreeingRatios(
    const ModelCheck& check) {
  std::map<ViewTriplet, const ScaleRatio*> agreeing;
  for (const RatioAgreement& ratio : check.ratios) {
    if (ratio.Agrees()) agreeing[ratio.views] = nullptr;
  }
  for (const ScaleRatio& ratio : check.measured_ratios) {
    const auto found = agreeing.find(ratio.views);
    if (found != agreeing.end()) found->second = &ratio;
  }
  return agreeing;
}

}  // namespace

std::vector<TrustedPiece> TrustedPieces(const Scene& measured,
                                        const std::vector<ModelCheck>& checks) {
  std::vector<TrustedPiece> pieces;
  for (std::size_t m = 0; m < checks.size(); ++m) {
    for (const RigidPiece& piece : checks[m].pieces) {
      pieces.push_back(MakeTrusted(measured, checks[m], piece));
      pieces.back().model = m;
    }
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const TrustedPiece& a, const TrustedPiece& b) {
                     return a.piece.views.size() > b.piece.views.size();
                   });
  return pieces;
}

void TrustPieces(const std::vector<PartialModel>& models,
                 const std::vector<ModelCheck>& checks,
                 const std::vector<TrustedPiece>& pieces, Scene* scene) {
  std::map<ViewPair, double> evidence;
  for (const auto& [views, pose] : scene->relative_poses) {
    evidence[views] = pose.log10_nfa;
  }
  std::vector<std::map<ViewTriplet, const ScaleRatio*>> agreeing_of_models;
  agreeing_of_models.reserve(checks.size());
  for (const ModelCheck& check : checks) {
    agreeing_of_models.push_back(AgreeingRatios(check));
  }
  std::set<ViewPair> replaced;
  std::map<ViewTriplet, ScaleRatio> ratios;
  for (const TrustedPiece& trusted : pieces) {
    const PartialModel& model = models[trusted.model];
    const auto& agreeing = agreeing_of_models[trusted.model];
    for (const ViewPair& views : trusted.piece.pairs) {
      RelativePose& pose = scene->relative_poses.at(views);
      if (replaced.insert(views).second) {
        pose = OfModel(std::move(pose), model, trusted);
      }
    }
    for (const ViewTriplet& views :
         FindTriplets(ViewGraph(trusted.piece.pairs))) {
      const double weaker =
          std::max(evidence.at(OrderedPair(views.first, views.middle)),
                   evidence.at(OrderedPair(views.middle, views.last)));
      const auto measured = agreeing.find(views);
      ratios.emplace(
          views, RatioOfModel(
                     views, model, trusted, weaker,
                     measured == agreeing.end() ? nullptr : measured->second));
    }
  }
  scene->scale_ratios.clear();
  for (auto& entry : ratios) {
    scene->scale_ratios.push_back(std::move(entry.second));
  }
}

}  // namespace lowlap
