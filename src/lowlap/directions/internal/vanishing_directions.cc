#include "lowlap/directions/internal/vanishing_directions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {
namespace {

// Pairs of this many long segments propose directions.
constexpr std::size_t kProposers = 80;
constexpr std::size_t kNumThresholds = 3;
constexpr std::array<double, kNumThresholds> kThresholds = {0.5, 1.0, 2.0};
constexpr std::size_t kMinSegments = 3;
// The midpoint of a segment is no vanishing point of it.
constexpr double kLeastSine = 1e-9;

struct Segment {
  int index;
  Vec3 moment;  // a x b
  Vec3 middle;
  double length_px;
  Vec3 normal;  // unit
};

Segment MakeSegment(int index, const NormalizedSegment& s, double focal_px) {
  return {index, s.start.cross(s.end), 0.5 * (s.start + s.end),
          focal_px * (s.end - s.start).norm(), s.normal};
}

// d error / d (d . moment), in pixels; 0 if the midpoint is the vanishing
// point.
double Gain(const Segment& s, const Vec3& direction, double focal_px) {
  const double norm = s.middle.cross(direction).head<2>().norm();
  return norm > kLeastSine ? 0.5 * focal_px / norm : 0;
}

// +infinity for a segment whose midpoint is the vanishing point.
double ErrorPx(const Segment& s, const Vec3& direction, double focal_px) {
  const double gain = Gain(s, direction, focal_px);
  return gain > 0 ? gain * s.moment.dot(direction)
                  : std::numeric_limits<double>::infinity();
}

// The least-squares direction of segments, robust, from the given one on.
class DirectionFit {
 public:
  DirectionFit(const Vec3& start, double focal_px,
               const VanishingOptions& options)
      : direction_(start), focal_px_(focal_px), options_(options) {}

  const Vec3& direction() const { return direction_; }

  // One step of iterated reweighting.
  void Step(const std::vector<const Segment*>& members) {
    const double parallel_rad = RadFromDeg(options_.parallel_stddev_deg);
    information_.setZero();
    std::vector<double> deviations;
    for (const Segment* s : members) {
      const double gain = Gain(*s, direction_, focal_px_);
      const double parallel_px = gain * s->moment.norm() * parallel_rad;
      const double variance =
          options_.end_point_stddev_px * options_.end_point_stddev_px +
          parallel_px * parallel_px;
      const double r = gain * s->moment.dot(direction_) / std::sqrt(variance);
      deviations.push_back(std::abs(r));
      const double x = r / (2 * scatter_);
      information_ += gain * gain / variance / ((1 + x * x) * (1 + x * x)) *
                      s->moment * s->moment.transpose();
    }
    scatter_ = std::max(1.0, Median(deviations) / kMedianOfNorm<1>);
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(information_);
    direction_ = solver.eigenvectors().col(0);
  }

  // In the tangent plane; the common error of lines that people build parallel
  // does not average out.
  Mat3 Covariance() const {
    const auto basis = TangentBasis(direction_);
    const double parallel_rad = RadFromDeg(options_.parallel_stddev_deg);
    const Mat2 tangent =
        scatter_ * scatter_ *
            (basis.transpose() * information_ * basis + 1e-6 * Mat2::Identity())
                .inverse() +
        2 * parallel_rad * parallel_rad * Mat2::Identity();
    return basis * tangent * basis.transpose();
  }

 private:
  Vec3 direction_;
  double focal_px_;
  VanishingOptions options_;
  Mat3 information_ = Mat3::Zero();
  double scatter_ = 1;
};

// Segments side by side, each with the greatest errors that are parallel.
struct SegmentTable {
  Eigen::Matrix<double, Eigen::Dynamic, 3> moments, middles;
  std::array<Eigen::ArrayXd, kNumThresholds> squared_limits;

  explicit SegmentTable(Eigen::Index count)
      : moments(count, 3), middles(count, 3) {
    for (Eigen::ArrayXd& limits : squared_limits) limits.resize(count);
  }

