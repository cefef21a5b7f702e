#include "lowlap/averaging/strategies/internal/positioning_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/averaging/internal/block_matrix.h"
#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/averaging/internal/track_rays.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/robust/internal/robust_loss.h"

namespace lowlap {
namespace {

constexpr double kLeastScale = 1e-6;

// Tracks that are worked through between two questions to the host: some
// hundredths of a second (AnswerToStop/global_positioning/town, scale averaging
// benchmark).
constexpr std::size_t kTracksPerQuestion = 4096;

// Asks the host in a loop over tracks, now and then.
class TrackAsker {
 public:
  TrackAsker(const RunContext& context, int iteration, int max_iterations)
      : context_(context),
        iteration_(iteration),
        max_iterations_(max_iterations) {}
  Status Ask() const {
    return AskToGoOn(context_, iteration_, max_iterations_);
  }
  Status AskAfter(std::size_t track) const {
    return (track + 1) % kTracksPerQuestion == 0 ? Ask() : Status();
  }

 private:
  const RunContext& context_;
  int iteration_, max_iterations_;
};

// Each pair once: common points are many.
std::vector<BlockMatrix::Place> PairsOfCenters(
    const std::vector<TrackRays>& tracks, std::size_t num_centers) {
  const auto tracks_of_view = TracksOfViews(tracks, num_centers);
  std::vector<BlockMatrix::Place> places;
  std::vector<std::size_t> last_met(num_centers, num_centers);
  for (std::size_t view = 0; view < num_centers; ++view) {
    for (const std::size_t k : tracks_of_view[view]) {
      for (const RayObservation& seen : tracks[k].observations) {
        if (seen.view <= view || last_met[seen.view] == view) continue;
        last_met[seen.view] = view;
        places.push_back({seen.view, view});
      }
    }
  }
  return places;
}

/// The equations of one step for all centres, points and scales. With
/// e = X - C, r = ray - s e and weight w, each observation has
///   dr/ds = -e,  dr/dX = -s I,  dr/dC = s I.
/// Without s (damped by mu), it is w s^2 (I - w e e^T / h) between X and C,
/// h = (1 + mu) w e^T e; without X, a 3x3 block between any two of its centres.
class StepEquations {
 public:
  StepEquations(const std::vector<TrackRays>& tracks, std::size_t num_centers,
                const RunContext& context)
      : tracks_(tracks),
        num_centers_(num_centers),
        matrix_(num_centers, PairsOfCenters(tracks, num_centers)),
        solver_(context) {
    terms_.resize(tracks.size());
    blocks_.resize(tracks.size());
    inverses_.resize(tracks.size());
    pulls_.resize(tracks.size());
  }

  /// To be called once, before Solve. kCancelled.
  Status FindBlocks(const TrackAsker& asker) {
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      LOWLAP_RETURN_IF_ERROR(asker.AskAfter(k));
      const std::vector<RayObservation>& seen = tracks_[k].observations;
      terms_[k].resize(seen.size());
      for (const RayObservation& a : seen) {
        for (const RayObservation& b : seen) {
          if (a.view >= b.view) {
            blocks_[k].push_back(matrix_.FindBlock(a.view, b.view));
          }
        }
      }
    }
    return {};
  }

