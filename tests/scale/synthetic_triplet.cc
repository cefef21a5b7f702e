#include "scale/synthetic_triplet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"
#include "scale/synthetic_room.h"

namespace lowlap::testing {
namespace {

class SyntheticTripletMaker {
 public:
  SyntheticTripletMaker(const SyntheticTripletOptions& options,
                        std::uint64_t seed)
      : options_(options), random_(seed), room_(&random_) {}

  SyntheticTriplet Make() {
    SyntheticTriplet triplet;
    TripletView& view = triplet.view;
    view.views = {0, 1, 2};
    view.geometry = {Estimated(i_from_j_), Estimated(k_from_j_), kFocalPx,
                     kFocalPx, kFocalPx};
    AddPosePerturbations(&view);
    view.image_area_px2 = kWidthPx * kHeightPx;
    view.image_diagonal_px = std::hypot(kWidthPx, kHeightPx);
    triplet.true_log_ratio =
        std::log(k_from_j_.translation.norm() / i_from_j_.translation.norm());
    for (int n = 0; n < options_.num_points; ++n) AddPoint(n, &view);
    for (int n = 0; n < options_.num_lines; ++n) AddLine(n, &view);
    FeatureIndex segment = 0;
    AddMatchedLines(i_from_j_, options_.num_lines_ij, &segment, &view.lines_ij,
                    &triplet.wall_ij);
    AddMatchedLines(k_from_j_, options_.num_lines_jk, &segment, &view.lines_jk,
                    &triplet.wall_jk);
    return triplet;
  }

 private:
  using Segment3 = SyntheticRoom::Segment3;
  static constexpr double kFocalPx = SyntheticRoom::kFocalPx;
  static constexpr double kWidthPx = SyntheticRoom::kWidthPx;
  static constexpr double kHeightPx = SyntheticRoom::kHeightPx;

  Vec3 RandomAngles(double stddev_deg) {
    const double s = RadFromDeg(stddev_deg);
    const double x = random_.Gaussian(s), y = random_.Gaussian(s);
    return {x, y, random_.Gaussian(s)};
  }

  // What a two-view step would say of its own errors.
  void AddPosePerturbations(TripletView* view) const {
    if (!(options_.rotation_error_deg > 0) &&
        !(options_.direction_error_deg > 0)) {
      return;
    }
    const double rotation = RadFromDeg(options_.rotation_error_deg);
    const double direction = RadFromDeg(options_.direction_error_deg);
    Eigen::Matrix<double, 5, 1> variances;
    variances << Vec3::Constant(rotation * rotation),
        Vec2::Constant(direction * direction);
    for (const ViewId neighbor : {view->views.first, view->views.last}) {
      const RigidTransform& n_from_j = neighbor == view->views.first
                                           ? view->geometry.cami_from_camj
                                           : view->geometry.camk_from_camj;
      RelativePose edge;
      edge.views = {view->views.middle, neighbor};
      edge.rotation = n_from_j.rotation;
      edge.direction = n_from_j.translation;
      edge.covariance = variances.asDiagonal();
      for (const TripletGeometry& geometry :
           PerturbPose(view->geometry, edge, view->views)) {
        view->pose_perturbations.push_back(geometry);
      }
    }
  }

  // At unit baseline, with the errors of the two-view step.
  RigidTransform Estimated(const RigidTransform& truth) {
    const Mat3 turn =
        RotationFromAngleAxis(RandomAngles(options_.rotation_error_deg));
    const Mat3 tilt =
        RotationFromAngleAxis(RandomAngles(options_.direction_error_deg));
    return {turn * truth.rotation, tilt * truth.translation.normalized()};
  }

  Vec3 Noisy(const Vec3& point_in_cam) {
    const double s = options_.noise_px / kFocalPx;
    const double x = random_.Gaussian(s), y = random_.Gaussian(s);
    return point_in_cam / point_in_cam.z() + Vec3(x, y, 0);
  }

  bool IsWrong(int n, int count) const {
    return options_.pure_noise || n < options_.wrong_share * count;
  }