  // How many segments are parallel to a direction, at each threshold: ErrorPx
  // without roots and quotients.
  std::array<std::int64_t, kNumThresholds> CountParallel(
      const Vec3& direction) const {
    const Vec3& d = direction;
    const Eigen::ArrayXd squared_moment = (moments * d).array().square();
    const Eigen::ArrayXd squared_norm =
        (middles.col(1) * d.z() - middles.col(2) * d.y()).array().square() +
        (middles.col(2) * d.x() - middles.col(0) * d.z()).array().square();
    std::array<std::int64_t, kNumThresholds> counts{};
    for (std::size_t t = 0; t < kNumThresholds; ++t) {
      std::int64_t count = 0;
      for (Eigen::Index n = 0; n < squared_norm.size(); ++n) {
        const double norm = squared_norm[n];
        const bool is_parallel =
            squared_moment[n] <= squared_limits[t][n] * norm &&
            norm > kLeastSine * kLeastSine;
        count += is_parallel ? 1 : 0;
      }
      counts[t] = count;
    }
    return counts;
  }
};

class Finder {
 public:
  Finder(const NormalizedFeatures& features, const VanishingOptions& options,
         double pixel_unit)
      : options_(options),
        focal_px_(features.focal_px),
        max_sine_(std::sin(RadFromDeg(options.max_angle_deg))) {
    for (std::size_t t = 0; t < kNumThresholds; ++t) {
      thresholds_px_[t] = kThresholds[t] * pixel_unit;
    }
    for (std::size_t n = 0; n < features.segments.size(); ++n) {
      const NormalizedSegment& s = features.segments[n];
      if (!s.IsValid()) continue;
      segments_.push_back(MakeSegment(static_cast<int>(n), s, focal_px_));
    }
    std::stable_sort(segments_.begin(), segments_.end(),
                     [](const Segment& a, const Segment& b) {
                       return a.length_px > b.length_px;
                     });
    free_.resize(segments_.size());
    std::iota(free_.begin(), free_.end(), std::size_t{0});
  }

  std::optional<VanishingDirection> Next() {
    while (const std::optional<Candidate> candidate = BestCandidate()) {
      const std::size_t num_free = free_.size();
      VanishingDirection found = Fit(*candidate);
      if (found.segments.size() >= kMinSegments) return found;
      if (free_.size() == num_free) break;
    }
    return std::nullopt;
  }

 private:
  struct Candidate {
    Vec3 direction = Vec3::Zero();
    double log10_nfa = 0;
  };

  // The one of least NFA, if it is meaningful.
  std::optional<Candidate> BestCandidate() const {
    const std::size_t count =
        std::min(free_.size(), static_cast<std::size_t>(options_.max_segments));
    const std::size_t proposers = std::min(count, kProposers);
    if (count < kMinSegments) return std::nullopt;
    const double log10_tests =
        std::log10(0.5 * static_cast<double>(proposers * (proposers - 1)) *
                   kNumThresholds);
    // Mean chance of the segments at each threshold.
    double alpha[kNumThresholds] = {};
    for (std::size_t t = 0; t < kNumThresholds; ++t) {
      for (std::size_t n = 0; n < count; ++n) {
        alpha[t] += 2 / kPi *
                    std::asin(MaxSine(segments_[free_[n]], thresholds_px_[t])) /
                    static_cast<double>(count);
      }
    }
    const SegmentTable table = MakeTable(count);
    Candidate best;
    // The more, the less likely by chance.
    std::array<std::int64_t, kNumThresholds> most;
    most.fill(kMinSegments - 1);
    for (std::size_t i = 0; i < proposers; ++i) {
      for (std::size_t j = i + 1; j < proposers; ++j) {
        const Vec3 crossing =
            segments_[free_[i]].normal.cross(segments_[free_[j]].normal);
        const double norm = crossing.norm();
        if (norm < 1e-3) continue;  // collinear: any direction fits both
        const Vec3 direction = crossing / norm;
        const auto inliers = table.CountParallel(direction);
        for (std::size_t t = 0; t < kNumThresholds; ++t) {
          if (inliers[t] <= most[t]) continue;
          most[t] = inliers[t];
          const double nfa =
              log10_tests + Log10Tail(count - 2,
                                      static_cast<std::size_t>(inliers[t] - 2),
                                      alpha[t]);
          if (nfa < best.log10_nfa) best = {direction, nfa};
        }
      }
    }
    if (!(best.log10_nfa < 0)) return std::nullopt;
    return best;
  }

