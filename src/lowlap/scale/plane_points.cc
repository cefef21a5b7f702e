#include "lowlap/scale/plane_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace lowlap {
namespace {

constexpr double kAgree = 2.5;
constexpr int kMinSamples = 2;
constexpr double kSeparationOfDiagonal = 1.0 / 8;

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
          kMaxCoplanarLogRatioStddev)) {
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

// The votes around up to three places that are `separation` apart from each
// other, the third also from the line through the first two.
std::vector<std::vector<Vote>> Split(const std::vector<Vote>& votes,
                                     double separation) {
  const auto farthest = [&](const auto& distance) {
    return *std::max_element(votes.begin(), votes.end(),
                             [&](const Vote& a, const Vote& b) {
                               return distance(a) < distance(b);
                             });
  };
  Vec3 mean = Vec3::Zero();
  for (const Vote& vote : votes) mean += vote.ray / votes.size();
  std::vector<Vec3> anchors;
  const auto add = [&](const auto& distance) {
    const Vote vote = farthest(distance);
    if (distance(vote) >= separation) anchors.push_back(vote.ray);
  };
  anchors.push_back(
      farthest([&](const Vote& v) { return (v.ray - mean).norm(); }).ray);
  add([&](const Vote& v) { return (v.ray - anchors[0]).norm(); });
  if (anchors.size() == 2) {
    const Vec3 along = (anchors[1] - anchors[0]).normalized();
    add([&](const Vote& v) {
      return (v.ray - anchors[0]).cross(along).norm();
    });
  }
  std::vector<std::vector<Vote>> groups(anchors.size());
  for (const Vote& vote : votes) {
    const auto nearest = std::min_element(
        anchors.begin(), anchors.end(), [&](const Vec3& a, const Vec3& b) {
          return (vote.ray - a).squaredNorm() < (vote.ray - b).squaredNorm();
        });
    groups[nearest - anchors.begin()].push_back(vote);
  }
  return groups;
}

// The point of a group of votes, if most of them agree.
std::optional<PlanePoint> PointOf(const TripletGeometry& geometry,
                                  const std::vector<Vote>& group,
                                  const PairPlane& plane, bool plane_is_first) {
  const std::vector<Vote> votes = LargestAgreement(group);
  if (static_cast<int>(votes.size()) < kMinSamples ||
      2 * votes.size() <= group.size()) {
    return std::nullopt;
  }
  const Place place = Join(votes, plane);
  const double of_plane = plane.InverseDepth(place.ray);
  const double of_samples = of_plane * std::exp(place.log_quotient);
  if (!(of_plane > 0) || !(place.stddev <= kMaxCoplanarLogRatioStddev)) {
    return std::nullopt;
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
  point.num_samples = static_cast<int>(votes.size());
  point.num_lying_on = static_cast<int>(group.size());
  return point;
}

// The points of one plane, with the surest standard deviation.
struct PointsOfPlane {
  std::vector<PlanePoint> points;
  double stddev = std::numeric_limits<double>::infinity();

  bool BetterThan(const PointsOfPlane& other) const {
    return points.size() != other.points.size()
               ? points.size() > other.points.size()
               : stddev < other.stddev;
  }
};

void AddPlanePoints(const TripletGeometry& geometry, const PairPlanes& planes,
                    const PairPlanes& others, bool plane_is_first,
                    double separation, std::vector<PointsOfPlane>* result) {
  const std::vector<std::vector<Vote>> by_plane = VotesByPlane(planes, others);
  for (std::size_t n = 0; n < by_plane.size(); ++n) {
    if (by_plane[n].empty()) continue;
    PointsOfPlane of_plane;
    for (const std::vector<Vote>& group : Split(by_plane[n], separation)) {
      std::optional<PlanePoint> point =
          PointOf(geometry, group, planes.planes[n], plane_is_first);
      if (!point) continue;
      point->plane = static_cast<int>(n);
      point->other_plane = OtherPlane(by_plane[n], others.planes.size());
      of_plane.stddev =
          std::min(of_plane.stddev, point->ratio.log_ratio_stddev);
      of_plane.points.push_back(*point);
    }
    if (!of_plane.points.empty()) result->push_back(std::move(of_plane));
  }
}

// Unites the planes of both pairs that lie on each other.
class Surfaces {
 public:
  Surfaces(const PairPlanes& planes_ij, const PairPlanes& planes_jk)
      : num_first_(static_cast<int>(planes_ij.planes.size())),
        parent_(planes_ij.planes.size() + planes_jk.planes.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  void Unite(const PlanePoint& point) {
    if (point.other_plane == PairPlanes::kNoPlane) return;
    parent_[Of(point)] = Root(Node(!point.plane_is_first, point.other_plane));
  }
  int Of(const PlanePoint& point) {
    return Root(Node(point.plane_is_first, point.plane));
  }

 private:
  int Node(bool is_first, int plane) const {
    return is_first ? plane : num_first_ + plane;
  }
  int Root(int node) const {
    while (parent_[node] != node) node = parent_[node];
    return node;
  }

  int num_first_;
  std::vector<int> parent_;
};

}  // namespace

std::vector<PlanePoint> FindPlanePoints(const TripletGeometry& geometry,
                                        const PairPlanes& planes_ij,
                                        const PairPlanes& planes_jk,
                                        double image_diagonal_px) {
  const double separation =
      kSeparationOfDiagonal * image_diagonal_px / geometry.focal_j_px;
  std::vector<PointsOfPlane> all;
  AddPlanePoints(geometry, planes_ij, planes_jk, true, separation, &all);
  AddPlanePoints(geometry, planes_jk, planes_ij, false, separation, &all);
  Surfaces surfaces(planes_ij, planes_jk);
  for (const PointsOfPlane& plane : all) surfaces.Unite(plane.points.front());
  std::map<int, const PointsOfPlane*> best;  // by surface
  for (const PointsOfPlane& plane : all) {
    const auto [it, is_new] =
        best.emplace(surfaces.Of(plane.points.front()), &plane);
    if (!is_new && plane.BetterThan(*it->second)) it->second = &plane;
  }
  std::vector<PlanePoint> points;
  for (const PointsOfPlane& plane : all) {
    if (best[surfaces.Of(plane.points.front())] != &plane) continue;
    points.insert(points.end(), plane.points.begin(), plane.points.end());
  }
  return points;
}

}  // namespace lowlap
