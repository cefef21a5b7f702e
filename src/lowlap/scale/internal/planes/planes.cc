#include "lowlap/scale/internal/planes/planes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr int kNumNeighbors = 8;
constexpr std::array<double, 3> kThresholdsPx = {0.5, 1, 2};
constexpr int kPlaneSize = 3;  // samples that determine a plane

double ResidualPx(const DepthSample& sample, const Vec3& parameters) {
  return sample.speed_px *
         std::abs(sample.inverse_depth - parameters.dot(sample.ray));
}

bool IsLeft(const DepthSample& a, const DepthSample& b) {
  return std::tie(a.ray.x(), a.ray.y(), a.is_line, a.inverse_depth, a.feature) <
         std::tie(b.ray.x(), b.ray.y(), b.is_line, b.inverse_depth, b.feature);
}

// What a detector finds twice at one place, as one blob with two orientations,
// and matches twice: two features that err together.
bool AreOneMatch(const DepthSample& a, const DepthSample& b) {
  return a.ray == b.ray && a.inverse_depth == b.inverse_depth &&
         a.is_line == b.is_line;
}

// The `count` nearest samples of a place, without one of them, the nearest
// first; ties by index. The samples are sorted by x, so that the search ends
// on either side where that difference alone is too large.
std::vector<int> Nearest(const std::vector<DepthSample>& samples,
                         const Vec3& ray, int count, int skipped) {
  std::vector<std::pair<double, int>> nearest;  // sorted
  nearest.reserve(count + 1);
  const auto is_too_far = [&](int n) {
    const double dx = samples[n].ray.x() - ray.x();
    return static_cast<int>(nearest.size()) == count &&
           dx * dx > nearest.back().first;
  };
  const auto consider = [&](int n) {
    if (n == skipped) return;
    const std::pair<double, int> candidate{(samples[n].ray - ray).squaredNorm(),
                                           n};
    const bool is_full = static_cast<int>(nearest.size()) == count;
    if (is_full && nearest.back() <= candidate) return;
    if (is_full) nearest.pop_back();
    nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), candidate),
                   candidate);
  };
  const int num_samples = static_cast<int>(samples.size());
  int right =
      static_cast<int>(std::partition_point(samples.begin(), samples.end(),
                                            [&](const DepthSample& s) {
                                              return s.ray.x() < ray.x();
                                            }) -
                       samples.begin());
  int left = right - 1;
  while (left >= 0 || right < num_samples) {
    if (left >= 0) {
      is_too_far(left) ? static_cast<void>(left = -1) : consider(left--);
    }
    if (right < num_samples) {
      is_too_far(right) ? static_cast<void>(right = num_samples)
                        : consider(right++);
    }
  }
  std::vector<int> indices;
  indices.reserve(nearest.size());
  for (const auto& [distance, index] : nearest) indices.push_back(index);
  return indices;
}

double Turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Counter-clockwise (Andrew's monotone chain).
std::vector<Vec2> ConvexHull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vec2> hull;
  const auto add = [&](const Vec2& point, std::size_t begin) {
    while (hull.size() >= begin + 2 &&
           Turn(hull[hull.size() - 2], hull.back(), point) <= 0) {
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const Vec2& point : points) add(point, 0);
  const std::size_t upper = hull.size() - 1;
  for (auto it = points.rbegin() + 1; it != points.rend(); ++it) {
    add(*it, upper);
  }
  hull.pop_back();
  return hull;
}

bool IsInside(const std::vector<Vec2>& hull, const Vec2& point) {
  for (std::size_t n = 0; n < hull.size(); ++n) {
    if (Turn(hull[n], hull[(n + 1) % hull.size()], point) < 0) return false;
  }
  return hull.size() > 2;
}

class PlaneSearch {
 public:
  explicit PlaneSearch(PairPlanes* result)
      : result_(result), samples_(result->samples) {
    const int num_samples = static_cast<int>(samples_.size());
    std::vector<double> disparities_px;
    for (int n = 0; n < num_samples; ++n) {
      neighbors_.push_back(
          Nearest(samples_, samples_[n].ray, kNumNeighbors, n));
      disparities_px.push_back(samples_[n].inverse_depth *
                               samples_[n].speed_px);
    }
    std::sort(disparities_px.begin(), disparities_px.end());
    largest_disparity_px_ = disparities_px[num_samples * 19 / 20];
  }

  void Run() {
    for (const int seed : Seeds()) {
      if (result_->plane_of_sample[seed] != PairPlanes::kNoPlane) continue;
      PairPlane best;
      for (const double threshold_px : kThresholdsPx) {
        PairPlane plane;
        if (Grow(seed, threshold_px, &plane) &&
            plane.log10_nfa < best.log10_nfa) {
          best = std::move(plane);
        }
      }
      if (!(best.log10_nfa < 0)) continue;
      std::vector<Vec2> rays;
      rays.reserve(best.samples.size());
      for (const int n : best.samples) {
        rays.emplace_back(samples_[n].ray.head<2>());
        result_->plane_of_sample[n] = static_cast<int>(result_->planes.size());
      }
      best.hull = ConvexHull(std::move(rays));
      result_->planes.push_back(std::move(best));
    }
  }

 private:
  bool IsFree(int n) const {
    return result_->plane_of_sample[n] == PairPlanes::kNoPlane;
  }

  // Robust weighted least squares of rho = p . x; false if the samples do not
  // determine a plane.
  bool Fit(const std::vector<int>& inliers, PairPlane* plane) const {
    constexpr int kIterations = 3;
    constexpr double kCauchy = 2.0;  // in standard deviations
    if (static_cast<int>(inliers.size()) <= kPlaneSize) return false;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Mat3 information = Mat3::Zero();
      Vec3 right = Vec3::Zero();
      double squares = 0, weights = 0;
      for (const int n : inliers) {
        const DepthSample& sample = samples_[n];
        const double precision = 1.0 / sample.stddev;
        const double residual =
            iteration == 0 ? 0.0
                           : precision * (sample.inverse_depth -
                                          plane->InverseDepth(sample.ray));
        const double robust =
            1.0 / (1.0 + residual * residual / (kCauchy * kCauchy));
        const double weight = robust * precision * precision;
        information += weight * sample.ray * sample.ray.transpose();
        right += weight * sample.inverse_depth * sample.ray;
        squares += robust * residual * residual;
        weights += robust;
      }
      const Eigen::LDLT<Mat3> solver(information);
      if (solver.info() != Eigen::Success ||
          !(solver.vectorD().minCoeff() > 1e-9 * solver.vectorD().maxCoeff())) {
        return false;
      }
      plane->parameters = solver.solve(right);
      if (iteration + 1 < kIterations) continue;
      const double excess = squares / std::max(1.0, weights - kPlaneSize);
      plane->covariance =
          std::max(1.0, excess) * solver.solve(Mat3::Identity());
    }
    return plane->parameters.allFinite() && plane->covariance.allFinite();
  }

  // The samples whose surroundings fit a plane best go first.
  std::vector<int> Seeds() const {
    std::vector<std::pair<double, int>> order;
    for (int n = 0; n < static_cast<int>(samples_.size()); ++n) {
      PairPlane plane;
      if (!Fit(WithNeighbors(n), &plane)) continue;
      std::vector<double> residuals_px;
      for (const int m : neighbors_[n]) {
        residuals_px.push_back(ResidualPx(samples_[m], plane.parameters));
      }
      const auto middle = residuals_px.begin() + residuals_px.size() * 3 / 4;
      std::nth_element(residuals_px.begin(), middle, residuals_px.end());
      if (!(*middle <= kThresholdsPx.back())) continue;
      order.emplace_back(*middle, n);
    }
    std::sort(order.begin(), order.end());
    std::vector<int> seeds;
    seeds.reserve(order.size());
    for (const auto& [residual_px, n] : order) seeds.push_back(n);
    return seeds;
  }

  std::vector<int> WithNeighbors(int n) const {
    std::vector<int> all = {n};
    for (const int m : neighbors_[n]) {
      if (IsFree(m)) all.push_back(m);
    }
    return all;
  }

  // Inliers connected to the seed, and the size of their surroundings.
  std::vector<int> Connected(int seed, const PairPlane& plane,
                             double threshold_px, int* num_around) const {
    std::vector<bool> seen(samples_.size(), false);
    std::vector<int> inliers;
    std::vector<int> queue = {seed};
    seen[seed] = true;
    *num_around = 0;
    while (!queue.empty()) {
      const int n = queue.back();
      queue.pop_back();
      ++*num_around;
      if (!IsFree(n) ||
          !(ResidualPx(samples_[n], plane.parameters) <= threshold_px)) {
        continue;
      }
      inliers.push_back(n);
      for (const int m : neighbors_[n]) {
        if (seen[m]) continue;
        seen[m] = true;
        queue.push_back(m);
      }
    }
    std::sort(inliers.begin(), inliers.end());
    return inliers;
  }

  bool Grow(int seed, double threshold_px, PairPlane* plane) const {
    constexpr int kRounds = 5;
    if (!Fit(WithNeighbors(seed), plane)) return false;
    int num_around = 0;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<int> inliers =
          Connected(seed, *plane, threshold_px, &num_around);
      if (inliers == plane->samples) break;
      plane->samples = std::move(inliers);
      if (!Fit(plane->samples, plane)) return false;
    }
    const int k = static_cast<int>(plane->samples.size());
    const double alpha =
        std::min(1.0, 2.0 * threshold_px / largest_disparity_px_);
    plane->threshold_px = threshold_px;
    plane->log10_nfa = std::log10(static_cast<double>(samples_.size() *
                                                      kThresholdsPx.size())) +
                       Log10Binomial(num_around - kPlaneSize, k - kPlaneSize) +
                       (k - kPlaneSize) * std::log10(alpha);
    return k > kPlaneSize;
  }

  PairPlanes* result_;
  const std::vector<DepthSample>& samples_;
  std::vector<std::vector<int>> neighbors_;
  double largest_disparity_px_ = 1;
};

