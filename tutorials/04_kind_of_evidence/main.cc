// Tutorial 4: a kind of evidence of one's own, beside the built-in ones.
//
// A robot that took the photographs measured how far it moved between some of
// them, to within a tenth of a percent. Such an odometry says something about
// the ratio of two neighbouring baselines, as coplanar lines or trifocal points
// do. The estimator weighs all of them by what each would say by chance.
//
//   cmake -S tutorials/04_kind_of_evidence -B build/tutorial04
//   cmake --build build/tutorial04 && build/tutorial04/kind_of_evidence
#include <lowlap/evaluation/pose_errors.h>
#include <lowlap/pipeline/solve_scene.h>
#include <lowlap/scale/evidence/evidence_registry.h>
#include <lowlap/synthetic/synthetic_scene.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace {

// What odometry says about one triplet: one log ratio. Its error is counted in
// standard deviations, which is an error of about 1 as a rule.
class OdometryEvidence : public lowlap::Evidence {
 public:
  OdometryEvidence(double log_ratio, double stddev) {
    AddCandidate({lowlap::CandidateStatus::kValid, log_ratio, stddev});
  }
  float ErrorOf(double tau, int candidate) const override {
    const lowlap::RatioCandidate& ratio = ratios()[candidate];
    return static_cast<float>(std::abs(std::log(tau) - ratio.log_ratio) /
                              ratio.log_ratio_stddev);
  }
  // The only ratio it asks to try is its own.
  double NumTests() const override { return 1; }
  // Had it nothing to do with the photographs, its ratio would be anything from
  // 1/100 to 100, evenly in the logarithm.
  std::optional<lowlap::LadderProbabilities> Background() const override {
    lowlap::LadderProbabilities log10_alpha;
    for (int step = 0; step < lowlap::kNumThresholds; ++step) {
      const double reach =
          lowlap::LadderThresholdPx(step) * ratios().front().log_ratio_stddev;
      log10_alpha[step] = std::log10(std::min(1.0, reach / std::log(100.0)));
    }
    return log10_alpha;
  }
};

class Odometry : public lowlap::EvidenceKind {
 public:
  using Lengths = std::map<lowlap::ViewPair, double>;

  Odometry(Lengths lengths, double relative_stddev)
      : lengths_(std::move(lengths)), relative_stddev_(relative_stddev) {}

  std::string Name() const override { return "odometry"; }

  std::unique_ptr<lowlap::Evidence> Gather(
      const lowlap::TripletView& triplet) const override {
    const auto length = [&](lowlap::ViewId a, lowlap::ViewId b) {
      const auto found = lengths_.find({std::min(a, b), std::max(a, b)});
      return found == lengths_.end() ? 0 : found->second;
    };
    const lowlap::ViewTriplet& views = triplet.views;
    const double first = length(views.first, views.middle);
    const double last = length(views.middle, views.last);
    if (first == 0 || last == 0) return nullptr;
    return std::make_unique<OdometryEvidence>(
        std::log(last / first), std::sqrt(2.0) * relative_stddev_);
  }

 private:
  Lengths lengths_;
  double relative_stddev_;
};

int Fail(const lowlap::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main() {
  // A sparse room: hardly anything to see, and nothing in three photographs.
  lowlap::SyntheticOptions room;
  room.num_views = 7;
  room.pairs = "chain";
  room.points_per_wall = 25;
  room.lines_per_wall = 40;
  room.trifocal_point_share = room.trifocal_line_share = 0;
  room.noise_px = 0.5;
  room.seed = 3;
  const auto simulated = lowlap::Simulate(room);
  if (!simulated) return Fail(simulated.error());

  // The robot knows all baselines but one, to 0.1 %.
  Odometry::Lengths lengths;
  int n = 0;
  for (const auto& [views, length] : simulated->true_baselines) {
    if (n++ != 2) lengths[views] = length * (n % 2 == 0 ? 1.0005 : 0.9995);
  }

  auto kinds = lowlap::EvidenceRegistry::BuiltIn().Make({}, {});
  if (!kinds) return Fail(kinds.error());
  kinds->push_back(std::make_shared<Odometry>(lengths, 0.001));
  lowlap::SolveOptions options;
  options.scale_estimator =
      std::make_shared<lowlap::AContrarioScaleEstimator>(*kinds);
  lowlap::Scene scene = simulated->scene;
  const auto solved =
      lowlap::SolveScene(&scene, options, lowlap::RunContext(), nullptr);
  if (!solved) return Fail(solved.error());

  bool odometry_spoke = false;
  std::printf("views   ratio   true    inliers of candidates by kind\n");
  for (const lowlap::ScaleRatio& ratio : scene.scale_ratios) {
    std::printf("%u-%u-%u  %6.4f  %6.4f ", ratio.views.first.value(),
                ratio.views.middle.value(), ratio.views.last.value(),
                std::exp(ratio.log_ratio),
                std::exp(*simulated->TrueLogRatio(ratio.views)));
    for (const lowlap::KindSupport& kind : ratio.kinds) {
      std::printf("  %s %d/%d", kind.kind.c_str(), kind.inliers,
                  kind.candidates);
      odometry_spoke |= kind.kind == "odometry" && kind.inliers > 0;
    }
    std::printf("  %s\n", lowlap::RatioVerdictName(ratio.verdict));
  }
  const auto errors = lowlap::EvaluatePoses(scene, simulated->true_poses);
  std::printf("%d of %d cameras, off by %.3f m on average\n", errors.num_solved,
              errors.num_total, errors.position.mean);
  return odometry_spoke && errors.num_solved == room.num_views ? 0 : 1;
}
