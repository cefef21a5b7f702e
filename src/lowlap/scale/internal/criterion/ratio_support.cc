#include "lowlap/scale/internal/criterion/ratio_support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "lowlap/scale/evidence/internal/trifocal_line.h"
#include "lowlap/scale/evidence/internal/trifocal_point.h"

namespace lowlap {
namespace {

// Numbers lines in the order in which they come.
class LineRanks {
 public:
  explicit LineRanks(std::size_t num_lines) : rank_(num_lines, kNone) {}
  int Rank(int line) {
    if (rank_[line] == kNone) rank_[line] = size_++;
    return rank_[line];
  }
  int size() const { return size_; }

 private:
  static constexpr int kNone = -1;
  std::vector<int> rank_;
  int size_ = 0;
};

// kPairTiers: too far to be used.
int TierOfCrossing(double crossing_px, double image_diagonal_px) {
  int tier = 0;
  while (tier < kPairTiers &&
         crossing_px > kTierOfDiagonal[tier] * image_diagonal_px) {
    ++tier;
  }
  return tier;
}

}  // namespace

RatioSupport::RatioSupport(const TripletView& triplet,
                           const ScaleOptions& options)
    : coplanar_residual_(options.coplanar_residual) {
  if (options.use_points) AddPoints(triplet);
  if (options.use_lines) AddLines(triplet);
  if (options.use_coplanar) AddPairs(triplet);
  if (options.use_coplanar) AddPlanePoints(triplet);
  for (const FeatureKind kind : kFeatureKinds) {
    int index = 0;
    for (const RatioCandidate& ratio : Ratios(kind)) {
      hypotheses_.push_back(
          {ratio.log_ratio, ratio.log_ratio_stddev, kind, index++});
    }
  }
  std::sort(hypotheses_.begin(), hypotheses_.end(),
            [](const Hypothesis& a, const Hypothesis& b) {
              return std::tie(a.log_ratio, a.kind, a.index) <
                     std::tie(b.log_ratio, b.kind, b.index);
            });
}

void RatioSupport::AddPoints(const TripletView& triplet) {
  const TrifocalPointSolver solver(triplet.geometry);
  points_.Reserve(static_cast<int>(triplet.points.size()));
  for (std::size_t n = 0; n < triplet.points.size(); ++n) {
    const TrifocalPoint& point = triplet.points[n];
    RatioCandidate ratio;
    const auto midpoints = solver.Midpoints(point, &ratio.status);
    if (midpoints) ratio = solver.Ratio(point, *midpoints);
    num_rejected_negative_ += ratio.status == CandidateStatus::kNegativeDepth;
    if (ratio.status != CandidateStatus::kValid) continue;
    points_.Add(triplet.geometry, point, *midpoints, ratio.log_ratio);
    point_ratios_.push_back(ratio);
    point_of_.push_back(static_cast<int>(n));
  }
}

void RatioSupport::AddLines(const TripletView& triplet) {
  for (std::size_t n = 0; n < triplet.lines.size(); ++n) {
    const TrifocalLine& line = triplet.lines[n];
    const RatioCandidate ratio = TrifocalLineRatio(triplet.geometry, line);
    num_rejected_negative_ += ratio.status == CandidateStatus::kNegativeDepth;
    if (ratio.status != CandidateStatus::kValid) continue;
    lines_.Add(triplet.geometry, line, ratio.log_ratio);
    line_ratios_.push_back(ratio);
    line_of_.push_back(static_cast<int>(n));
  }
}

void RatioSupport::AddPairs(const TripletView& triplet) {
  num_rejected_negative_ += triplet.coplanar.num_rejected_negative;
  LineRanks first(triplet.lines_ij.size()), last(triplet.lines_jk.size());
  for (int tier = 0; tier < kPairTiers; ++tier) {
    for (const CoplanarPairCandidate& pair : triplet.coplanar.pairs) {
      if (TierOfCrossing(pair.crossing_px, triplet.image_diagonal_px) != tier) {
        continue;
      }
      const MatchedLine& a = triplet.lines_ij[pair.first];
      const MatchedLine& b = triplet.lines_jk[pair.last];
      if (coplanar_residual_ == CoplanarResidual::kPlane) {
        plane_.Add(triplet.geometry, a, b, pair.ratio.log_ratio);
      } else {
        transfer_.Add(triplet.geometry, a, b, pair.ratio.log_ratio);
      }
      pairs_.push_back(pair);
      pair_ratios_.push_back(pair.ratio);
      pair_first_.push_back(first.Rank(pair.first));
      pair_last_.push_back(last.Rank(pair.last));
    }
    tiers_[tier] = {num_pairs(), first.size(), last.size()};
  }
}

void RatioSupport::AddPlanePoints(const TripletView& triplet) {
  const TrifocalPointSolver solver(triplet.geometry);
  for (const PlanePoint& point : triplet.plane_points) {
    CandidateStatus status;
    plane_points_.Add(
        triplet.geometry, point.point,
        solver.Midpoints(point.point, &status).value_or(TrifocalMidpoints()),
        point.ratio.log_ratio);
    plane_point_ratios_.push_back(point.ratio);
  }
}

std::vector<double> RatioSupport::SortedLogRatios(FeatureKind kind,
                                                  int count) const {
  std::vector<double> sorted;
  sorted.reserve(count);
  for (const Hypothesis& hypothesis : hypotheses_) {
    if (hypothesis.kind == kind && hypothesis.index < count) {
      sorted.push_back(hypothesis.log_ratio);
    }
  }
  return sorted;
}

int RatioSupport::TierOfPair(int index) const {
  int tier = 0;
  while (index >= tiers_[tier].num_pairs) ++tier;
  return tier;
}

const std::vector<RatioCandidate>& RatioSupport::Ratios(
    FeatureKind kind) const {
  switch (kind) {
    case FeatureKind::kPoint:
      return point_ratios_;
    case FeatureKind::kLine:
      return line_ratios_;
    case FeatureKind::kCoplanar:
      return pair_ratios_;
    case FeatureKind::kPlanePoint:
      break;
  }
  return plane_point_ratios_;
}

void RatioSupport::Errors(FeatureKind kind, double log_ratio,
                          std::vector<float>* errors_px) const {
  const double tau = std::exp(log_ratio);
  errors_px->resize(Ratios(kind).size());
  if (errors_px->empty()) return;
  if (kind == FeatureKind::kPoint) {
    points_.Evaluate(tau, errors_px->data());
  } else if (kind == FeatureKind::kLine) {
    lines_.Evaluate(tau, errors_px->data());
  } else if (kind == FeatureKind::kPlanePoint) {
    plane_points_.Evaluate(tau, errors_px->data());
  } else {
    PairErrors(log_ratio, num_pairs(), errors_px->data());
  }
}

void RatioSupport::PairErrors(double log_ratio, int num_pairs,
                              float* errors_px) const {
  const double tau = std::exp(log_ratio);
  if (coplanar_residual_ == CoplanarResidual::kPlane) {
    plane_.Evaluate(tau, num_pairs, errors_px);
  } else {
    transfer_.Evaluate(tau, num_pairs, errors_px);
  }
}

float RatioSupport::ErrorOf(FeatureKind kind, int index, double tau) const {
  if (kind == FeatureKind::kPoint) return points_.ErrorOf(tau, index);
  if (kind == FeatureKind::kLine) return lines_.ErrorOf(tau, index);
  if (kind == FeatureKind::kPlanePoint) {
    return plane_points_.ErrorOf(tau, index);
  }
  return coplanar_residual_ == CoplanarResidual::kPlane
             ? plane_.ErrorOf(tau, index)
             : transfer_.ErrorOf(tau, index);
}

int RatioSupport::Turns(FeatureKind kind, int index, double* taus) const {
  if (kind == FeatureKind::kPoint) return points_.Turns(index, taus);
  if (kind == FeatureKind::kLine) return lines_.Turns(index, taus);
  if (kind == FeatureKind::kPlanePoint) return plane_points_.Turns(index, taus);
  return coplanar_residual_ == CoplanarResidual::kPlane
             ? plane_.Turns(index, taus)
             : transfer_.Turns(index, taus);
}

void RatioSupport::Bound(double low, double high, KindErrors* least_px,
                         KindErrors* most_px) const {
  const double tau_low = std::exp(low), tau_high = std::exp(high);
  for (const FeatureKind kind : kFeatureKinds) {
    const std::size_t n = static_cast<std::size_t>(kind);
    const std::size_t size = Ratios(kind).size();
    float* least = nullptr;
    float* most = nullptr;
    if (least_px != nullptr) {
      (*least_px)[n].resize(size);
      least = (*least_px)[n].data();
    }
    if (most_px != nullptr) {
      (*most_px)[n].resize(size);
      most = (*most_px)[n].data();
    }
    if (size == 0) continue;
    if (kind == FeatureKind::kPoint) {
      points_.Bound(tau_low, tau_high, least, most);
    } else if (kind == FeatureKind::kLine) {
      lines_.Bound(tau_low, tau_high, least, most);
    } else if (kind == FeatureKind::kPlanePoint) {
      plane_points_.Bound(tau_low, tau_high, least, most);
    } else if (coplanar_residual_ == CoplanarResidual::kPlane) {
      plane_.Bound(tau_low, tau_high, num_pairs(), least, most);
    } else {
      transfer_.Bound(tau_low, tau_high, num_pairs(), least, most);
    }
  }
}

SupportCounts RatioSupport::Count(const KindErrors& errors_px,
                                  SupportWorkspace* workspace) const {
  SupportCounts counts;
  counts.points = CountOnLadder(errors_px[0].data(), num_points());
  counts.lines = CountOnLadder(errors_px[1].data(), num_lines());
  counts.coplanar =
      CountPairErrors(errors_px[2].data(), kPairTiers - 1, workspace);
  counts.plane_points = CountOnLadder(errors_px[3].data(), num_plane_points());
  return counts;
}

SupportCounts RatioSupport::Count(double log_ratio,
                                  SupportWorkspace* workspace) const {
  SupportCounts counts;
  counts.points = CountPoints(log_ratio, workspace);
  counts.lines = CountLines(log_ratio, workspace);
  counts.coplanar = CountPairs(log_ratio, kPairTiers - 1, workspace);
  counts.plane_points = CountPlanePoints(log_ratio, workspace);
  return counts;
}

LadderCounts RatioSupport::CountPoints(double log_ratio,
                                       SupportWorkspace* workspace) const {
  Errors(FeatureKind::kPoint, log_ratio, &workspace->errors_px);
  return CountOnLadder(workspace->errors_px.data(), num_points());
}

LadderCounts RatioSupport::CountLines(double log_ratio,
                                      SupportWorkspace* workspace) const {
  Errors(FeatureKind::kLine, log_ratio, &workspace->errors_px);
  return CountOnLadder(workspace->errors_px.data(), num_lines());
}

LadderCounts RatioSupport::CountPlanePoints(double log_ratio,
                                            SupportWorkspace* workspace) const {
  Errors(FeatureKind::kPlanePoint, log_ratio, &workspace->errors_px);
  return CountOnLadder(workspace->errors_px.data(), num_plane_points());
}

std::array<PairCounts, kPairTiers> RatioSupport::CountPairs(
    double log_ratio, int last_tier, SupportWorkspace* workspace) const {
  const int num_pairs = tiers_[last_tier].num_pairs;
  if (num_pairs == 0) return {};
  workspace->errors_px.resize(num_pairs);
  PairErrors(log_ratio, num_pairs, workspace->errors_px.data());
  return CountPairErrors(workspace->errors_px.data(), last_tier, workspace);
}

std::array<PairCounts, kPairTiers> RatioSupport::CountPairErrors(
    const float* errors_px, int last_tier, SupportWorkspace* workspace) const {
  std::array<PairCounts, kPairTiers> counts{};
  const PairTier& all = tiers_[last_tier];
  if (all.num_pairs == 0) return counts;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  workspace->least_first_px.assign(all.num_first, kInfinity);
  workspace->least_last_px.assign(all.num_last, kInfinity);
  float* const least_first = workspace->least_first_px.data();
  float* const least_last = workspace->least_last_px.data();
  int pair = 0;
  for (int tier = 0; tier <= last_tier; ++tier) {
    for (; pair < tiers_[tier].num_pairs; ++pair) {
      float& first = least_first[pair_first_[pair]];
      float& last = least_last[pair_last_[pair]];
      first = std::min(first, errors_px[pair]);
      last = std::min(last, errors_px[pair]);
    }
    counts[tier].first = CountOnLadder(least_first, tiers_[tier].num_first);
    counts[tier].last = CountOnLadder(least_last, tiers_[tier].num_last);
  }
  return counts;
}

}  // namespace lowlap
