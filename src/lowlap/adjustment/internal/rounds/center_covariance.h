#pragma once

#include <map>
#include <vector>

#include "lowlap/adjustment/internal/rounds/problem_builder.h"

namespace lowlap {

/// Covariances of the camera centres in world units, from the Hessian J^T J of
/// the problem at its present values with points and lines marginalised:
///   S = H_cc - H_cl H_ll^-1 H_lc,  cov = S^-1
/// (the pseudo-inverse, should a camera be underdetermined). J is that of the
/// weighted and robustified residuals, so that the noise levels are in it. Call
/// it while the components are in their frames; `saved_references` are the
/// reference poses in world. Those poses are absent from the result.
std::map<PoseId, Mat3> CenterCovariances(
    const std::vector<Component>& components,
    const std::vector<PoseState>& saved_references, const CameraSet& cameras,
    ProblemBuilder* builder);

}  // namespace lowlap
