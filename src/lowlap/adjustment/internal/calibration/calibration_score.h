#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

using IntrinsicPart = bool IntrinsicRefinement::*;

/// A held part of the intrinsics that are scored together: consecutive columns
/// of the held parameters t.
struct HeldPart {
  std::size_t group = 0;
  IntrinsicPart part = nullptr;
  int first = 0;
  int size = 0;

  /// Adds its columns to those that are there.
  void AddTo(std::vector<int>* columns) const;
};

/// Where the images would take what is held of the calibration, at an adjusted
/// state. With the gradient g and the Hessian H of the cost, by the held
/// parameters t and, x, everything that is free (poses, landmarks, refined
/// parts),
///   u = g_t - H_tx H_xx^-1 g_x,   I = H_tt - H_tx H_xx^-1 H_xt,
/// the images prefer what is away by -I^-1 u, to first order, and u^T I^-1 u
/// has a chi-square distribution if only noise is in u. So has u^T V^-1 u, with
/// V from the landmarks' own shares of u, whatever the noise level; the lesser
/// of the two counts.
///
/// One intrinsic at a time, or, beyond 16, all by one common change (of the
/// focal lengths and the aspect by a factor, of the principal points by a share
/// of the diagonal). Pinholes have a k1 of 0.
struct CalibrationScore {
  /// Intrinsics by index, the first one that landmarks observe.
  struct Group {
    std::vector<int> intrinsics;
    IntrinsicRefinement refined;
  };
  std::vector<Group> groups;
  std::vector<HeldPart> parts;

  Eigen::VectorXd u;
  Eigen::MatrixXd information;
  Eigen::MatrixXd prior_information;  // if everything else were known
  Eigen::MatrixXd variance;           // of u, from the landmarks' shares

  /// The statistic of the parameters `which`, given that those in `free` are
  /// free; 0 where the images do not determine them.
  double Statistic(const std::vector<int>& which,
                   const std::vector<int>& free) const;

  /// Where the images take the parameters `which` if these are free; 0 for all
  /// others. To first order that may be where no camera is, if little is
  /// determined: the change of a group is shortened until its focal lengths at
  /// most double or halve, principal points move by a quarter of the diagonal,
  /// and distortion coefficients by 1.
  Eigen::VectorXd Change(const std::vector<int>& which) const;
};

/// Of the landmarks in the state, without ties, priors and directions, which
/// are those of the calibration that is held. nullopt: nothing is held, or less
/// is measured than is unknown.
std::optional<CalibrationScore> ScoreCalibration(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const Scene& scene, CameraSet cameras, StructureState state);

/// Moves a part by a change in the parameters t.
void ChangePart(IntrinsicPart part, const Eigen::VectorXd& change,
                Intrinsic* intrinsic);

/// With a k1 of 0 if it is a pinhole.
Intrinsic WithDistortion(Intrinsic intrinsic);

}  // namespace lowlap