  void AddPoint(int n, TripletView* view) {
    const Vec3 x = room_.VisiblePoint(k_from_j_, true);
    const bool wrong = IsWrong(n, options_.num_points);
    const Vec3 x_i = options_.pure_noise ? room_.OtherDepth(x, i_from_j_) : x;
    const Vec3 x_k = wrong ? room_.OtherDepth(x, k_from_j_) : x;
    view->points.push_back({static_cast<FeatureIndex>(n),
                            Noisy(i_from_j_ * x_i), Noisy(x),
                            Noisy(k_from_j_ * x_k)});
  }

  // As one view sees it; the ends are broken off at random.
  ObservedSegment Observe(const RigidTransform& cam_from_camj,
                          const Segment3& segment) {
    const Vec3 along = segment.end - segment.start;
    const Vec3 start = segment.start + random_.Uniform(0, 0.15) * along;
    const Vec3 end = segment.end - random_.Uniform(0, 0.15) * along;
    const Vec3 start_seen = Noisy(cam_from_camj * start);
    return {MakeSegment(start_seen, Noisy(cam_from_camj * end)),
            std::max(options_.noise_px, 0.1)};
  }

  void AddLine(int n, TripletView* view) {
    const bool wrong = IsWrong(n, options_.num_lines);
    while (true) {
      const Segment3 segment = room_.RandomSegment(i_from_j_, true);
      if (!room_.IsVisible(k_from_j_ * segment.start) ||
          !room_.IsVisible(k_from_j_ * segment.end)) {
        continue;
      }
      const auto moved = [&](const RigidTransform& camn_from_camj) {
        return Segment3{room_.OtherDepth(segment.start, camn_from_camj),
                        room_.OtherDepth(segment.end, camn_from_camj), -1};
      };
      const Segment3 in_i = options_.pure_noise ? moved(i_from_j_) : segment;
      const Segment3 in_k = wrong ? moved(k_from_j_) : segment;
      TripletLine line;
      line.segment_in_middle = static_cast<FeatureIndex>(n);
      line.in_i = Observe(i_from_j_, in_i);
      line.in_j = Observe(RigidTransform(), segment);
      line.in_k = Observe(k_from_j_, in_k);
      view->lines.push_back(line);
      return;
    }
  }

  void AddMatchedLines(const RigidTransform& camn_from_camj, int count,
                       FeatureIndex* next_segment,
                       std::vector<MatchedLine>* lines,
                       std::vector<int>* walls) {
    for (int n = 0; n < count; ++n) {
      const Segment3 segment =
          room_.RandomSegment(camn_from_camj, !IsWrong(n, count));
      MatchedLine line;
      line.segment_in_middle = (*next_segment)++;
      line.in_middle = Observe(RigidTransform(), segment);
      line.in_neighbor = Observe(camn_from_camj, segment);
      lines->push_back(line);
      walls->push_back(segment.wall);
    }
  }

  SyntheticTripletOptions options_;
  Random random_;
  SyntheticRoom room_;
  const RigidTransform& i_from_j_ = room_.i_from_j();
  const RigidTransform& k_from_j_ = room_.k_from_j();
};

}  // namespace

SyntheticTriplet MakeSyntheticTriplet(const SyntheticTripletOptions& options,
                                      std::uint64_t seed) {
  return SyntheticTripletMaker(options, seed).Make();
}

TripletView SwapEnds(const TripletView& view) {
  TripletView swapped = view;
  swapped.views = {view.views.last, view.views.middle, view.views.first};
  swapped.geometry = view.geometry.Swapped();
  for (TripletPoint& point : swapped.points) std::swap(point.in_i, point.in_k);
  for (TripletLine& line : swapped.lines) std::swap(line.in_i, line.in_k);
  for (TripletGeometry& geometry : swapped.pose_perturbations) {
    geometry = geometry.Swapped();
  }
  std::swap(swapped.lines_ij, swapped.lines_jk);
  return swapped;
}

}  // namespace lowlap::testing
