#include "lowlap/adjustment/internal/uncertainty/center_covariances.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "lowlap/adjustment/internal/rounds/linearised_problem.h"
#include "lowlap/adjustment/internal/rounds/problem_builder.h"
#include "lowlap/adjustment/internal/rounds/quiet_logging.h"
#include "lowlap/adjustment/internal/uncertainty/gradient_scatter.h"
#include "lowlap/adjustment/internal/uncertainty/joint_covariance.h"

namespace lowlap {
namespace {

using Factor = Eigen::SimplicialLDLT<SparseMat>;
using Places = std::vector<Eigen::Index>;  // in the component

// So that there is an inverse where nothing determines a camera.
SparseMat Damped(const LinearisedProblem& linearised) {
  constexpr double kDamping = 1e-12;
  SparseMat damping(linearised.kept_size, linearised.kept_size);
  damping.setIdentity();
  damping.diagonal() = kDamping * linearised.kept_diagonal;
  return linearised.schur_complement + damping;
}

// From the tangent space of the block to its three numbers.
Eigen::MatrixXd TangentToAmbient(const ceres::Problem& problem,
                                 const double* block) {
  const ceres::Manifold* manifold = problem.GetManifold(block);
  if (manifold == nullptr) return Mat3::Identity();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      jacobian(3, manifold->TangentSize());
  manifold->PlusJacobian(block, jacobian.data());
  return jacobian;
}

// The nearest symmetric matrix without a negative eigenvalue.
Mat3 Positive(const Mat3& matrix) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(matrix + matrix.transpose());
  const Mat3 half =
      eigen.eigenvectors() *
      (0.5 * eigen.eigenvalues()).cwiseMax(0).cwiseSqrt().asDiagonal();
  return half * half.transpose();
}

// Three rows for each pose of the component.
SparseMat CentersFromKept(const Component& component,
                          const LinearisedProblem& linearised,
                          ProblemBuilder* builder) {
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0;
  for (const int pose : component.poses) {
    const double* center = builder->CenterBlock(pose);
    const int column = linearised.KeptColumn(center);
    if (column >= 0) {
      const Eigen::MatrixXd ambient =
          TangentToAmbient(builder->problem(), center);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < ambient.cols(); ++j) {
          entries.emplace_back(row + i, column + j, ambient(i, j));
        }
      }
    }
    row += 3;
  }
  SparseMat result(row, linearised.kept_size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// Rounding may leave nothing of what is not determined.
double Root(double variance) {
  return variance >= 0 ? std::sqrt(variance) : HUGE_VAL;
}

// Of the difference of two centres.
Mat3 CovarianceOfStep(const BlockMap& blocks, Eigen::Index from,
                      Eigen::Index to) {
  const Mat3& cross = blocks.at(std::minmax(from, to));
  return blocks.at({from, from}) + blocks.at({to, to}) - cross -
         cross.transpose();
}

// Of log(|c3 - c2| / |c2 - c1|).
double LogRatioStddev(const BlockMap& blocks, const std::vector<Vec3>& centers,
                      const Places& places) {
  const Vec3 before = centers[places[1]] - centers[places[0]];
  const Vec3 after = centers[places[2]] - centers[places[1]];
  const Vec3 by_first = before / before.squaredNorm();
  const Vec3 by_last = after / after.squaredNorm();
  const std::array<Vec3, 3> gradient = {by_first, -by_first - by_last, by_last};
  double variance = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Mat3& block = blocks.at(std::minmax(places[i], places[j]));
      variance += places[i] <= places[j] ? gradient[i].dot(block * gradient[j])
                                         : gradient[j].dot(block * gradient[i]);
    }
  }
  return Root(variance);
}

double DirectionStddev(const BlockMap& blocks, const std::vector<Vec3>& centers,
                       const Places& places) {
  const Vec3 step = centers[places[1]] - centers[places[0]];
  const Vec3 direction = step.normalized();
  const Mat3 across = Mat3::Identity() - direction * direction.transpose();
  const Mat3 covariance =
      across * CovarianceOfStep(blocks, places[0], places[1]) * across;
  const double variance =
      Eigen::SelfAdjointEigenSolver<Mat3>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .maxCoeff();
  return Root(variance) / step.norm();
}

