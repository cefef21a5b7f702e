#include "lowlap/adjustment/internal/rounds/calibration_score.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "lowlap/adjustment/internal/costs/intrinsic_freedom.h"
#include "lowlap/adjustment/internal/rounds/linearised_problem.h"
#include "lowlap/adjustment/internal/rounds/quiet_logging.h"
#include "lowlap/robust/internal/chi_square.h"

namespace lowlap {
namespace {

using MatX = Eigen::MatrixXd;
using VecX = Eigen::VectorXd;

constexpr std::size_t kMaxSeparate = 16;
constexpr double kFalseAlarms = 0.01;
constexpr IntrinsicRefinement kAllParts{true, true, true, true};

using Part = bool IntrinsicRefinement::*;
// In the order of the columns of FreeDirections.
constexpr Part kParts[] = {
    &IntrinsicRefinement::focal, &IntrinsicRefinement::aspect_ratio,
    &IntrinsicRefinement::principal_point, &IntrinsicRefinement::distortion};

int Size(Part part, const Intrinsic& intrinsic) {
  if (part == &IntrinsicRefinement::principal_point) return 2;
  if (part == &IntrinsicRefinement::distortion) {
    return static_cast<int>(intrinsic.distortion.size());
  }
  return 1;
}

// How far a part of the solver's parameters moves at a change of 1: focal
// lengths and aspect by the factor e, the principal point by the diagonal.
double Unit(Part part, const Intrinsic& intrinsic) {
  if (part == &IntrinsicRefinement::focal) {
    return std::hypot(intrinsic.fx_px, intrinsic.fy_px);
  }
  if (part == &IntrinsicRefinement::aspect_ratio) return intrinsic.fy_px;
  return part == &IntrinsicRefinement::principal_point
             ? intrinsic.ImageDiagonal()
             : 1;
}

void Apply(Part part, const VecX& change, Intrinsic* intrinsic) {
  if (part == &IntrinsicRefinement::focal) intrinsic->fx_px *= 1 + change(0);
  if (part == &IntrinsicRefinement::focal ||
      part == &IntrinsicRefinement::aspect_ratio) {
    intrinsic->fy_px *= 1 + change(0);
  } else if (part == &IntrinsicRefinement::principal_point) {
    intrinsic->principal_point_px += intrinsic->ImageDiagonal() * change;
  } else {
    for (std::size_t n = 0; n < intrinsic->distortion.size(); ++n) {
      intrinsic->distortion[n] += change(static_cast<Eigen::Index>(n));
    }
  }
}

// A held part of the intrinsics that are tested together: consecutive columns
// of the held parameters t.
struct Candidate {
  std::size_t group = 0;
  Part part = nullptr;
  int first = 0;
  int size = 0;
  bool chosen = false;
};

struct Group {
  std::vector<int> intrinsics;
  IntrinsicRefinement refined;
};

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
    for (const Part part : kParts) {
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

// The score test in the held parameters alone; see the header.
struct Score {
  VecX u;
  MatX information;
  MatX prior_information;  // if everything else were known
  MatX variance;           // of u, from the landmarks' shares
};

// `held` says how the held parameters move the kept columns; the columns
// `free` move by themselves.
std::optional<Score> ComputeScore(const LinearisedProblem& linearised,
                                  const std::vector<int>& free,
                                  const MatX& held) {
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
  if (factor.info() != Eigen::Success) return std::nullopt;
  const MatX kept_held = linearised.schur_complement * held;
  MatX cross(free_count, held.cols());
  for (const int n : free) cross.row(place[n]) = kept_held.row(n);
  const MatX solved = factor.solve(cross);
  Score score;
  score.prior_information = TransposedProduct(held, kept_held);
  score.information =
      score.prior_information - TransposedProduct(cross, solved);
  MatX efficient = held;
  for (const int n : free) efficient.row(n) -= solved.row(place[n]);
  const MatX shares = linearised.gradients * efficient;  // by landmark
  score.u = shares.colwise().sum().transpose();
  const double unknowns = static_cast<double>(free_count + held.cols());
  if (!(linearised.redundancy > unknowns)) return std::nullopt;
  score.variance = TransposedProduct(shares, shares) *
                   (linearised.redundancy / (linearised.redundancy - unknowns));
  return score;
}

// The statistic of the parameters `which`, given that those in `free` are free;
// 0 where the images do not determine them.
double Statistic(const Score& score, const std::vector<int>& which,
                 const std::vector<int>& free) {
  // u' = M^T (u_which, u_free).
  std::vector<int> both = which;
  both.insert(both.end(), free.begin(), free.end());
  const auto size = static_cast<Eigen::Index>(which.size());
  MatX reduce = MatX::Identity(static_cast<Eigen::Index>(both.size()), size);
  if (!free.empty()) {
    reduce.bottomRows(static_cast<Eigen::Index>(free.size())) =
        -TransposedProduct(PseudoInverse(Block(score.information, free, free)),
                           Block(score.information, free, which));
  }
  const auto reduced = [&](const MatX& matrix) {
    return TransposedProduct(
        reduce, TransposedProduct(Block(matrix, both, both), reduce));
  };
  const VecX u = TransposedProduct(reduce, Block(score.u, both, {0}));
  const MatX information = reduced(score.information);
  const VecX scale = Block(score.prior_information, which, which)
                         .diagonal()
                         .cwiseSqrt()
                         .cwiseInverse();
  if (!scale.allFinite()) return 0;
  // No eigenvalue of the scaled information may be below this.
  constexpr double kLeastShare = 1e-7;
  MatX beyond = scale.asDiagonal() * information * scale.asDiagonal();
  beyond.diagonal().array() -= kLeastShare;
  if (!(Eigen::LDLT<MatX>(beyond).vectorD().minCoeff() > 0)) return 0;
  const double by_model = u.dot(VecX(Eigen::LDLT<MatX>(information).solve(u)));
  const double by_spread =
      u.dot(VecX(TransposedProduct(PseudoInverse(reduced(score.variance)), u)));
  const double least = std::min(by_model, by_spread);
  return std::isfinite(least) ? std::max(0.0, least) : 0;
}

std::vector<int> Columns(const std::vector<Candidate>& candidates,
                         const std::function<bool(const Candidate&)>& wanted) {
  std::vector<int> columns;
  for (const Candidate& candidate : candidates) {
    if (!wanted(candidate)) continue;
    for (int n = 0; n < candidate.size; ++n) {
      columns.push_back(candidate.first + n);
    }
  }
  return columns;
}

// Marks the candidates that noise does not explain.
void Choose(const Score& score, std::vector<Candidate>* candidates) {
  const double level =
      std::log(kFalseAlarms / static_cast<double>(candidates->size()));
  for (;;) {
    const std::vector<int> chosen =
        Columns(*candidates, [](const Candidate& c) { return c.chosen; });
    Candidate* best = nullptr;
    double least = level;
    for (Candidate& candidate : *candidates) {
      if (candidate.chosen) continue;
      const std::vector<int> own = Columns(
          *candidates, [&](const Candidate& c) { return &c == &candidate; });
      const double log_tail =
          LogChiSquareTail(Statistic(score, own, chosen), candidate.size);
      if (log_tail < least) {
        least = log_tail;
        best = &candidate;
      }
    }
    if (best == nullptr) return;
    best->chosen = true;
  }
}

}  // namespace

std::vector<CalibrationPreference> FindCalibrationPreferences(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    CameraSet cameras, StructureState state) {
  std::vector<Group> groups = MakeGroups(options, cameras);
  const CameraSet held = cameras;
  AdjustmentOptions freed = options;
  freed.use_lines = false;
  freed.principal_point_stddev = 0;
  for (IntrinsicState& intrinsic : cameras.intrinsics) {
    if (intrinsic.value.model == CameraModel::kPinhole) {
      intrinsic.value.model = CameraModel::kRadialK1;
      intrinsic.value.distortion = {0};
    }
    freed.refine_intrinsics[intrinsic.id] = kAllParts;
  }
  state.lines.clear();
  state.pairs.clear();
  state.priors.clear();
  state.ratio_priors.clear();
  // Directions are those of lines, and of the calibration that is held.
  state.directions.clear();
  const ProblemSelection selection = SelectForSolve(cameras, state, freed);
  if (groups.empty() || selection.IsEmpty()) return {};
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
  // The first of a group represents it: it must be one that was tested.
  for (Group& group : groups) {
    std::stable_partition(group.intrinsics.begin(), group.intrinsics.end(),
                          [&](int n) { return column_of(n) >= 0; });
  }

  std::vector<Candidate> candidates;
  MatX held_directions = MatX::Zero(
      linearised.kept_size,
      static_cast<Eigen::Index>(groups.size()) * kMaxIntrinsicParameters);
  int count = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<int> column(groups[g].intrinsics.size());
    for (std::size_t n = 0; n < column.size(); ++n) {
      column[n] = column_of(groups[g].intrinsics[n]);
    }
    for (const Part part : kParts) {
      Candidate candidate{g, part, count, 0, false};
      for (std::size_t n = 0; n < column.size(); ++n) {
        if (column[n] < 0) continue;  // no landmark in its views
        const Intrinsic& value =
            cameras.intrinsics[groups[g].intrinsics[n]].value;
        const int size = Size(part, value);
        for (int k = 0; k < size && !(groups[g].refined.*part); ++k) {
          held_directions(column[n] + k, count + k) = Unit(part, value);
          candidate.size = std::max(candidate.size, size);
        }
        column[n] += size;
      }
      count += candidate.size;
      if (candidate.size > 0) candidates.push_back(candidate);
    }
  }
  if (candidates.empty()) return {};
  std::vector<int> free;
  for (int n = 0; n < linearised.kept_size; ++n) {
    if ((held_directions.row(n).array() == 0).all()) free.push_back(n);
  }
  held_directions.conservativeResize(Eigen::NoChange, count);