  /// kNumerical if the centres' system cannot be solved; kCancelled.
  Status Solve(const PositioningState& state, double reach, double damping,
               const TrackAsker& asker, PositioningState* next) {
    matrix_.SetZero();
    Eigen::VectorXd rhs =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * num_centers_));
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      LOWLAP_RETURN_IF_ERROR(asker.AskAfter(k));
      AddTrack(state, k, reach, damping, &rhs);
    }
    const auto solved = solver_.Solve(matrix_.lower(), rhs);
    if (!solved) return tl::unexpected<Error>(solved.error());
    const Eigen::VectorXd step = solved->col(0);

    for (std::size_t n = 0; n < num_centers_; ++n) {
      next->centers[n] = state.centers[n] + step.segment<3>(3 * n);
    }
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      LOWLAP_RETURN_IF_ERROR(asker.AskAfter(k));
      BackSubstitute(state, k, step, next);
    }
    return {};
  }

 private:
  struct Term {
    Vec3 offset;       // X - C
    Mat3 information;  // between X and C, without s
    double step_s;     // of the scale, if X and C stay
    double slope;      // d step_s / d (e^T (dC - dX))
  };

  void AddTrack(const PositioningState& state, std::size_t k, double reach,
                double damping, Eigen::VectorXd* rhs) {
    const std::vector<RayObservation>& seen = tracks_[k].observations;
    std::vector<Term>& terms = terms_[k];
    Mat3 point_information = Mat3::Zero();
    Vec3 point_pull = Vec3::Zero();
    std::vector<Vec3> pulls(seen.size());
    diagonal_.resize(seen.size());
    for (std::size_t n = 0; n < seen.size(); ++n) {
      Term& term = terms[n];
      const double s = state.scales[k][n];
      term.offset = state.points[k] - state.centers[seen[n].view];
      const Vec3 residual = seen[n].ray_in_world - s * term.offset;
      const double size = residual.norm();
      const double w = HuberWeight(size, reach);
      const double square =
          std::max(term.offset.squaredNorm(), 1e-300) * (1 + damping);
      term.step_s = term.offset.dot(residual) / square;
      term.slope = s / square;
      term.information =
          w * s * s *
          (Mat3::Identity() - term.offset * term.offset.transpose() / square);
      // The gradient of X, negated, after s has moved by step_s.
      pulls[n] = w * s * (residual - term.step_s * term.offset);
      const double damped = damping * w * s * s;
      point_information += term.information + damped * Mat3::Identity();
      point_pull += pulls[n];
      diagonal_[n] = term.information + damped * Mat3::Identity();
    }
    inverses_[k] = point_information.inverse();
    pulls_[k] = point_pull;
    std::size_t next_block = 0;
    for (std::size_t a = 0; a < seen.size(); ++a) {
      const Mat3 through = terms[a].information * inverses_[k];
      rhs->segment<3>(static_cast<Eigen::Index>(3 * seen[a].view)) +=
          through * point_pull - pulls[a];
      for (std::size_t b = 0; b < seen.size(); ++b) {
        if (seen[a].view < seen[b].view) continue;
        Mat3 block = -through * terms[b].information;
        if (a == b) block += diagonal_[a];
        matrix_.Add(blocks_[k][next_block++], block);
      }
    }
  }

  void BackSubstitute(const PositioningState& state, std::size_t k,
                      const Eigen::VectorXd& step, PositioningState* next) {
    const std::vector<RayObservation>& seen = tracks_[k].observations;
    const auto center_step = [&](std::size_t n) -> Vec3 {
      return step.segment<3>(static_cast<Eigen::Index>(3 * seen[n].view));
    };
    Vec3 pull = pulls_[k];
    for (std::size_t n = 0; n < seen.size(); ++n) {
      pull += terms_[k][n].information * center_step(n);
    }
    const Vec3 point_step = inverses_[k] * pull;
    next->points[k] = state.points[k] + point_step;
    for (std::size_t n = 0; n < seen.size(); ++n) {
      const Term& term = terms_[k][n];
      const double scale_step =
          term.step_s +
          term.slope * term.offset.dot(center_step(n) - point_step);
      next->scales[k][n] =
          std::max(kLeastScale, state.scales[k][n] + scale_step);
    }
  }

  const std::vector<TrackRays>& tracks_;
  std::size_t num_centers_;
  BlockMatrix matrix_;  // of the centres
  /// Per track, the blocks of its pairs of views, in the order of AddTrack.
  std::vector<std::vector<std::size_t>> blocks_;
  std::vector<std::vector<Term>> terms_;
  std::vector<Mat3> inverses_;  // of the points' information
  std::vector<Vec3> pulls_;     // on the points
  std::vector<Mat3> diagonal_;
  SparseSolver solver_;
};

}  // namespace

double PositioningCost(const std::vector<TrackRays>& tracks,
                       const PositioningState& state, double huber_reach) {
  double cost = 0;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const std::vector<RayObservation>& seen = tracks[k].observations;
    for (std::size_t n = 0; n < seen.size(); ++n) {
      const double size =
          (seen[n].ray_in_world -
           state.scales[k][n] * (state.points[k] - state.centers[seen[n].view]))
              .norm();
      cost += 2 * HuberLoss(size, huber_reach);
    }
  }
  return cost;
}

Result<int> SolvePositions(const std::vector<TrackRays>& tracks,
                           const PositioningOptions& options,
                           const RunContext& context, PositioningState* state) {
  constexpr double kLeastDamping = 1e-10, kGreatestDamping = 1e10;
  constexpr double kTolerance = 1e-7;
  constexpr double kNoCost = 1e-24;  // per observation: rounding is left
  StepEquations equations(tracks, state->centers.size(), context);
  Status status =
      equations.FindBlocks(TrackAsker(context, 0, options.max_iterations));
  if (!status) return tl::unexpected<Error>(status.error());
  double cost = PositioningCost(tracks, *state, options.huber_reach);
  double damping = 1e-4, increase = 2;
  std::size_t num_observations = 0;
  for (const TrackRays& track : tracks) {
    num_observations += track.observations.size();
  }
  PositioningState next = *state;
  int iteration = 0, small_steps = 0;
  while (iteration < options.max_iterations && small_steps < 3 &&
         cost > kNoCost * static_cast<double>(num_observations)) {
    const TrackAsker asker(context, iteration, options.max_iterations);
    status = asker.Ask();
    if (!status) return tl::unexpected<Error>(status.error());
    ++iteration;
    double next_cost = std::nan("");
    status =
        equations.Solve(*state, options.huber_reach, damping, asker, &next);
    if (status) {
      next_cost = PositioningCost(tracks, next, options.huber_reach);
    } else if (status.error().code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(status.error());
    }
    if (next_cost < cost) {
      small_steps = cost - next_cost < kTolerance * cost ? small_steps + 1 : 0;
      std::swap(*state, next);
      cost = next_cost;
      damping = std::max(kLeastDamping, damping / 5);
      increase = 2;
    } else {
      damping *= increase;
      increase *= 2;
      if (damping > kGreatestDamping) break;
    }
  }
  if (!std::isfinite(cost)) {
    return MakeError(ErrorCode::kNumerical,
                     "global positioning met a value that is not finite");
  }
  return iteration;
}

}  // namespace lowlap
