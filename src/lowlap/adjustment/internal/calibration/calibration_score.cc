#include "lowlap/adjustment/internal/calibration/calibration_score.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "lowlap/adjustment/internal/costs/intrinsic_freedom.h"
#include "lowlap/adjustment/internal/rounds/linearised_problem.h"
#include "lowlap/adjustment/internal/rounds/quiet_logging.h"

namespace lowlap {
namespace {

using MatX = Eigen::MatrixXd;
using VecX = Eigen::VectorXd;

constexpr std::size_t kMaxSeparate = 16;
constexpr IntrinsicRefinement kAllParts{true, true, true, true};

using Group = CalibrationScore::Group;
// In the order of the columns of FreeDirections.
constexpr IntrinsicPart kParts[] = {
    &IntrinsicRefinement::focal, &IntrinsicRefinement::aspect_ratio,
    &IntrinsicRefinement::principal_point, &IntrinsicRefinement::distortion};

int Size(IntrinsicPart part, const Intrinsic& intrinsic) {
  if (part == &IntrinsicRefinement::principal_point) return 2;
  if (part == &IntrinsicRefinement::distortion) {
    return static_cast<int>(intrinsic.distortion.size());
  }
  return 1;
}

// How far a part of the solver's parameters moves at a change of 1: focal
// lengths and aspect by the factor e, the principal point by the diagonal.
double Unit(IntrinsicPart part, const Intrinsic& intrinsic) {
  if (part == &IntrinsicRefinement::focal) {
    return std::hypot(intrinsic.fx_px, intrinsic.fy_px);
  }
  if (part == &IntrinsicRefinement::aspect_ratio) return intrinsic.fy_px;
  return part == &IntrinsicRefinement::principal_point
             ? intrinsic.ImageDiagonal()
             : 1;
}

double FarthestChange(IntrinsicPart part) {
  if (part == &IntrinsicRefinement::principal_point) return 0.25;
  if (part == &IntrinsicRefinement::distortion) return 1;
  return std::log(2.0);
}

std::vector<Group> MakeGroups(const AdjustmentOptions& options,
                              const CameraSet& cameras) {
  std::vector<Group> groups;
  const bool separate = cameras.intrinsics.size() <= kMaxSeparate;
  for (std::size_t n = 0; n < cameras.intrinsics.size(); ++n) {
    const IntrinsicState& intrinsic = cameras.intrinsics[n];
    if (intrinsic.value.model == CameraModel::kSpherical) continue;
    const IntrinsicRefinement refined = RefinementOf(options, intrinsic);
    if (separate || groups.empty()) groups.push_back({{}, refined});
    groups.back().intrinsics.push_back(static_cast<int>(n));
    for (const IntrinsicPart part : kParts) {
      groups.back().refined.*part |= refined.*part;
    }
  }
  return groups;
}

MatX Block(const MatX& matrix, const std::vector<int>& rows,
           const std::vector<int>& cols) {
  return matrix(rows, cols);
}

// a^T b. A function of its own, as every form of a product takes the compiler a
// second.
MatX TransposedProduct(const MatX& a, const MatX& b) {
  return a.transpose().lazyProduct(b);
}

// `held` says how the held parameters move the kept columns; the columns
// `free` move by themselves.
bool ComputeScore(const LinearisedProblem& linearised,
                  const std::vector<int>& free, const MatX& held,
                  CalibrationScore* score) {
  std::vector<int> place(static_cast<std::size_t>(linearised.kept_size), -1);
  for (std::size_t n = 0; n < free.size(); ++n) {
    place[free[n]] = static_cast<int>(n);
  }
  const auto free_count = static_cast<Eigen::Index>(free.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const int n : free) {
    for (SparseMat::InnerIterator it(linearised.schur_complement, n); it;
         ++it) {
      const int row = place[it.row()];
      if (row >= 0) entries.emplace_back(row, place[n], it.value());
    }
    // What nothing determines (the scale of a link of two views) has no
    // gradient either: it stays where it is.
    constexpr double kDamping = 1e-10;
    entries.emplace_back(place[n], place[n],
                         kDamping * linearised.kept_diagonal(n));
  }
  SparseMat free_part(free_count, free_count);
  free_part.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<SparseMat> factor(free_part);
  if (factor.info() != Eigen::Success) return false;
  const MatX kept_held = linearised.schur_complement * held;
  MatX cross(free_count, held.cols());
  for (const int n : free) cross.row(place[n]) = kept_held.row(n);
  const MatX solved = factor.solve(cross);
  score->prior_information = TransposedProduct(held, kept_held);
  score->information =
      score->prior_information - TransposedProduct(cross, solved);
  MatX efficient = held;
  for (const int n : free) efficient.row(n) -= solved.row(place[n]);
  const MatX shares = linearised.gradients * efficient;  // by landmark
  score->u = shares.colwise().sum().transpose();
  const double unknowns = static_cast<double>(free_count + held.cols());
  if (!(linearised.redundancy > unknowns)) return false;
  score->variance =
      TransposedProduct(shares, shares) *
      (linearised.redundancy / (linearised.redundancy - unknowns));
  return true;
}

}  // namespace

void ChangePart(IntrinsicPart part, const VecX& change, Intrinsic* intrinsic) {
  if (part == &IntrinsicRefinement::focal) {
    intrinsic->fx_px *= std::exp(change(0));
  }
  if (part == &IntrinsicRefinement::focal ||
      part == &IntrinsicRefinement::aspect_ratio) {
    intrinsic->fy_px *= std::exp(change(0));
  } else if (part == &IntrinsicRefinement::principal_point) {
    intrinsic->principal_point_px += intrinsic->ImageDiagonal() * change;
  } else {
    for (std::size_t n = 0; n < intrinsic->distortion.size(); ++n) {
      intrinsic->distortion[n] += change(static_cast<Eigen::Index>(n));
    }
  }
}

Intrinsic WithDistortion(Intrinsic intrinsic) {
  if (intrinsic.model == CameraModel::kPinhole) {
    intrinsic.model = CameraModel::kRadialK1;
    intrinsic.distortion = {0};
  }
  return intrinsic;
}

void HeldPart::AddTo(std::vector<int>* columns) const {
  for (int n = 0; n < size; ++n) columns->push_back(first + n);
}

double CalibrationScore::Statistic(const std::vector<int>& which,
                                   const std::vector<int>& free) const {
  // u' = M^T (u_which, u_free).
  std::vector<int> both = which;
  both.insert(both.end(), free.begin(), free.end());
  const auto size = static_cast<Eigen::Index>(which.size());
  MatX reduce = MatX::Identity(static_cast<Eigen::Index>(both.size()), size);
  if (!free.empty()) {
    reduce.bottomRows(static_cast<Eigen::Index>(free.size())) =
        -TransposedProduct(PseudoInverse(Block(information, free, free)),
                           Block(information, free, which));
  }
  const auto reduced = [&](const MatX& matrix) {
    return TransposedProduct(
        reduce, TransposedProduct(Block(matrix, both, both), reduce));
  };
  const VecX left = TransposedProduct(reduce, Block(u, both, {0}));
  const MatX by_noise = reduced(information);
  const VecX scale = Block(prior_information, which, which)
                         .diagonal()
                         .cwiseSqrt()
                         .cwiseInverse();
  if (!scale.allFinite()) return 0;
  // No eigenvalue of the scaled information may be below this.
  constexpr double kLeastShare = 1e-7;
  MatX beyond = scale.asDiagonal() * by_noise * scale.asDiagonal();
  beyond.diagonal().array() -= kLeastShare;
  if (!(Eigen::LDLT<MatX>(beyond).vectorD().minCoeff() > 0)) return 0;
  const double by_model =
      left.dot(VecX(Eigen::LDLT<MatX>(by_noise).solve(left)));
  const double by_spread =
      left.dot(VecX(TransposedProduct(PseudoInverse(reduced(variance)), left)));
  const double least = std::min(by_model, by_spread);
  return std::isfinite(least) ? std::max(0.0, least) : 0;
}

VecX CalibrationScore::Change(const std::vector<int>& which) const {
  VecX change = VecX::Zero(u.size());
  change(which) = -TransposedProduct(
      PseudoInverse(Block(information, which, which)), Block(u, which, {0}));
  std::vector<double> excess(groups.size(), 1);
  for (const HeldPart& part : parts) {
    const double farthest =
        change.segment(part.first, part.size).cwiseAbs().maxCoeff();
    excess[part.group] =
        std::max(excess[part.group], farthest / FarthestChange(part.part));
  }
  for (const HeldPart& part : parts) {
    change.segment(part.first, part.size) /= excess[part.group];
  }
  return change;
}

std::optional<CalibrationScore> ScoreCalibration(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const Scene& scene, CameraSet cameras, StructureState state) {
  CalibrationScore score;
  score.groups = MakeGroups(options, cameras);
  AdjustmentOptions freed = options;
  freed.principal_point_stddev = 0;
  for (IntrinsicState& intrinsic : cameras.intrinsics) {
    intrinsic.value = WithDistortion(intrinsic.value);
    freed.refine_intrinsics[intrinsic.id] = kAllParts;
  }
  state.pairs.clear();
  state.planes.clear();
  state.priors.clear();
  state.ratio_priors.clear();
  state.directions.clear();
  RefreshRays(scene, cameras, &state);
  const ProblemSelection selection = SelectForSolve(cameras, state, freed);
  if (score.groups.empty() || selection.IsEmpty()) return std::nullopt;
  const std::vector<Component> components =
      FindComponents(cameras, state, selection);
  EnterComponentFrames(components, &cameras, &state);
  const QuietLogging quiet;
  SolveRequest request;
  request.noise = noise;
  ProblemBuilder builder(freed, request, selection, components, &cameras,
                         &state);
  const LinearisedProblem linearised(&builder);
  const auto column_of = [&](int intrinsic) {
    return linearised.KeptColumn(builder.IntrinsicBlock(intrinsic));
  };
  for (Group& group : score.groups) {
    std::stable_partition(group.intrinsics.begin(), group.intrinsics.end(),
                          [&](int n) { return column_of(n) >= 0; });
  }

  MatX held_directions = MatX::Zero(
      linearised.kept_size,
      static_cast<Eigen::Index>(score.groups.size()) * kMaxIntrinsicParameters);
  int count = 0;
  for (std::size_t g = 0; g < score.groups.size(); ++g) {
    const Group& group = score.groups[g];
    std::vector<int> column(group.intrinsics.size());
    for (std::size_t n = 0; n < column.size(); ++n) {
      column[n] = column_of(group.intrinsics[n]);
    }
    for (const IntrinsicPart part : kParts) {
      HeldPart held{g, part, count, 0};
      for (std::size_t n = 0; n < column.size(); ++n) {
        if (column[n] < 0) continue;  // no landmark in its views
        const Intrinsic& value = cameras.intrinsics[group.intrinsics[n]].value;
        const int size = Size(part, value);
        for (int k = 0; k < size && !(group.refined.*part); ++k) {
          held_directions(column[n] + k, count + k) = Unit(part, value);
          held.size = std::max(held.size, size);
        }
        column[n] += size;
      }
      count += held.size;
      if (held.size > 0) score.parts.push_back(held);
    }
  }
  if (score.parts.empty()) return std::nullopt;
  std::vector<int> free;
  for (int n = 0; n < linearised.kept_size; ++n) {
    if ((held_directions.row(n).array() == 0).all()) free.push_back(n);
  }
  held_directions.conservativeResize(Eigen::NoChange, count);
  if (!ComputeScore(linearised, free, held_directions, &score)) {
    return std::nullopt;
  }
  return score;
}

}  // namespace lowlap