  const std::optional<Score> score =
      ComputeScore(linearised, free, held_directions);
  if (!score) return {};
  Choose(*score, &candidates);

  const std::vector<int> chosen =
      Columns(candidates, [](const Candidate& c) { return c.chosen; });
  if (chosen.empty()) return {};
  VecX change = VecX::Zero(count);
  change(chosen) = -TransposedProduct(
      PseudoInverse(Block(score->information, chosen, chosen)),
      Block(score->u, chosen, {0}));
  std::vector<CalibrationPreference> preferences;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    CalibrationPreference preference;
    for (const int n : groups[g].intrinsics) {
      preference.intrinsics.push_back(cameras.intrinsics[n].id);
    }
    const int representative = groups[g].intrinsics.front();
    preference.held = held.intrinsics[representative].value;
    preference.preferred = preference.held;
    preference.refined = groups[g].refined;
    for (const Candidate& candidate : candidates) {
      if (candidate.group != g || !candidate.chosen) continue;
      preference.parts.*candidate.part = true;
      if (candidate.part == &IntrinsicRefinement::distortion) {
        preference.preferred.model =
            cameras.intrinsics[representative].value.model;
        preference.preferred.distortion =
            cameras.intrinsics[representative].value.distortion;
      }
      Apply(candidate.part, change.segment(candidate.first, candidate.size),
            &preference.preferred);
    }
    if (!preference.parts.Any()) continue;
    const auto of_group = [&](const Candidate& c) {
      return c.chosen && c.group == g;
    };
    preference.deviations =
        std::sqrt(Statistic(*score, Columns(candidates, of_group),
                            Columns(candidates, [&](const Candidate& c) {
                              return c.chosen && !of_group(c);
                            })));
    preferences.push_back(std::move(preference));
  }
  return preferences;
}

}  // namespace lowlap
