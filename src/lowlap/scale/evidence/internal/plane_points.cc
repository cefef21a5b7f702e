#include "lowlap/scale/evidence/internal/plane_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lowlap/core/internal/union_find.h"
#include "lowlap/scale/evidence/internal/residual_evidence.h"
#include "lowlap/scale/evidence/internal/triplet_points.h"
#include "lowlap/scale/internal/candidate_limits.h"

namespace lowlap {
namespace {

constexpr double kAgree = 2.5;
constexpr int kMinSamples = 2;

// What one sample says, with the plane of the other pair below it.
struct Vote {
  Vec3 ray = Vec3::UnitZ();
  double log_quotient = 0;  // of the sample's inverse depth to the plane's
  double stddev = 0;        // of the sample alone
  int other_plane = PairPlanes::kNoPlane;  // that of the sample
};

bool Agree(const Vote& a, const Vote& b) {
  return std::abs(a.log_quotient - b.log_quotient) <=
         kAgree * std::hypot(a.stddev, b.stddev);
}

std::vector<std::vector<Vote>> VotesByPlane(const PairPlanes& planes,
                                            const PairPlanes& others) {
  std::vector<std::vector<Vote>> votes(planes.planes.size());
  for (std::size_t n = 0; n < others.samples.size(); ++n) {
    const DepthSample& sample = others.samples[n];
    if (planes.Matches(sample)) continue;
    const int index = planes.PlaneAt(sample.ray);
    if (index == PairPlanes::kNoPlane) continue;
    const PairPlane& plane = planes.planes[index];
    const double inverse_depth = plane.InverseDepth(sample.ray);
    if (!(inverse_depth > 0)) continue;
    const double stddev = sample.stddev / sample.inverse_depth;
    if (!(std::hypot(stddev, plane.Stddev(sample.ray) / inverse_depth) <=
          kMaxPlaneLogRatioStddev)) {
      continue;
    }
    votes[index].push_back({sample.ray,
                            std::log(sample.inverse_depth / inverse_depth),
                            stddev, others.plane_of_sample[n]});
  }
  return votes;
}

// The largest set of votes that agree with one of them; of equal ones, around
// the surest.
std::vector<Vote> LargestAgreement(const std::vector<Vote>& votes) {
  std::vector<Vote> best;
  double best_stddev = 0;
  for (const Vote& center : votes) {
    std::vector<Vote> set;
    for (const Vote& vote : votes) {
      if (Agree(center, vote)) set.push_back(vote);
    }
    if (set.size() > best.size() ||
        (set.size() == best.size() && center.stddev < best_stddev)) {
      best = std::move(set);
      best_stddev = center.stddev;
    }
  }
  return best;
}

// The place, with the logarithm of the other pair's inverse depth over that of
// the plane.
struct Place {
  Vec3 ray = Vec3::UnitZ();
  double log_quotient = 0;
  double stddev = 0;
};

Place Join(const std::vector<Vote>& votes, const PairPlane& plane) {
  double weights = 0, sum = 0;
  Vec2 rays = Vec2::Zero();
  for (const Vote& vote : votes) {
    const double weight = 1.0 / (vote.stddev * vote.stddev);
    weights += weight;
    sum += weight * vote.log_quotient;
    rays += weight * vote.ray.head<2>();
  }
  Place place;
  place.log_quotient = sum / weights;
  place.ray.head<2>() = rays / weights;
  double squares = 0;
  for (const Vote& vote : votes) {
    const double residual =
        (vote.log_quotient - place.log_quotient) / vote.stddev;
    squares += residual * residual;
  }
  const double scatter =
      std::max(1.0, squares / std::max<double>(1.0, votes.size() - 1.0));
  place.stddev =
      std::hypot(std::sqrt(scatter / weights),
                 plane.Stddev(place.ray) / plane.InverseDepth(place.ray));
  return place;
}

// The plane that most of the votes lie on, if any do.
int OtherPlane(const std::vector<Vote>& votes, std::size_t num_planes) {
  std::vector<int> counts(num_planes, 0);
  int best = PairPlanes::kNoPlane;
  for (const Vote& vote : votes) {
    const int plane = vote.other_plane;
    if (plane == PairPlanes::kNoPlane) continue;
    ++counts[plane];
    if (best == PairPlanes::kNoPlane || counts[plane] > counts[best]) {
      best = plane;
    }
  }
  return best;
}

Vec3 Transfer(const RigidTransform& camn_from_camj, const Vec3& ray,
              double inverse_depth) {
  const Vec3 y = camn_from_camj.rotation * ray +
                 inverse_depth * camn_from_camj.translation;
  return y / y.z();
}

void AddPlanePoints(const TripletGeometry& geometry, const PairPlanes& planes,
                    const PairPlanes& others, bool plane_is_first,
                    std::vector<PlanePoint>* points) {
  const std::vector<std::vector<Vote>> by_plane = VotesByPlane(planes, others);
  for (std::size_t n = 0; n < by_plane.size(); ++n) {
    const std::vector<Vote> votes = LargestAgreement(by_plane[n]);
    if (static_cast<int>(votes.size()) < kMinSamples ||
        2 * votes.size() <= by_plane[n].size()) {
      continue;
    }
    const Place place = Join(votes, planes.planes[n]);
    const double of_plane = planes.planes[n].InverseDepth(place.ray);
    const double of_samples = of_plane * std::exp(place.log_quotient);
    if (!(of_plane > 0) || !(place.stddev <= kMaxPlaneLogRatioStddev)) {
      continue;
    }
    PlanePoint point;
    point.point.in_j = place.ray;
    point.point.in_i = Transfer(geometry.cami_from_camj, place.ray,
                                plane_is_first ? of_plane : of_samples);
    point.point.in_k = Transfer(geometry.camk_from_camj, place.ray,
                                plane_is_first ? of_samples : of_plane);
    point.ratio.status = CandidateStatus::kValid;
    point.ratio.log_ratio =
        plane_is_first ? place.log_quotient : -place.log_quotient;
    point.ratio.log_ratio_stddev = place.stddev;
    point.plane_is_first = plane_is_first;
    point.plane = static_cast<int>(n);
    point.other_plane = OtherPlane(votes, others.planes.size());
    point.num_samples = static_cast<int>(votes.size());
    points->push_back(point);
  }
}

class PlanePoints : public ResidualEvidence<PointResiduals> {
 public:
  PlanePoints(const TripletView& triplet,
              const std::vector<PlanePoint>& points) {
    const TripletPointSolver solver(triplet.geometry);
    for (const PlanePoint& point : points) {
      if (!AddCandidate(point.ratio)) continue;
      points_.push_back(point);
      CandidateStatus status;
      residuals_.Add(
          triplet.geometry, point.point,
          solver.Midpoints(point.point, &status).value_or(TripletMidpoints()),
          point.ratio.log_ratio);
    }
  }

