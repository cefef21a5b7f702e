#include "lowlap/adjustment/internal/structure/line_track.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// Rays that meet the line at less than 3 degrees do not tell where.
constexpr double kMinRaySine = 0.05;

struct Interval {
  double low = kInfinity;
  double high = -kInfinity;

  void Include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool IsEmpty() const { return !(low < high); }
};

struct SpaceLine {
  Vec3 point;
  Vec3 direction;
};

// A segment in a posed camera.
struct LineMeasurement {
  RigidTransform cam_from_world;
  const SegmentRays* rays = nullptr;
  double weight = 1;
};

std::vector<LineMeasurement> Measurements(const CameraSet& cameras,
                                          const LineTrackState& track,
                                          const std::vector<char>& used) {
  std::vector<LineMeasurement> measurements;
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (!used[n]) continue;
    const LineCandidate& candidate = track.candidates[n];
    measurements.push_back({cameras.PoseOf(candidate.view).CamFromWorld(),
                            &candidate.rays, candidate.weight});
  }
  return measurements;
}

// Half the sum of squared end point distances (px^2), with J^T J and J^T r by
// the unknowns of LineEstimate.
struct LineNormalEquations {
  Eigen::Matrix4d hessian = Eigen::Matrix4d::Zero();
  Vec4 gradient = Vec4::Zero();
  double cost = 0;

  LineNormalEquations(const std::vector<LineMeasurement>& measurements,
                      const SpaceLine& line) {
    const Eigen::Matrix<double, 3, 2> basis = TangentBasis(line.direction);
    for (const LineMeasurement& measurement : measurements) {
      const Mat3& rotation = measurement.cam_from_world.rotation;
      const Vec3 arm = line.point - measurement.cam_from_world.Center();
      const Vec3 normal = rotation * arm.cross(line.direction);
      Eigen::Matrix<double, 3, 4> by_unknowns;
      by_unknowns.leftCols<2>() =
          -rotation * CrossMatrix(line.direction) * basis;
      by_unknowns.rightCols<2>() = rotation * CrossMatrix(arm) * basis;
      for (const EndPointRay& end : measurement.rays->ends) {
        Eigen::RowVector3d by_normal;
        const double residual =
            measurement.weight * EndPointDistancePx(end, normal, &by_normal);
        const Eigen::RowVector4d row =
            measurement.weight * by_normal * by_unknowns;
        hessian += row.transpose() * row;
        gradient += row.transpose() * residual;
        cost += 0.5 * residual * residual;
      }
    }
  }
};

// Levenberg-Marquardt; never makes the sum larger.
SpaceLine RefineLine(const std::vector<LineMeasurement>& measurements,
                     SpaceLine line) {
  constexpr int kIterations = 20;
  double damping = 1e-6;
  LineNormalEquations equations(measurements, line);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix4d damped = equations.hessian;
    damped.diagonal() *= 1 + damping;
    const Vec4 step = -damped.ldlt().solve(equations.gradient);
    if (!step.allFinite()) break;
    const Eigen::Matrix<double, 3, 2> basis = TangentBasis(line.direction);
    const SpaceLine next_line{
        line.point + basis * step.head<2>(),
        (line.direction + basis * step.tail<2>()).normalized()};
    const LineNormalEquations next(measurements, next_line);
    if (!(next.cost <= equations.cost)) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    const bool settled = equations.cost - next.cost <= 1e-12 * equations.cost;
    line = next_line;
    equations = next;
    damping *= 0.1;
    if (settled) break;
  }
  return line;
}

// Where on the line the viewing ray of an end point passes, from the line's
// point; nullopt for a ray along the line. `depth` is that along the ray.
std::optional<double> Lift(const RigidTransform& cam_from_world,
                           const Vec3& ray_in_cam, const SpaceLine& line,
                           double min_sine, double* depth) {
  const Vec3 ray = (cam_from_world.rotation.transpose() * ray_in_cam);
  const Vec3 unit_ray = ray.normalized();
  const Vec3 n = unit_ray.cross(line.direction);
  const double n2 = n.squaredNorm();
  if (!(n2 > min_sine * min_sine)) return std::nullopt;
  const Vec3 arm = line.point - cam_from_world.Center();
  // Closest points of center + z ray and point + s direction.
  *depth = arm.cross(line.direction).dot(n) / n2;
  return arm.cross(unit_ray).dot(n) / n2;
}