  // Of the longest free segments.
  SegmentTable MakeTable(std::size_t count) const {
    SegmentTable table(static_cast<Eigen::Index>(count));
    for (std::size_t n = 0; n < count; ++n) {
      const Segment& s = segments_[free_[n]];
      const auto row = static_cast<Eigen::Index>(n);
      table.moments.row(row) = s.moment;
      table.middles.row(row) = s.middle;
      for (std::size_t t = 0; t < kNumThresholds; ++t) {
        const double limit =
            MaxSine(s, thresholds_px_[t]) * s.length_px / focal_px_;
        table.squared_limits[t][row] = limit * limit;
      }
    }
    return table;
  }

  // Greatest sine of the turn that keeps the error within the threshold.
  double MaxSine(const Segment& s, double threshold_px) const {
    return std::min(max_sine_, 2 * threshold_px / s.length_px);
  }

  bool IsParallel(const Segment& s, double error_px,
                  double threshold_px) const {
    return 2 * error_px <= MaxSine(s, threshold_px) * s.length_px;
  }

  // Chernoff's bound of log10 P(at least k of n events of mean chance alpha).
  static double Log10Tail(std::size_t n, std::size_t k, double alpha) {
    const double share = static_cast<double>(k) / static_cast<double>(n);
    if (share <= alpha) return 0;
    double divergence = share * std::log(share / alpha);
    if (share < 1) {
      divergence += (1 - share) * std::log((1 - share) / (1 - alpha));
    }
    return -static_cast<double>(n) * divergence / std::log(10.0);
  }

  // Takes its segments out of the search: those of the fit or, where too few
  // are left for one, those that the candidate attracted, which would bring it
  // back for ever.
  VanishingDirection Fit(const Candidate& candidate) {
    DirectionFit fit(candidate.direction, focal_px_, options_);
    std::vector<std::size_t> members, attracted;
    for (int iteration = 0; iteration < 10; ++iteration) {
      members.clear();
      std::vector<const Segment*> support;
      for (const std::size_t n : free_) {
        const Segment& s = segments_[n];
        const double error_px =
            std::abs(ErrorPx(s, fit.direction(), focal_px_));
        if (!IsParallel(s, error_px, thresholds_px_.back())) continue;
        members.push_back(n);
        support.push_back(&s);
      }
      if (iteration == 0) attracted = members;
      if (members.size() < kMinSegments) break;
      fit.Step(support);
    }
    VanishingDirection result;
    result.direction = fit.direction();
    result.covariance = fit.Covariance();
    result.log10_nfa = candidate.log10_nfa;
    for (const std::size_t n : members) {
      result.segments.push_back(segments_[n].index);
    }
    std::sort(result.segments.begin(), result.segments.end());
    const auto& taken = members.size() < kMinSegments ? attracted : members;
    std::vector<std::size_t> rest;
    std::set_difference(free_.begin(), free_.end(), taken.begin(), taken.end(),
                        std::back_inserter(rest));
    free_ = std::move(rest);
    return result;
  }

  VanishingOptions options_;
  double focal_px_;
  double max_sine_;
  std::array<double, kNumThresholds> thresholds_px_;
  std::vector<Segment> segments_;  // from long to short
  std::vector<std::size_t> free_;  // not yet part of a direction, ascending
};

}  // namespace

Mat3 WidenedCovariance(const VanishingDirection& direction, double stddev_rad) {
  const Mat3 across =
      Mat3::Identity() - direction.direction * direction.direction.transpose();
  return direction.covariance + stddev_rad * stddev_rad * across;
}

std::vector<VanishingDirection> FindVanishingDirections(
    const NormalizedFeatures& features, const VanishingOptions& options,
    double pixel_unit) {
  std::vector<VanishingDirection> directions;
  Finder finder(features, options, pixel_unit);
  while (static_cast<int>(directions.size()) < options.max_directions) {
    std::optional<VanishingDirection> next = finder.Next();
    if (!next) break;
    directions.push_back(std::move(*next));
  }
  return directions;
}

VanishingDirection FitDirection(const NormalizedFeatures& features,
                                const std::vector<int>& segments,
                                const Vec3& start,
                                const VanishingOptions& options) {
  std::vector<Segment> members;
  members.reserve(segments.size());
  for (const int n : segments) {
    members.push_back(MakeSegment(n, features.segments[n], features.focal_px));
  }
  std::vector<const Segment*> support;
  support.reserve(members.size());
  for (const Segment& s : members) support.push_back(&s);
  DirectionFit fit(start, features.focal_px, options);
  for (int iteration = 0; iteration < 10; ++iteration) fit.Step(support);
  return {fit.direction(), fit.Covariance(), segments, 0};
}

}  // namespace lowlap
