#include "lowlap/adjustment/internal/planes/facet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <utility>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/robust/internal/nfa.h"

namespace lowlap {
namespace {

constexpr int kNumThicknesses = 9;
constexpr double kThickest = 1.0 / 128;  // of the scene's reach
constexpr double kMemberReach = 3;       // deviations
constexpr int kNumHypotheses = 400;
constexpr std::size_t kMinMembers = 4;  // any three are on one

struct PlaneScore {
  double log10_nfa = 0;
  double thickness = 0;

  bool operator<(const PlaneScore& other) const {
    return log10_nfa < other.log10_nfa;
  }
};

// The places of some landmarks side by side; a point counts as a line whose
// ends are the same.
class PlaceTable {
 public:
  PlaceTable(const std::vector<FreeLandmark>& landmarks,
             const std::vector<int>& group) {
    const auto count = static_cast<Eigen::Index>(group.size());
    for (int end = 0; end < 2; ++end) {
      points_[end].resize(count, 3);
      covariances_[end].resize(count, 6);
      for (Eigen::Index n = 0; n < count; ++n) {
        const auto& places = landmarks[group[n]].places;
        const FreePlace& place = end == 0 ? places.front() : places.back();
        const Mat3& c = place.covariance;
        points_[end].row(n) = place.point;
        covariances_[end].row(n) << c(0, 0), c(1, 1), c(2, 2), 2 * c(0, 1),
            2 * c(0, 2), 2 * c(1, 2);
      }
    }
  }

  // Squares of AcrossPlane's distances and deviations.
  void Across(const Plane& plane, Eigen::ArrayXd* squared_distance,
              Eigen::ArrayXd* variance) const {
    const Vec3& n = plane.normal;
    Eigen::Matrix<double, 6, 1> products;
    products << n.x() * n.x(), n.y() * n.y(), n.z() * n.z(), n.x() * n.y(),
        n.x() * n.z(), n.y() * n.z();
    const auto squared = [&](int end) {
      return ((points_[end] * n).array() - plane.offset).square();
    };
    *squared_distance = squared(0).max(squared(1));
    *variance = (covariances_[0] * products)
                    .array()
                    .max((covariances_[1] * products).array());
  }

 private:
  std::array<Eigen::Matrix<double, Eigen::Dynamic, 3>, 2> points_;
  std::array<Eigen::Matrix<double, Eigen::Dynamic, 6>, 2> covariances_;
};

// How many of the thicknesses, each half of the one before it, have a square of
// at least `square`; that of the first is given. The bits of positive numbers
// are ordered as these are, and a factor of two is one in the exponent.
int TimesWithin(double square, double thickest_square) {
  constexpr int kMantissaBits = 52;
  square = std::max(0.0, square);  // a variance may be rounded to less
  std::int64_t bits, thickest_bits;
  std::memcpy(&bits, &square, sizeof(bits));
  std::memcpy(&thickest_bits, &thickest_square, sizeof(thickest_bits));
  const std::int64_t last = (thickest_bits - bits) >> (kMantissaBits + 1);
  return static_cast<int>(
      std::clamp<std::int64_t>(last + 1, 0, kNumThicknesses));
}

class FacetFinder {
 public:
  FacetFinder(const std::vector<FreeLandmark>& landmarks,
              const std::vector<int>& group, const SceneReach& reach,
              Random random)
      : landmarks_(landmarks),
        group_(group),
        reach_(reach),
        table_(landmarks, group),
        taken_(group.size(), 0),
        factorials_(static_cast<int>(group.size())) {
    for (int n = 0; n < kNumHypotheses; ++n) Draw(&random);
  }

  // Members only become fewer, and a score hardly ever better: one that is
  // computed anew and still the least is taken for the least of all.
  std::vector<Facet> Run() {
    std::vector<PlaneScore> scores;
    for (const Hypothesis& hypothesis : hypotheses_) {
      scores.push_back(ScoreOf(hypothesis));
    }
    std::vector<Facet> facets;
    while (true) {
      const auto best = std::min_element(scores.begin(), scores.end());
      if (best == scores.end() || !(best->log10_nfa < 0)) break;
      const Hypothesis& hypothesis = hypotheses_[best - scores.begin()];
      const PlaneScore again = ScoreOf(hypothesis);
      if (again.log10_nfa > best->log10_nfa) {
        *best = again;
        continue;
      }
      *best = {};
      Facet facet;
      if (Fit(hypothesis.plane, again, &facet)) {
        facets.push_back(std::move(facet));
      }
    }
    return facets;
  }

 private:
  struct Hypothesis {
    std::array<std::uint32_t, 3> drawn;  // indices into the group
    Plane plane;
    double reach = 0;
  };

  void Draw(Random* random) {
    const auto count = static_cast<std::uint32_t>(group_.size());
    Hypothesis hypothesis;
    std::array<Vec3, 3> centers;
    for (std::size_t n = 0; n < 3; ++n) {
      hypothesis.drawn[n] = random->Index(count);
      centers[n] = landmarks_[group_[hypothesis.drawn[n]]].Center();
    }
    const Vec3 normal =
        (centers[1] - centers[0]).cross(centers[2] - centers[0]);
    if (!(normal.norm() > 0)) return;
    hypothesis.plane.normal = normal.normalized();
    hypothesis.plane.offset = hypothesis.plane.normal.dot(centers[0]);
    hypothesis.reach = reach_.Along(hypothesis.plane.normal);
    hypotheses_.push_back(hypothesis);
  }

