#pragma once

#include <ceres/line_manifold.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <ceres/product_manifold.h>
#include <ceres/sphere_manifold.h>

#include <initializer_list>
#include <memory>
#include <vector>

#include "lowlap/adjustment/internal/costs/line_reprojection_cost.h"
#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/adjustment/internal/rounds/solve.h"

namespace lowlap {

/// A ceres::Problem over copies of the selected poses, intrinsics, lines and
/// points, in the frames of their components. Owns what the problem points to.
///
/// All blocks lie in one array, in the order of their indices: the solver
/// orders blocks of a group by address, and the order of sums must not depend
/// on where the heap puts things.
class ProblemBuilder {
 public:
  ProblemBuilder(const AdjustmentOptions& options, const SolveRequest& request,
                 const ProblemSelection& selection,
                 const std::vector<Component>& components, CameraSet* cameras,
                 StructureState* state);

  ceres::Problem& problem() { return problem_; }
  /// Points and an independent set of the lines: what the Schur complement
  /// eliminates.
  const std::vector<double*>& eliminated() const { return eliminated_; }
  /// The lines of these, which come first: indices into the state. The points
  /// are those of the selection.
  const std::vector<int>& eliminated_lines() const { return eliminated_lines_; }
  /// The other blocks of the problem, without those that are constant.
  const std::vector<double*>& kept() const { return kept_; }
  double* CenterBlock(std::size_t pose);
  double* IntrinsicBlock(std::size_t intrinsic);
  bool AllFinite() const;
  /// From the solver's blocks into cameras and state.
  void TakeResults();

 private:
  void AddPoints();
  void AddLines();
  void AddPairs();
  void AddPlanes();
  void AddPriors();
  void AddDirections();
  /// Index of each pose's component; -1 for a pose without structure.
  std::vector<int> ComponentOfPoses() const;
  void AddPrincipalPoints();
  void SetManifolds();
  void SplitBlocks();
  bool IsRefined(std::size_t intrinsic) const;
  double* RotationBlock(std::size_t pose);
  double* PointBlock(std::size_t point);
  double* LineBlock(std::size_t line);
  double* PlaneBlock(std::size_t plane);
  double* DirectionBlock(std::size_t direction);
  void CopyIntoBlocks();
  void AddResiduals(std::unique_ptr<ceres::CostFunction> cost,
                    ceres::LossFunction* loss,
                    std::initializer_list<double*> blocks);
  void AddObservation(std::unique_ptr<ceres::CostFunction> cost,
                      ceres::LossFunction* loss, const CameraView& view,
                      double* landmark);
  /// Loss for residuals in pixels, in units of the noise.
  ceres::LossFunction* MakeLoss(const NoiseScale& noise, double weight);

  const AdjustmentOptions& options_;
  const SolveRequest& request_;
  const ProblemSelection& selection_;
  const std::vector<Component>& components_;
  CameraSet* cameras_;
  StructureState* state_;

  std::vector<double> blocks_;
  std::vector<double*> eliminated_, kept_;
  std::vector<int> eliminated_lines_;
  std::vector<std::unique_ptr<ceres::LossFunction>> losses_;
  std::vector<std::unique_ptr<ceres::CostFunction>> costs_;
  std::vector<std::unique_ptr<ceres::Manifold>> intrinsic_manifolds_;
  ceres::EigenQuaternionManifold rotation_manifold_;
  ceres::SphereManifold<3> sphere_manifold_;
  ceres::LineManifold<3> line_manifold_;
  ceres::ProductManifold<ceres::SphereManifold<3>, ceres::EuclideanManifold<1>>
      plane_manifold_;
  ceres::Problem problem_;
};

}  // namespace lowlap