std::vector<DepthSample> Thinned(std::vector<DepthSample> samples) {
  if (samples.size() <= kMaxPlaneSamples) return samples;
  std::vector<DepthSample> thinned;
  for (std::size_t n = 0; n < kMaxPlaneSamples; ++n) {
    thinned.push_back(samples[n * samples.size() / kMaxPlaneSamples]);
  }
  return thinned;
}

}  // namespace

double PairPlane::Stddev(const Vec3& ray) const {
  return std::sqrt(std::max(0.0, ray.dot(covariance * ray)));
}

bool PairPlanes::Matches(const DepthSample& sample) const {
  return std::binary_search(matched.begin(), matched.end(),
                            std::make_pair(sample.is_line, sample.feature));
}

int PairPlanes::PlaneAt(const Vec3& ray) const {
  constexpr int kNearest = 4, kNeeded = 3;
  const bool is_inside_any =
      std::any_of(planes.begin(), planes.end(), [&](const PairPlane& plane) {
        return IsInside(plane.hull, ray.head<2>());
      });
  if (!is_inside_any) return kNoPlane;
  const std::vector<int> nearest = Nearest(samples, ray, kNearest, -1);
  for (const int n : nearest) {
    const int plane = plane_of_sample[n];
    const auto num_on_plane =
        std::count_if(nearest.begin(), nearest.end(),
                      [&](int m) { return plane_of_sample[m] == plane; });
    if (plane != kNoPlane && num_on_plane >= kNeeded) {
      return IsInside(planes[plane].hull, ray.head<2>()) ? plane : kNoPlane;
    }
  }
  return kNoPlane;
}

PairPlanes FindPlanes(std::vector<DepthSample> samples) {
  PairPlanes result;
  for (const DepthSample& sample : samples) {
    result.matched.emplace_back(sample.is_line, sample.feature);
  }
  std::sort(result.matched.begin(), result.matched.end());
  // Sorted before they are thinned, so that their order does not matter.
  std::sort(samples.begin(), samples.end(), IsLeft);
  samples.erase(std::unique(samples.begin(), samples.end(), AreOneMatch),
                samples.end());
  result.samples = Thinned(std::move(samples));
  result.plane_of_sample.assign(result.samples.size(), PairPlanes::kNoPlane);
  if (static_cast<int>(result.samples.size()) > kPlaneSize) {
    PlaneSearch(&result).Run();
  }
  return result;
}

}  // namespace lowlap