double SegmentDistancePx(const CameraSet& cameras,
                         const LineCandidate& candidate,
                         const SpaceLine& line) {
  const RigidTransform cam_from_world =
      cameras.PoseOf(candidate.view).CamFromWorld();
  const Vec3 normal =
      cam_from_world.rotation *
      (line.point - cam_from_world.Center()).cross(line.direction);
  double squares = 0;
  for (const EndPointRay& end : candidate.rays.ends) {
    const double distance = EndPointDistancePx(end, normal, nullptr);
    squares += distance * distance;
    double depth = 1;
    Lift(cam_from_world, end.ray, line, 1e-6, &depth);
    if (!(depth > 0)) return kInfinity;
  }
  const double distance_px = std::sqrt(0.5 * squares);
  return std::isfinite(distance_px) ? distance_px : kInfinity;
}

double SegmentErrorPx(const CameraSet& cameras, const LineCandidate& candidate,
                      const SpaceLine& line) {
  return candidate.weight * SegmentDistancePx(cameras, candidate, line);
}

// For FitLandmark.
class LineModel {
 public:
  using Place = SpaceLine;
  static constexpr bool kAllEndSearch = false;

  LineModel(const CameraSet& cameras, const LineTrackState& track)
      : cameras_(cameras), track_(track) {}

  std::size_t size() const { return track_.candidates.size(); }
  // Whether a pair of segments determines no line.
  bool is_degenerate() const { return is_degenerate_; }

  double ErrorPx(std::size_t n, const SpaceLine& line) const {
    return SegmentErrorPx(cameras_, track_.candidates[n], line);
  }

  // The line of two interpretation planes, with its point amid the first
  // segment.
  std::optional<SpaceLine> FromPair(std::size_t first, std::size_t second) {
    const LineCandidate& a = track_.candidates[first];
    const LineCandidate& b = track_.candidates[second];
    if (cameras_.views[a.view].pose == cameras_.views[b.view].pose) {
      return std::nullopt;
    }
    const RigidTransform world_from_a =
        cameras_.PoseOf(a.view).CamFromWorld().Inverse();
    const std::optional<PluckerLine> line =
        LineFromTwoViews(cameras_.PoseOf(b.view).CamFromWorld() * world_from_a,
                         a.rays.normal, b.rays.normal, 1e-6);
    if (line) {
      const std::optional<Vec3> in_a = ClosestPointToRay(
          *line,
          a.rays.ends[0].ray.normalized() + a.rays.ends[1].ray.normalized(),
          1e-6);
      if (in_a) {
        const SpaceLine in_world{world_from_a * *in_a,
                                 world_from_a.rotation * line->direction};
        if (in_world.point.allFinite() && in_world.direction.allFinite()) {
          return in_world;
        }
      }
    }
    is_degenerate_ = true;
    return std::nullopt;
  }

  std::optional<SpaceLine> Refine(const std::vector<char>& used,
                                  const SpaceLine& line) const {
    return RefineLine(Measurements(cameras_, track_, used), line);
  }

 private:
  const CameraSet& cameras_;
  const LineTrackState& track_;
  bool is_degenerate_ = false;
};

// Share of the shorter of the two extents (one per pose) that both cover.
double TwoViewOverlap(const CameraSet& cameras, const LineTrackState& track) {
  std::map<int, Interval> extents;
  for (const LineCandidate& candidate : track.candidates) {
    if (!candidate.used) continue;
    Interval& extent = extents[cameras.views[candidate.view].pose];
    for (const EndPointRay& end : candidate.rays.ends) {
      double depth;
      const std::optional<double> at =
          Lift(cameras.PoseOf(candidate.view).CamFromWorld(), end.ray,
               {track.point, track.direction}, 1e-6, &depth);
      if (at) extent.Include(*at);
    }
  }
  if (extents.size() != 2) return 1;
  const Interval &a = extents.begin()->second, &b = extents.rbegin()->second;
  if (a.IsEmpty() || b.IsEmpty()) return 0;
  const double common = std::min(a.high, b.high) - std::max(a.low, b.low);
  return common / std::min(a.high - a.low, b.high - b.low);
}

// Two of the unknowns are lengths in the unit of the world, two are angles:
// each is measured by what it alone would do.
std::optional<Eigen::Matrix4d> UnitCovariance(
    const std::vector<LineMeasurement>& measurements, const SpaceLine& line) {
  const Eigen::Matrix4d hessian =
      LineNormalEquations(measurements, line).hessian;
  const Vec4 units = hessian.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(
      units.asDiagonal() * hessian * units.asDiagonal());
  if (!(eigen.eigenvalues()(0) > 1e-15 * eigen.eigenvalues()(3))) {
    return std::nullopt;
  }
  const Eigen::Matrix4d half =
      units.asDiagonal() * eigen.eigenvectors() *
      eigen.eigenvalues().cwiseInverse().cwiseSqrt().asDiagonal();
  return Eigen::Matrix4d(half * half.transpose());
}

