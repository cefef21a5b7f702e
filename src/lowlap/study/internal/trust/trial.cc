#include "lowlap/study/internal/trust/trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/study/internal/trust/position_errors.h"

namespace lowlap {
namespace {

double WorstDeviation(const Mat3& covariance) {
  const Vec3 variances =
      Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvalues();
  return std::sqrt(std::max(0.0, variances.maxCoeff()));
}

void JudgeViews(const SyntheticScene& solved, const SolveResult& result,
                bool has_truth, TrustTrial* trial) {
  trial->num_triplets = result.ratios.num_triplets;
  trial->num_meaningful = result.ratios.num_meaningful;
  trial->is_doubtful = result.poses.IsDoubtful();
  const PositionErrors errors =
      RobustPositionErrors(solved.scene, solved.true_poses, kWrongCamera);
  std::map<ViewId, GradedView> grades = GradeViews(result.poses);
  for (JudgedView& judged : trial->views) {
    judged.graded = std::move(grades[judged.view]);
    const auto error = errors.error.find(judged.view);
    if (has_truth && error != errors.error.end()) judged.error = error->second;
    if (!result.adjustment) continue;
    const auto& covariances = result.adjustment->center_covariances;
    const auto found =
        covariances.find(solved.scene.views.at(judged.view).pose_id);
    if (found != covariances.end()) {
      judged.deviation = errors.unit * WorstDeviation(found->second);
    }
  }
}

}  // namespace

Result<TrustTrial> RunTrustTrial(TrustFamily family, std::uint64_t seed,
                                 const RunContext& context) {
  const TrustScene drawn = DrawTrustScene(family, seed);
  TrustTrial trial;
  trial.labels = drawn.Labels();
  for (int n = 0; n < drawn.options.num_views; ++n) {
    JudgedView judged;
    judged.view = ViewId(static_cast<std::uint32_t>(n));
    judged.graded.grade = ViewGrade::kUnplaced;
    judged.error = HUGE_VAL;
    trial.views.push_back(std::move(judged));
  }
  const auto fail = [&](const Error& error) -> Result<TrustTrial> {
    if (error.code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(error);
    }
    trial.failure = error.message;
    return trial;
  };
  auto made = MakeTrustScene(drawn, context);
  if (!made) return fail(made.error());
  SolveOptions options;
  options.adjustment.compute_center_covariances = true;
  StageLog stages;
  const auto result = SolveScene(&made->scene, options, context, &stages);
  if (!result) return fail(result.error());
  JudgeViews(*made, *result, family != TrustFamily::kNoise, &trial);
  return trial;
}

}  // namespace lowlap
