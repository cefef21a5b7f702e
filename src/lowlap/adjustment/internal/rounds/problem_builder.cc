#include "lowlap/adjustment/internal/rounds/problem_builder.h"

#include <ceres/line_manifold.h>
#include <ceres/manifold.h>
#include <ceres/sphere_manifold.h>

#include <algorithm>
#include <cmath>

#include "lowlap/adjustment/internal/costs/coplanar_costs.h"
#include "lowlap/adjustment/internal/costs/intrinsic_freedom.h"
#include "lowlap/adjustment/internal/costs/point_reprojection_cost.h"
#include "lowlap/adjustment/internal/costs/subspace_manifold.h"
#include "lowlap/adjustment/internal/rounds/pair_terms.h"

namespace lowlap {
namespace {

constexpr int kPoseSize = 4 + 3;
constexpr int kPointSize = 3;
constexpr int kLineSize = 6;

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
      state_(state) {
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_ = std::make_unique<ceres::Problem>(problem_options);
  CopyIntoBlocks();
  AddPoints();
  AddLines();
  AddPairs();
  AddRelativePoses();
  AddPrincipalPoints();
  SetManifolds();
}

double* ProblemBuilder::RotationBlock(int pose) {
  return blocks_.data() + kPoseSize * pose;
}

double* ProblemBuilder::CenterBlock(int pose) {
  return RotationBlock(pose) + 4;
}

double* ProblemBuilder::IntrinsicBlock(int intrinsic) {
  return RotationBlock(static_cast<int>(cameras_->poses.size())) +
         kMaxIntrinsicParameters * intrinsic;
}

double* ProblemBuilder::LineBlock(int line) {
  return IntrinsicBlock(static_cast<int>(cameras_->intrinsics.size())) +
         kLineSize * line;
}

double* ProblemBuilder::PointBlock(int point) {
  return LineBlock(static_cast<int>(state_->lines.size())) + kPointSize * point;
}

void ProblemBuilder::CopyIntoBlocks() {
  blocks_.assign(kPoseSize * cameras_->poses.size() +
                     kMaxIntrinsicParameters * cameras_->intrinsics.size() +
                     kLineSize * state_->lines.size() +
                     kPointSize * state_->points.size(),
                 0);
  for (std::size_t n = 0; n < cameras_->poses.size(); ++n) {
    const PoseState& pose = cameras_->poses[n];
    const int index = static_cast<int>(n);
    Eigen::Map<Vec4>(RotationBlock(index)) = pose.cam_from_world.coeffs();
    Eigen::Map<Vec3>(CenterBlock(index)) = pose.center;
  }
  for (std::size_t n = 0; n < cameras_->intrinsics.size(); ++n) {
    IntrinsicState& intrinsic = cameras_->intrinsics[n];
    intrinsic.ParametersFromValue();
    std::copy(intrinsic.parameters.begin(), intrinsic.parameters.end(),
              IntrinsicBlock(static_cast<int>(n)));
  }
  for (const int n : selection_.lines) {
    Eigen::Map<LineParameters>(LineBlock(n)) << state_->lines[n].point,
        state_->lines[n].direction;
  }
  for (const int n : selection_.points) {
    Eigen::Map<Vec3>(PointBlock(n)) = state_->points[n].position;
  }
}

bool ProblemBuilder::IsRefined(int intrinsic) const {
  return RefinementOf(options_, cameras_->intrinsics[intrinsic]).Any();
}

ceres::LossFunction* ProblemBuilder::MakeLoss(const NoiseScale& noise,
                                              double weight) {
  losses_.push_back(std::make_unique<ceres::ScaledLoss>(
      new ceres::CauchyLoss(noise.threshold_px),
      weight / (noise.stddev_px * noise.stddev_px), ceres::TAKE_OWNERSHIP));
  return losses_.back().get();
}

void ProblemBuilder::AddPoints() {
  ceres::LossFunction* loss = MakeLoss(request_.noise.points, 1);
  for (const int n : selection_.points) {
    for (const PointCandidate& candidate : state_->points[n].candidates) {
      if (!candidate.used) continue;
      const CameraView& view = cameras_->views[candidate.view];
      const IntrinsicState& intrinsic = cameras_->intrinsics[view.intrinsic];
      const bool refined = IsRefined(view.intrinsic);
      std::vector<double*> blocks = {RotationBlock(view.pose),
                                     CenterBlock(view.pose), PointBlock(n)};
      if (refined) blocks.push_back(IntrinsicBlock(view.intrinsic));
      problem_->AddResidualBlock(
          new PointReprojectionCost(&intrinsic, refined, candidate.pixel_px,
                                    candidate.whitening),
          loss, blocks);
    }
  }
}

void ProblemBuilder::AddLines() {
  ceres::LossFunction* loss = MakeLoss(request_.noise.lines, 1);
  for (const int n : selection_.lines) {
    for (const LineCandidate& candidate : state_->lines[n].candidates) {
      if (!candidate.used) continue;
      const CameraView& view = cameras_->views[candidate.view];
      const IntrinsicState& intrinsic = cameras_->intrinsics[view.intrinsic];
      const bool refined = IsRefined(view.intrinsic);
      std::vector<double*> blocks = {RotationBlock(view.pose),
                                     CenterBlock(view.pose), LineBlock(n)};
      if (refined) blocks.push_back(IntrinsicBlock(view.intrinsic));
      problem_->AddResidualBlock(
          new LineReprojectionCost(candidate.rays, candidate.weight, intrinsic,
                                   refined),
          loss, blocks);
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
      const double focal_px =
          cameras_->IntrinsicOf(term.view).value.MeanFocalPx();
      const std::vector<double*> blocks = {
          CenterBlock(cameras_->views[term.view].pose), LineBlock(term.on),
          LineBlock(term.to)};
      ceres::CostFunction* cost = nullptr;
      if (options_.coplanar_residual == AdjustedCoplanarResidual::kTransfer) {
        cost = new CoplanarTransferCost(focal_px);
      } else {
        cost = new CoplanarImageDistanceCost(focal_px);
      }
      problem_->AddResidualBlock(cost, loss, blocks);
    }
  }
}

void ProblemBuilder::AddPrincipalPoints() {
  for (std::size_t n = 0; n < cameras_->intrinsics.size(); ++n) {
    const IntrinsicState& intrinsic = cameras_->intrinsics[n];
    double* parameters = IntrinsicBlock(static_cast<int>(n));
    const double stddev_px = PrincipalPointStddevPx(options_, intrinsic);
    if (stddev_px > 0 && problem_->HasParameterBlock(parameters)) {
      problem_->AddResidualBlock(new PrincipalPointCost(intrinsic, stddev_px),
                                 nullptr, parameters);
    }
  }
}

void ProblemBuilder::AddRelativePoses() {
  // In standard deviations; a false relative pose loses its hold.
  constexpr double kLossScale = 3;
  losses_.push_back(std::make_unique<ceres::CauchyLoss>(kLossScale));
  ceres::LossFunction* loss = losses_.back().get();
  std::vector<int> component_of(cameras_->poses.size(), -1);
  for (std::size_t n = 0; n < components_.size(); ++n) {
    for (const int pose : components_[n].poses) {
      component_of[pose] = static_cast<int>(n);
    }
  }
  for (const RelativePosePrior& prior : state_->priors) {
    const int component = component_of[prior.first];
    if (component < 0 || component != component_of[prior.second]) continue;
    problem_->AddResidualBlock(
        new RelativePoseCost(prior.measured), loss, RotationBlock(prior.first),
        CenterBlock(prior.first), RotationBlock(prior.second),
        CenterBlock(prior.second));
  }
}

void ProblemBuilder::SetManifolds() {
  for (const int n : selection_.lines) {
    problem_->SetManifold(LineBlock(n), new ceres::LineManifold<3>());
  }
  for (const Component& component : components_) {
    for (const int n : component.poses) {
      double* rotation = RotationBlock(n);
      if (request_.fixed_rotations || n == component.reference) {
        problem_->SetParameterBlockConstant(rotation);
      } else {
        problem_->SetManifold(rotation, new ceres::EigenQuaternionManifold());
      }
    }
    problem_->SetParameterBlockConstant(CenterBlock(component.reference));
    // The reference is the origin of the frame: a sphere about it keeps the
    // length of the baseline.
    if (component.partner >= 0) {
      problem_->SetManifold(CenterBlock(component.partner),
                            new ceres::SphereManifold<3>());
    }
  }
  for (std::size_t index = 0; index < cameras_->intrinsics.size(); ++index) {
    const IntrinsicState& intrinsic = cameras_->intrinsics[index];
    double* parameters = IntrinsicBlock(static_cast<int>(index));
    if (!problem_->HasParameterBlock(parameters)) continue;
    const Eigen::MatrixXd basis =
        FreeDirections(RefinementOf(options_, intrinsic), intrinsic);
    if (basis.cols() == 0) {
      problem_->SetParameterBlockConstant(parameters);
    } else {
      problem_->SetManifold(parameters, new SubspaceManifold(basis));
    }
  }
}

std::shared_ptr<ceres::ParameterBlockOrdering> ProblemBuilder::Ordering() {
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::vector<double*> blocks;
  problem_->GetParameterBlocks(&blocks);
  for (double* block : blocks) ordering->AddElementToGroup(block, 1);
  for (const int n : selection_.points) {
    ordering->AddElementToGroup(PointBlock(n), 0);
  }
  // Two lines of a pair share residuals: only one of them may be eliminated.
  std::vector<std::vector<int>> partners(state_->lines.size());
  for (const int n : selection_.pairs) {
    const PairState& pair = state_->pairs[n];
    partners[pair.first].push_back(pair.second);
    partners[pair.second].push_back(pair.first);
  }
  std::vector<char> eliminated(state_->lines.size(), 0);
  for (const int n : selection_.lines) {
    bool independent = true;
    for (const int partner : partners[n]) {
      independent = independent && !eliminated[partner];
    }
    if (!independent) continue;
    eliminated[n] = 1;
    ordering->AddElementToGroup(LineBlock(n), 0);
  }
  return ordering;
}

int ProblemBuilder::ReducedSize() {
  const auto ordering = Ordering();
  int size = 0;
  std::vector<double*> blocks;
  problem_->GetParameterBlocks(&blocks);
  for (double* block : blocks) {
    if (ordering->GroupId(block) == 1 &&
        !problem_->IsParameterBlockConstant(block)) {
      size += problem_->ParameterBlockTangentSize(block);
    }
  }
  return size;
}

void ProblemBuilder::TakeResults() {
  for (std::size_t n = 0; n < cameras_->poses.size(); ++n) {
    PoseState& pose = cameras_->poses[n];
    const int index = static_cast<int>(n);
    pose.cam_from_world.coeffs() = Eigen::Map<Vec4>(RotationBlock(index));
    pose.center = Eigen::Map<Vec3>(CenterBlock(index));
  }
  for (std::size_t n = 0; n < cameras_->intrinsics.size(); ++n) {
    const int index = static_cast<int>(n);
    if (!IsRefined(index)) continue;
    IntrinsicState& intrinsic = cameras_->intrinsics[n];
    std::copy_n(IntrinsicBlock(index), kMaxIntrinsicParameters,
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
}

}  // namespace lowlap
