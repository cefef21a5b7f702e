#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A piece of a model that measurements bear out, and the deviation that they
/// leave it.
struct TrustedPiece {
  std::size_t model = 0;  // index into the models
  RigidPiece piece;
  double rotation_stddev_rad = 0;
  double direction_stddev_rad = 0;
};

/// The pieces of all models, most views first. The residuals of a piece are its
/// own errors and those of the measured relative poses; what the latter's
/// stated deviations do not explain is taken for its own.
std::vector<TrustedPiece> TrustedPieces(const Scene& measured,
                                        const std::vector<ModelCheck>& checks);

/// Replaces the relative poses inside pieces by those of the models, and the
/// scale ratios by those of the models, of all triplets whose two relative
/// poses are of one piece. A relative pose in several pieces is that of the
/// largest.
void TrustPieces(const std::vector<PartialModel>& models,
                 const std::vector<ModelCheck>& checks,
                 const std::vector<TrustedPiece>& pieces, Scene* scene);

}  // namespace lowlap
