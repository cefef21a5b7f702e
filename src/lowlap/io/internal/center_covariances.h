#pragma once

#include <map>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// Both forms keep the covariances of centres in a section of their own:
/// OpenMVG's poses have none.
using CenterCovariances = std::map<PoseId, Mat3>;

CenterCovariances CenterCovariancesOf(const Scene& scene);

/// Throws a Failure for an id that is no pose of the scene.
void SetCenterCovariances(const CenterCovariances& covariances, Scene& scene);

}  // namespace lowlap