// Standard deviation of the line across itself, over the distance from the
// nearest camera, at the worse end of its extent.
double RelativeLineStddev(const std::vector<LineMeasurement>& measurements,
                          const LineTrackState& track, double noise_px) {
  const std::optional<Eigen::Matrix4d> covariance =
      UnitCovariance(measurements, {track.point, track.direction});
  if (!covariance) return kInfinity;
  double worst = 0;
  for (const double at : {track.low, track.high}) {
    Eigen::Matrix<double, 2, 4> across;
    across << Mat2::Identity(), at * Mat2::Identity();
    const Mat2 spread = across * *covariance * across.transpose();
    const double variance =
        Eigen::SelfAdjointEigenSolver<Mat2>(spread, Eigen::EigenvaluesOnly)
            .eigenvalues()(1);
    double distance = kInfinity;
    for (const LineMeasurement& measurement : measurements) {
      distance = std::min(distance, (measurement.cam_from_world *
                                     (track.point + at * track.direction))
                                        .norm());
    }
    worst = std::max(worst, noise_px * std::sqrt(variance) / distance);
  }
  return std::isfinite(worst) ? worst : kInfinity;
}

}  // namespace

double DistancePx(const CameraSet& cameras, const LineTrackState& track,
                  const LineCandidate& candidate) {
  return SegmentDistancePx(cameras, candidate, {track.point, track.direction});
}

double ErrorPx(const CameraSet& cameras, const LineTrackState& track,
               const LineCandidate& candidate) {
  return SegmentErrorPx(cameras, candidate, {track.point, track.direction});
}

std::optional<LineEstimate> EstimateFromSegments(const CameraSet& cameras,
                                                 const LineTrackState& track) {
  const std::vector<LineMeasurement> measurements =
      Measurements(cameras, track, track.Used());
  const SpaceLine line =
      RefineLine(measurements, {track.point, track.direction});
  const std::optional<Eigen::Matrix4d> covariance =
      UnitCovariance(measurements, line);
  if (!covariance) return std::nullopt;
  return LineEstimate{line.point, line.direction, *covariance};
}

void UpdateLineExtent(const CameraSet& cameras, LineTrackState* track) {
  track->direction.normalize();
  Interval extent;
  for (const double min_sine : {kMinRaySine, 1e-6}) {
    for (const LineCandidate& candidate : track->candidates) {
      if (!candidate.used) continue;
      for (const EndPointRay& end : candidate.rays.ends) {
        double depth;
        const std::optional<double> at =
            Lift(cameras.PoseOf(candidate.view).CamFromWorld(), end.ray,
                 {track->point, track->direction}, min_sine, &depth);
        if (at && depth > 0) extent.Include(*at);
      }
    }
    if (!extent.IsEmpty()) break;
  }
  if (extent.IsEmpty()) extent = {0, 0};
  const double middle = 0.5 * (extent.low + extent.high);
  track->point += middle * track->direction;
  track->low = extent.low - middle;
  track->high = extent.high - middle;
}

void Triangulate(const CameraSet& cameras, const TriangulationLimits& limits,
                 LineTrackState* track) {
  track->Use(std::vector<char>(track->candidates.size(), 1));
  if (track->PoseCount(cameras) < 2) {
    return track->Abandon(LandmarkStatus::kTooFewViews);
  }
  LineModel model(cameras, *track);
  Agreement agreement;
  const std::optional<SpaceLine> line =
      FitLandmark(track->id.value(), limits.threshold_px, &model, &agreement);
  if (!line) {
    return track->Abandon(model.is_degenerate() ? LandmarkStatus::kUncertain
                          : model.size() > 2    ? LandmarkStatus::kInconsistent
                                             : LandmarkStatus::kBehindCamera);
  }
  track->Use(agreement.used);
  const std::size_t pose_count = track->PoseCount(cameras);
  if (pose_count < 2) return track->Abandon(LandmarkStatus::kInconsistent);
  track->point = line->point;
  track->direction = line->direction;
  UpdateLineExtent(cameras, track);
  track->status = LandmarkStatus::kLandmark;
  if (!(RelativeLineStddev(Measurements(cameras, *track, agreement.used),
                           *track, limits.noise_px) <=
        limits.max_relative_depth_stddev)) {
    track->Abandon(LandmarkStatus::kUncertain);
  } else if (pose_count == 2 && !(TwoViewOverlap(cameras, *track) >=
                                  limits.min_two_view_overlap)) {
    track->Abandon(LandmarkStatus::kImplausible);
  }
}

}  // namespace lowlap
