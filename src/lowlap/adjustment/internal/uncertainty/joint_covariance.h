#pragma once

#include <Eigen/SparseCholesky>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/adjustment/internal/rounds/linearised_problem.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// A pair of poses by their places in a component, the lower one first, and the
/// blocks of a matrix that has three rows and columns for every pose.
using PlacePair = std::pair<Eigen::Index, Eigen::Index>;
using BlockMap = std::map<PlacePair, Mat3>;

/// C = B S^-1 M S^-1 B^T of the centres of a component: S is the Hessian, M the
/// scatter of the gradient (S itself if the noise is what is stated), B takes
/// the columns of S to the centres. It is never formed as a whole.
class JointCovariance {
 public:
  using Factor = Eigen::SimplicialLDLT<SparseMat>;

  /// `scatter` null: S.
  JointCovariance(const SparseMat& centers_from_kept, const Factor& factor,
                  const SparseMat* scatter)
      : centers_from_kept_(centers_from_kept),
        factor_(factor),
        scatter_(scatter) {}

  Eigen::MatrixXd Times(const Eigen::MatrixXd& right) const;

  /// Of these pairs, and of every pose with itself.
  BlockMap Blocks(const std::set<PlacePair>& pairs) const;

 private:
  SparseMat centers_from_kept_;
  const Factor& factor_;
  const SparseMat* scatter_;
};

/// The covariances of centres that remain once a similarity has moved all of
/// them to the true ones: the diagonal blocks of
///   P C P^T,  P = I - G (G^T W G)^-1 G^T W,
/// with the seven columns of G the motions of the centres by a similarity. The
/// weights W are those of a robust alignment: a centre that is known far worse
/// than most has no part in it, and does not blur the others. `blocks` has the
/// diagonal ones of C.
std::vector<Mat3> CovariancesWithoutGauge(const JointCovariance& joint,
                                          const BlockMap& blocks,
                                          const std::vector<Vec3>& centers);

}  // namespace lowlap
