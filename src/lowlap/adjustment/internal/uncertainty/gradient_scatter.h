#pragma once

#include "lowlap/adjustment/internal/rounds/linearised_problem.h"
#include "lowlap/adjustment/internal/rounds/problem_builder.h"

namespace lowlap {

/// How the gradient of the kept columns scatters if errors of neighbours have
/// something in common (localisation in one texture, a wall that is not flat,
/// the calibration of one corner of the image), and the stated noise is not the
/// true one:
///   M = sum over cells (sum of the gradients of their landmarks)(...)^T.
/// A landmark is in the cell of the first image that shows it, as wide as
/// kCommonErrorShare says, so that what neighbours have in common in later
/// images counts as far as they are neighbours there, too; M is the mean over
/// four grids, half a cell apart. With the Hessian S, S^-1 M S^-1 is the
/// covariance (Liang, Zeger, "Longitudinal data analysis using generalized
/// linear models", 1986).
SparseMat ScatterOfGradients(const LinearisedProblem& linearised,
                             const ProblemBuilder& builder,
                             const ProblemSelection& selection,
                             const CameraSet& cameras,
                             const StructureState& state);

}  // namespace lowlap