  PlaneScore ScoreOf(const Hypothesis& hypothesis) {
    PlaneScore best;
    for (const std::uint32_t n : hypothesis.drawn) {
      if (taken_[n] != 0) return best;
    }
    table_.Across(hypothesis.plane, &squared_distance_, &variance_);
    double thickness = kThickest * hypothesis.reach;
    const Counts counts = Count(thickness * thickness);
    const double log10_tests =
        std::log10(static_cast<double>(kNumHypotheses * kNumThicknesses));
    for (int step = 0; step < kNumThicknesses; ++step, thickness *= 0.5) {
      const int n = counts.known[step], k = counts.near[step];
      if (k <= 3) continue;
      const double log10_nfa =
          log10_tests +
          Log10ChanceOfSet(factorials_, n - 3, k - 3,
                           std::log10(4 * thickness / hypothesis.reach));
      if (log10_nfa < best.log10_nfa) best = {log10_nfa, thickness};
    }
    return best;
  }

  // Of those left, whose deviations across the plane are within each
  // thickness, and of these, who are within two of it.
  struct Counts {
    std::array<int, kNumThicknesses> known{}, near{};
  };

  Counts Count(double thickest_square) const {
    Counts counts;  // at first of the last thickness only
    for (std::size_t l = 0; l < taken_.size(); ++l) {
      if (taken_[l] != 0) continue;
      const auto index = static_cast<Eigen::Index>(l);
      const int known = TimesWithin(variance_[index], thickest_square);
      if (known == 0) continue;
      ++counts.known[known - 1];
      const int near = std::min(
          known, TimesWithin(squared_distance_[index], 4 * thickest_square));
      if (near > 0) ++counts.near[near - 1];
    }
    for (int step = kNumThicknesses - 1; step > 0; --step) {
      counts.known[step - 1] += counts.known[step];
      counts.near[step - 1] += counts.near[step];
    }
    return counts;
  }

  // Fits the plane to its members and takes them; false if too few are left.
  bool Fit(Plane plane, const PlaneScore& score, Facet* facet) {
    double thickness = score.thickness;
    std::vector<const FreeLandmark*> members;
    std::vector<std::size_t> indices;
    constexpr int kRounds = 5;
    for (int round = 0; round < kRounds; ++round) {
      members.clear();
      indices.clear();
      for (std::size_t n = 0; n < group_.size(); ++n) {
        if (taken_[n] != 0) continue;
        const FreeLandmark& landmark = landmarks_[group_[n]];
        const Across across = AcrossPlane(landmark, plane);
        if (across.stddev <= score.thickness &&
            std::abs(across.distance) <=
                kMemberReach * std::hypot(across.stddev, thickness)) {
          members.push_back(&landmark);
          indices.push_back(n);
        }
      }
      if (members.size() < kMinMembers) return false;
      plane = FitPlane(members, plane, thickness);
      thickness = std::min(score.thickness, PlaneThickness(members, plane));
    }
    facet->plane = plane;
    facet->thickness = thickness;
    facet->log10_nfa = score.log10_nfa;
    for (const std::size_t n : indices) {
      facet->members.push_back(group_[n]);
      facet->center += landmarks_[group_[n]].Center();
      taken_[n] = 1;
    }
    facet->center /= static_cast<double>(members.size());
    return true;
  }

  const std::vector<FreeLandmark>& landmarks_;
  const std::vector<int>& group_;
  const SceneReach& reach_;
  PlaceTable table_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<char> taken_;
  LogFactorials factorials_;
  Eigen::ArrayXd squared_distance_, variance_;
};

}  // namespace

Result<std::vector<Facet>> FindFacets(
    const std::vector<FreeLandmark>& landmarks, const SceneReach& reach,
    const RunContext& context) {
  std::map<std::pair<int, int>, std::vector<int>> by_pair;
  for (std::size_t n = 0; n < landmarks.size(); ++n) {
    const std::vector<int>& poses = landmarks[n].poses;
    for (auto a = poses.begin(); a != poses.end(); ++a) {
      for (auto b = std::next(a); b != poses.end(); ++b) {
        by_pair[{*a, *b}].push_back(static_cast<int>(n));
      }
    }
  }
  using Group = decltype(by_pair)::value_type;
  std::vector<const Group*> groups;
  for (const Group& group : by_pair) {
    if (group.second.size() >= kMinMembers) groups.push_back(&group);
  }
  std::vector<std::vector<Facet>> found(groups.size());
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, {}, groups.size(), [&](std::size_t n) {
        const auto& [poses, members] = *groups[n];
        found[n] = FacetFinder(landmarks, members, reach,
                               Random(static_cast<std::uint64_t>(poses.first),
                                      static_cast<std::uint64_t>(poses.second)))
                       .Run();
      }));
  std::vector<Facet> facets;
  for (std::vector<Facet>& of_pair : found) {
    std::move(of_pair.begin(), of_pair.end(), std::back_inserter(facets));
  }
  std::stable_sort(
      facets.begin(), facets.end(),
      [](const Facet& a, const Facet& b) { return a.log10_nfa < b.log10_nfa; });
  return facets;
}

}  // namespace lowlap
