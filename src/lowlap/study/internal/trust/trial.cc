#include "lowlap/study/internal/trust/trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/internal/center_stddev.h"
#include "lowlap/study/internal/trust/position_errors.h"

namespace lowlap {
namespace {

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
    const Pose* pose = solved.scene.FindPose(judged.view);
    if (pose == nullptr) continue;
    judged.deviation = errors.unit * CenterStddev(*pose).value_or(0);
  }
}

}  // namespace

Result<TrustTrial> RunTrustTrial(TrustFamily family, std::uint64_t seed,
                                 const RunContext& context) {
  const TrustScene drawn = DrawTrustScene(family, seed);
  TrustTrial trial;
  trial.labels = drawn.Labels();
  for (int n = 0; n < drawn.options.num_views; ++n) {
    const ViewId view(static_cast<std::uint32_t>(n));
    const auto& left_out = drawn.left_out;
    if (std::count(left_out.begin(), left_out.end(), view) > 0) continue;
    JudgedView judged;
    judged.view = view;
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
  StageLog stages;
  const auto result = SolveScene(&made->scene, options, context, &stages);
  if (!result) return fail(result.error());
  JudgeViews(*made, *result, family != TrustFamily::kNoise, &trial);
  return trial;
}

}  // namespace lowlap