// What a component adds. `reference` is its reference pose in the world.
class ComponentUncertainty {
 public:
  ComponentUncertainty(const Component& component, const CameraSet& cameras,
                       const PoseState& reference,
                       const std::vector<ViewTriplet>& triplets,
                       const std::vector<ViewPair>& pairs)
      : cameras_(cameras),
        world_from_frame_(
            component.Unit() *
            reference.cam_from_world.toRotationMatrix().transpose()) {
    for (const int pose : component.poses) {
      const PoseState& state = cameras.poses[pose];
      place_[state.id] = static_cast<Eigen::Index>(centers_.size());
      centers_.push_back(state.center);
    }
    for (const ViewTriplet& views : triplets) {
      Ask(views, {views.first, views.middle, views.last}, &triplets_);
    }
    for (const ViewPair& views : pairs) {
      Ask(views, {views.first, views.second}, &pairs_);
    }
  }

  // Where it is larger than what the result holds.
  void AddTo(CenterUncertainty* result, const JointCovariance& joint) const {
    const BlockMap blocks = joint.Blocks(asked_);
    const std::vector<Mat3> free =
        CovariancesWithoutGauge(joint, blocks, centers_);
    for (const auto& [id, at] : place_) {
      const Mat3 covariance = world_from_frame_ *
                              free[static_cast<std::size_t>(at)] *
                              world_from_frame_.transpose();
      if (!covariance.allFinite()) continue;
      Mat3& stated =
          result->covariances.try_emplace(id, Mat3::Zero()).first->second;
      if (covariance.trace() > stated.trace()) stated = Positive(covariance);
    }
    for (const auto& [views, places] : triplets_) {
      double& stddev = result->log_ratio_stddevs[views];
      stddev = std::max(stddev, LogRatioStddev(blocks, centers_, places));
    }
    for (const auto& [views, places] : pairs_) {
      double& stddev = result->direction_stddevs_rad[views];
      stddev = std::max(stddev, DirectionStddev(blocks, centers_, places));
    }
  }

 private:
  // Unless some of the views are elsewhere, or have poses in common.
  template <class Views>
  void Ask(const Views& views, const std::vector<ViewId>& ids,
           std::map<Views, Places>* asked) {
    Places places;
    for (const ViewId id : ids) {
      const int view = cameras_.Find(id);
      if (view < 0) return;
      const auto place = place_.find(cameras_.PoseOf(view).id);
      if (place == place_.end()) return;
      places.push_back(place->second);
    }
    if (std::set<Eigen::Index>(places.begin(), places.end()).size() <
        places.size()) {
      return;
    }
    for (const Eigen::Index a : places) {
      for (const Eigen::Index b : places) asked_.insert(std::minmax(a, b));
    }
    asked->emplace(views, std::move(places));
  }

  const CameraSet& cameras_;
  const Mat3 world_from_frame_;
  std::map<PoseId, Eigen::Index> place_;
  std::vector<Vec3> centers_;
  std::map<ViewTriplet, Places> triplets_;
  std::map<ViewPair, Places> pairs_;
  std::set<PlacePair> asked_;
};

}  // namespace

CenterUncertainty EstimateCenterUncertainty(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const std::vector<ViewTriplet>& triplets,
    const std::vector<ViewPair>& pairs, CameraSet cameras,
    StructureState state) {
  CenterUncertainty result;
  state.priors.clear();
  state.ratio_priors.clear();
  const ProblemSelection selection = SelectForSolve(cameras, state, options);
  if (selection.IsEmpty()) return result;
  const std::vector<Component> components =
      FindComponents(cameras, state, selection);
  const std::vector<PoseState> references =
      EnterComponentFrames(components, &cameras, &state);
  const QuietLogging quiet;
  SolveRequest request;
  request.noise = noise;
  ProblemBuilder builder(options, request, selection, components, &cameras,
                         &state);
  const LinearisedProblem linearised(&builder);
  if (linearised.kept_size == 0) return result;
  const Factor factor(Damped(linearised));
  if (factor.info() != Eigen::Success) return result;
  const SparseMat scatter =
      ScatterOfGradients(linearised, builder, selection, cameras, state);
  for (std::size_t n = 0; n < components.size(); ++n) {
    if (components[n].poses.size() < 3) continue;
    const SparseMat centers =
        CentersFromKept(components[n], linearised, &builder);
    const ComponentUncertainty uncertainty(components[n], cameras,
                                           references[n], triplets, pairs);
    uncertainty.AddTo(&result, JointCovariance(centers, factor, nullptr));
    uncertainty.AddTo(&result, JointCovariance(centers, factor, &scatter));
  }
  return result;
}

}  // namespace lowlap
