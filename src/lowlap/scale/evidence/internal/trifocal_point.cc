#include "lowlap/scale/evidence/internal/trifocal_point.h"

#include <vector>

#include "lowlap/robust/internal/nfa.h"
#include "lowlap/scale/evidence/internal/residual_evidence.h"
#include "lowlap/scale/evidence/internal/triplet_points.h"

namespace lowlap {
namespace {

class TrifocalPoints : public ResidualEvidence<PointResiduals> {
 public:
  explicit TrifocalPoints(const TripletView& triplet)
      : image_area_px2_(triplet.image_area_px2) {
    const TripletPointSolver solver(triplet.geometry);
    residuals_.Reserve(static_cast<int>(triplet.points.size()));
    for (std::size_t n = 0; n < triplet.points.size(); ++n) {
      const TripletPoint& point = triplet.points[n];
      RatioCandidate ratio;
      const auto midpoints = solver.Midpoints(point, &ratio.status);
      if (midpoints) ratio = solver.Ratio(point, *midpoints);
      if (!AddCandidate(ratio)) continue;
      residuals_.Add(triplet.geometry, point, *midpoints, ratio.log_ratio);
      point_of_.push_back(n);
    }
  }

  double NumTests() const override { return size(); }
  NfaTerm PaperTerm(const LogFactorials& factorials,
                    const LadderCounts* counts) const override {
    return PaperPointTerm(factorials, size(), *counts, image_area_px2_);
  }
  // The deviations are those of one pixel.
  double PriorCount() const override { return 0.25; }

 protected:
  CandidateDetail DetailOf(const TripletView& triplet, int n) const override {
    return {triplet.points[point_of_[n]].in_j.head<2>(), {}};
  }
  RatioCandidate RatioIn(const TripletView& triplet,
                         const TripletGeometry& geometry,
                         int n) const override {
    return TripletPointSolver(geometry).Ratio(triplet.points[point_of_[n]]);
  }

 private:
  double image_area_px2_;
  std::vector<std::size_t> point_of_;  // in the triplet
};

}  // namespace

std::unique_ptr<Evidence> TrifocalPointKind::Gather(
    const TripletView& triplet) const {
  return std::make_unique<TrifocalPoints>(triplet);
}

}  // namespace lowlap
