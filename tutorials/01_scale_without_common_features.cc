// Example 1: cameras along a chain where no feature is seen three times.
//
// A simulated room stands in for photographs: eight views, each related to the
// next by points and lines that no third view shares. The length of one
// baseline against the next then comes from lines of the two pairs that lie in
// one plane. The example shows these scale ratios beside the true ones, solves
// the scene, and measures how far the cameras are off.
//
//   cmake -B build -DLOWLAP_BUILD_EXAMPLES=ON && cmake --build build
//   build/tutorials/01_scale_without_common_features
#include <cmath>
#include <cstdio>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace {

// No function of lowlap throws: what went wrong comes back as a value.
int Fail(const lowlap::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main() {
  lowlap::SyntheticOptions room;
  room.kind = lowlap::SyntheticKind::kRoom;
  room.num_views = 8;
  room.pairs = "chain";
  room.trifocal_point_share = 0;
  room.trifocal_line_share = 0;
  room.noise_px = 0.3;
  const auto simulated = lowlap::Simulate(room);
  if (!simulated) return Fail(simulated.error());
  lowlap::Scene scene = simulated->scene;

  // Messages, progress and the number of threads; by default it is silent.
  const lowlap::RunContext context;
  const auto ratios =
      lowlap::EstimateScaleRatios(scene, lowlap::ScaleOptions(), context);
  if (!ratios) return Fail(ratios.error());
  std::printf("views   ratio   true   pairs of lines that agree\n");
  for (const lowlap::ScaleRatio& ratio : *ratios) {
    const auto center = [&](lowlap::ViewId view) {
      return simulated->true_poses.at(view).center;
    };
    const lowlap::ViewTriplet& views = ratio.views;
    const double true_ratio =
        (center(views.last) - center(views.middle)).norm() /
        (center(views.middle) - center(views.first)).norm();
    const lowlap::KindSupport* coplanar = ratio.FindKind("coplanar");
    std::printf("%u-%u-%u  %6.4f  %6.4f  %d of %d\n", views.first.value(),
                views.middle.value(), views.last.value(),
                std::exp(ratio.log_ratio), true_ratio, coplanar->inliers,
                coplanar->candidates);
  }

  // The same and everything after it: poses, structure, bundle adjustment.
  lowlap::StageLog stages;
  const auto solved =
      lowlap::SolveScene(&scene, lowlap::SolveOptions(), context, &stages);
  if (!solved) return Fail(solved.error());
  const auto errors = lowlap::EvaluatePoses(scene, simulated->true_poses);
  std::printf("%d of %d cameras, off by %.4f m on average\n", errors.num_solved,
              errors.num_total, errors.position.mean);
  return errors.num_solved == room.num_views ? 0 : 1;
}