  double NumTests() const override { return size(); }
  int MinAgreeing() const override { return 3; }

 protected:
  CandidateDetail DetailOf(const TripletView&, int n) const override {
    return {points_[n].point.in_j.head<2>(), {}};
  }
  RatioCandidate RatioIn(const TripletView&, const TripletGeometry& geometry,
                         int n) const override {
    return TripletPointSolver(geometry).Ratio(points_[n].point);
  }

 private:
  std::vector<PlanePoint> points_;
};

}  // namespace

std::vector<PlanePoint> FindPlanePoints(const TripletGeometry& geometry,
                                        const PairPlanes& planes_ij,
                                        const PairPlanes& planes_jk) {
  std::vector<PlanePoint> all;
  AddPlanePoints(geometry, planes_ij, planes_jk, true, &all);
  AddPlanePoints(geometry, planes_jk, planes_ij, false, &all);
  // Planes of both pairs that lie on each other are one surface.
  const std::size_t num_first = planes_ij.planes.size();
  UnionFind surfaces(num_first + planes_jk.planes.size());
  const auto node = [&](bool is_first, int plane) {
    return (is_first ? 0 : num_first) + static_cast<std::size_t>(plane);
  };
  for (const PlanePoint& point : all) {
    if (point.other_plane == PairPlanes::kNoPlane) continue;
    surfaces.Union(node(point.plane_is_first, point.plane),
                   node(!point.plane_is_first, point.other_plane));
  }
  const auto surface_of = [&](const PlanePoint& point) {
    return surfaces.Find(node(point.plane_is_first, point.plane));
  };
  std::map<std::size_t, std::size_t> surest;  // by surface
  for (std::size_t n = 0; n < all.size(); ++n) {
    const auto [it, is_new] = surest.emplace(surface_of(all[n]), n);
    if (!is_new && all[n].ratio.log_ratio_stddev <
                       all[it->second].ratio.log_ratio_stddev) {
      it->second = n;
    }
  }
  std::vector<PlanePoint> points;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (surest[surface_of(all[n])] == n) points.push_back(all[n]);
  }
  return points;
}

std::unique_ptr<Evidence> PlanePointsKind::Gather(
    const TripletView& triplet) const {
  const ViewTriplet& views = triplet.views;
  const auto ij = planes_.find({views.middle, views.first});
  const auto jk = planes_.find({views.middle, views.last});
  if (ij == planes_.end() || jk == planes_.end()) return nullptr;
  return std::make_unique<PlanePoints>(
      triplet, FindPlanePoints(triplet.geometry, ij->second, jk->second));
}

bool PlanePointsKind::MaySpeak(const SceneFeatures& scene,
                               const ViewTriplet& views) const {
  return PairsOverlap(scene, views);
}

Result<std::shared_ptr<const EvidenceKind>> PlanePointsKind::Prepare(
    const SceneFeatures& scene, const std::vector<ViewTriplet>& triplets,
    const RunContext& context) const {
  auto planes = FindPlanesByPair(scene, triplets, context);
  if (!planes) return tl::unexpected<Error>(planes.error());
  return std::make_shared<const PlanePointsKind>(std::move(*planes));
}

}  // namespace lowlap
