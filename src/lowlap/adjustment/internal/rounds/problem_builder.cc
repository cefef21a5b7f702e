#include "lowlap/adjustment/internal/rounds/problem_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/adjustment/internal/costs/intrinsic_freedom.h"
#include "lowlap/adjustment/internal/costs/plane_costs.h"
#include "lowlap/adjustment/internal/costs/point_reprojection_cost.h"
#include "lowlap/adjustment/internal/costs/subspace_manifold.h"
#include "lowlap/adjustment/internal/rounds/pairs.h"

namespace lowlap {
namespace {

constexpr int kPoseSize = 4 + 3;
constexpr int kPointSize = 3;
constexpr int kLineSize = 6;
constexpr int kPlaneSize = 4;
constexpr int kDirectionSize = 3;

// Ceres counts the owners of what it owns in a tree, for every residual.
ceres::Problem::Options OwnNothing() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

}  // namespace

ProblemBuilder::ProblemBuilder(const AdjustmentOptions& options,
                               const SolveRequest& request,
                               const ProblemSelection& selection,
                               const std::vector<Component>& components,
                               CameraSet* cameras, StructureState* state)
    : options_(options),
      request_(request),
      selection_(selection),
      components_(components),
      cameras_(cameras),
      state_(state),
      problem_(OwnNothing()) {
  CopyIntoBlocks();
  AddPoints();
  AddLines();
  AddPairs();
  AddPlanes();
  AddPriors();
  AddDirections();
  AddPrincipalPoints();
  SetManifolds();
  SplitBlocks();
}

double* ProblemBuilder::RotationBlock(std::size_t pose) {
  return blocks_.data() + kPoseSize * pose;
}

double* ProblemBuilder::CenterBlock(std::size_t pose) {
  return RotationBlock(pose) + 4;
}

double* ProblemBuilder::IntrinsicBlock(std::size_t intrinsic) {
  return RotationBlock(cameras_->poses.size()) +
         kMaxIntrinsicParameters * intrinsic;
}

double* ProblemBuilder::LineBlock(std::size_t line) {
  return IntrinsicBlock(cameras_->intrinsics.size()) + kLineSize * line;
}

double* ProblemBuilder::PointBlock(std::size_t point) {
  return LineBlock(state_->lines.size()) + kPointSize * point;
}

double* ProblemBuilder::PlaneBlock(std::size_t plane) {
  return PointBlock(state_->points.size()) + kPlaneSize * plane;
}

double* ProblemBuilder::DirectionBlock(std::size_t direction) {
  return PlaneBlock(state_->planes.size()) + kDirectionSize * direction;
}

bool ProblemBuilder::AllFinite() const {
  return std::all_of(blocks_.begin(), blocks_.end(),
                     [](double value) { return std::isfinite(value); });
}

void ProblemBuilder::CopyIntoBlocks() {
  blocks_.assign(kPoseSize * cameras_->poses.size() +
                     kMaxIntrinsicParameters * cameras_->intrinsics.size() +
                     kLineSize * state_->lines.size() +
                     kPointSize * state_->points.size() +
                     kPlaneSize * state_->planes.size() +
                     kDirectionSize * state_->directions.size(),
                 0);
  for (std::size_t n = 0; n < cameras_->poses.size(); ++n) {
    const PoseState& pose = cameras_->poses[n];
    Eigen::Map<Vec4>(RotationBlock(n)) = pose.cam_from_world.coeffs();
    Eigen::Map<Vec3>(CenterBlock(n)) = pose.center;
  }
  for (std::size_t n = 0; n < cameras_->intrinsics.size(); ++n) {
    IntrinsicState& intrinsic = cameras_->intrinsics[n];
    intrinsic.ParametersFromValue();
    std::copy(intrinsic.parameters.begin(), intrinsic.parameters.end(),
              IntrinsicBlock(n));
  }
  for (const int n : selection_.lines) {
    Eigen::Map<LineParameters>(LineBlock(n)) << state_->lines[n].point,
        state_->lines[n].direction;
  }
  for (const int n : selection_.points) {
    Eigen::Map<Vec3>(PointBlock(n)) = state_->points[n].position;
  }
  for (const int n : selection_.planes) {
    Eigen::Map<Vec4>(PlaneBlock(n)) << state_->planes[n].normal,
        state_->planes[n].offset;
  }
  for (std::size_t n = 0; n < state_->directions.size(); ++n) {
    Eigen::Map<Vec3>(DirectionBlock(n)) = state_->directions[n].direction;
  }
}

bool ProblemBuilder::IsRefined(std::size_t intrinsic) const {
  return RefinementOf(options_, cameras_->intrinsics[intrinsic]).Any();
}

ceres::LossFunction* ProblemBuilder::MakeLoss(const NoiseScale& noise,
                                              double weight) {
  losses_.push_back(std::make_unique<ceres::ScaledLoss>(
      new ceres::CauchyLoss(noise.threshold_px),
      weight / (noise.stddev_px * noise.stddev_px), ceres::TAKE_OWNERSHIP));
  return losses_.back().get();
}

void ProblemBuilder::AddResiduals(std::unique_ptr<ceres::CostFunction> cost,
                                  ceres::LossFunction* loss,
                                  std::initializer_list<double*> blocks) {
  problem_.AddResidualBlock(cost.get(), loss, blocks.begin(),
                            static_cast<int>(blocks.size()));
  costs_.push_back(std::move(cost));
}

void ProblemBuilder::AddObservation(std::unique_ptr<ceres::CostFunction> cost,
                                    ceres::LossFunction* loss,
                                    const CameraView& view, double* landmark) {
  double* const rotation = RotationBlock(view.pose);
  double* const center = CenterBlock(view.pose);
  if (IsRefined(view.intrinsic)) {
    AddResiduals(std::move(cost), loss,
                 {rotation, center, landmark, IntrinsicBlock(view.intrinsic)});
  } else {
    AddResiduals(std::move(cost), loss, {rotation, center, landmark});
  }
}

void ProblemBuilder::AddPoints() {
  ceres::LossFunction* loss = MakeLoss(request_.noise.points, 1);
  for (const int n : selection_.points) {
    for (const PointCandidate& candidate : state_->points[n].candidates) {
      if (!candidate.used) continue;
      const CameraView& view = cameras_->views[candidate.view];
      AddObservation(
          std::make_unique<PointReprojectionCost>(
              &cameras_->intrinsics[view.intrinsic], IsRefined(view.intrinsic),
              candidate.pixel_px, candidate.whitening),
          loss, view, PointBlock(n));
    }
  }
}

// The length of both distances of a segment is held against a threshold of
// their root mean square: the loss of lines bends earlier than that of points.
void ProblemBuilder::AddLines() {
  ceres::LossFunction* loss = MakeLoss(request_.noise.lines, 1);
  for (const int n : selection_.lines) {
    for (const LineCandidate& candidate : state_->lines[n].candidates) {
      if (!candidate.used) continue;
      const CameraView& view = cameras_->views[candidate.view];
      AddObservation(
          std::make_unique<LineReprojectionCost>(
              candidate.rays, candidate.weight,
              cameras_->intrinsics[view.intrinsic], IsRefined(view.intrinsic)),
          loss, view, LineBlock(n));
    }
  }
}

void ProblemBuilder::AddPairs() {
  // A false pair may all but meet by chance, and no threshold tells: the loss
  // bends at one noise level already. (Measured: with a third of the pairs
  // false, scenes that do not need them are then not harmed.)
  NoiseScale noise = request_.noise.coplanar;
  noise.threshold_px = noise.stddev_px;
  for (const int n : selection_.pairs) {
    const PairState& pair = state_->pairs[n];
    const std::vector<PairTerm> terms =
        PairTerms(*state_, pair, options_.coplanar_residual);
    if (terms.empty()) continue;
    // A pair counts as one measurement however many views see it, and a line's
    // pairs together as about two.
    const double degree = 0.5 * (selection_.pair_degree[pair.first] +
                                 selection_.pair_degree[pair.second]);
    ceres::LossFunction* loss =
        MakeLoss(noise, 1 / (degree * static_cast<double>(terms.size())));
    for (const PairTerm& term : terms) {
      AddResiduals(MakePairCost(*cameras_, term, options_.coplanar_residual),
                   loss,
                   {CenterBlock(cameras_->views[term.view].pose),
                    LineBlock(term.on), LineBlock(term.to)});
    }
  }
}

void ProblemBuilder::AddPrincipalPoints() {
  for (std::size_t n = 0; n < cameras_->intrinsics.size(); ++n) {
    const IntrinsicState& intrinsic = cameras_->intrinsics[n];
    double* parameters = IntrinsicBlock(n);
    const double stddev_px = PrincipalPointStddevPx(options_, intrinsic);
    if (stddev_px > 0 && problem_.HasParameterBlock(parameters)) {
      AddResiduals(std::make_unique<PrincipalPointCost>(intrinsic, stddev_px),
                   nullptr, {parameters});
    }
  }
}

void ProblemBuilder::SetManifolds() {
  for (const int n : selection_.lines) {
    problem_.SetManifold(LineBlock(n), &line_manifold_);
  }
  for (const int n : selection_.planes) {
    if (problem_.HasParameterBlock(PlaneBlock(n))) {
      problem_.SetManifold(PlaneBlock(n), &plane_manifold_);
    }
  }
  for (std::size_t n = 0; n < state_->directions.size(); ++n) {
    if (problem_.HasParameterBlock(DirectionBlock(n))) {
      problem_.SetManifold(DirectionBlock(n), &sphere_manifold_);
    }
  }
  for (const Component& component : components_) {
    for (const int n : component.poses) {
      double* rotation = RotationBlock(n);
      if (request_.fixed_rotations || n == component.reference) {
        problem_.SetParameterBlockConstant(rotation);
      } else {
        problem_.SetManifold(rotation, &rotation_manifold_);
      }
    }
    problem_.SetParameterBlockConstant(CenterBlock(component.reference));
    // The reference is the origin of the frame: a sphere about it keeps the
    // length of the baseline.
    if (component.partner >= 0) {
      problem_.SetManifold(CenterBlock(component.partner), &sphere_manifold_);
    }
  }
  for (std::size_t index = 0; index < cameras_->intrinsics.size(); ++index) {
    const IntrinsicState& intrinsic = cameras_->intrinsics[index];
    double* parameters = IntrinsicBlock(index);
    if (!problem_.HasParameterBlock(parameters)) continue;
    const Eigen::MatrixXd basis =
        FreeDirections(RefinementOf(options_, intrinsic), intrinsic);
    if (basis.cols() == 0) {
      problem_.SetParameterBlockConstant(parameters);
    } else {
      intrinsic_manifolds_.push_back(std::make_unique<SubspaceManifold>(basis));
      problem_.SetManifold(parameters, intrinsic_manifolds_.back().get());
    }
  }
}

void ProblemBuilder::SplitBlocks() {
  const auto keep = [&](double* block) {
    if (problem_.HasParameterBlock(block) &&
        !problem_.IsParameterBlockConstant(block)) {
      kept_.push_back(block);
    }
  };
  for (std::size_t n = 0; n < cameras_->poses.size(); ++n) {
    keep(RotationBlock(n));
    keep(CenterBlock(n));
  }
  for (std::size_t n = 0; n < cameras_->intrinsics.size(); ++n) {
    keep(IntrinsicBlock(n));
  }
  for (const int n : selection_.planes) keep(PlaneBlock(n));
  for (std::size_t n = 0; n < state_->directions.size(); ++n) {
    keep(DirectionBlock(n));
  }
  // Two lines of a pair share residuals: only one of them may be eliminated.
  // More can be where those with few pairs come first.
  std::vector<std::vector<int>> partners(state_->lines.size());
  for (const int n : selection_.pairs) {
    const PairState& pair = state_->pairs[n];
    partners[pair.first].push_back(pair.second);
    partners[pair.second].push_back(pair.first);
  }
  std::vector<int> by_degree = selection_.lines;
  std::stable_sort(by_degree.begin(), by_degree.end(), [&](int a, int b) {
    return partners[a].size() < partners[b].size();
  });
  std::vector<char> is_eliminated(state_->lines.size(), 0);
  for (const int n : by_degree) {
    is_eliminated[n] =
        std::none_of(partners[n].begin(), partners[n].end(),
                     [&](int partner) { return is_eliminated[partner]; });
  }
  for (const int n : selection_.lines) {
    if (is_eliminated[n]) {
      eliminated_.push_back(LineBlock(n));
      eliminated_lines_.push_back(n);
    } else {
      keep(LineBlock(n));
    }
  }
  for (const int n : selection_.points) eliminated_.push_back(PointBlock(n));
}

void ProblemBuilder::TakeResults() {
  for (std::size_t n = 0; n < cameras_->poses.size(); ++n) {
    PoseState& pose = cameras_->poses[n];
    pose.cam_from_world.coeffs() = Eigen::Map<Vec4>(RotationBlock(n));
    pose.center = Eigen::Map<Vec3>(CenterBlock(n));
  }
  for (std::size_t n = 0; n < cameras_->intrinsics.size(); ++n) {
    if (!IsRefined(n)) continue;
    IntrinsicState& intrinsic = cameras_->intrinsics[n];
    std::copy_n(IntrinsicBlock(n), kMaxIntrinsicParameters,
                intrinsic.parameters.begin());
    intrinsic.ValueFromParameters();
  }
  for (const int n : selection_.lines) {
    state_->lines[n].point = Eigen::Map<Vec3>(LineBlock(n));
    state_->lines[n].direction =
        Eigen::Map<Vec3>(LineBlock(n) + 3).normalized();
  }
  for (const int n : selection_.points) {
    state_->points[n].position = Eigen::Map<Vec3>(PointBlock(n));
  }
  for (const int n : selection_.planes) {
    PlaneState& plane = state_->planes[n];
    plane.normal = Eigen::Map<Vec3>(PlaneBlock(n)).normalized();
    plane.offset = PlaneBlock(n)[3];
  }
  for (std::size_t n = 0; n < state_->directions.size(); ++n) {
    state_->directions[n].direction =
        Eigen::Map<Vec3>(DirectionBlock(n)).normalized();
  }
}

}  // namespace lowlap
