#include "lowlap/scale/ratio_support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "lowlap/scale/trifocal_line.h"
#include "lowlap/scale/trifocal_point.h"

namespace lowlap {
namespace {

// Ranks of the values that occur in `line_of_pair`, and how often each does.
std::vector<int> RankLines(const std::vector<int>& line_of_pair, int num_lines,
                           std::vector<int>* rank_of_pair) {
  std::vector<int> occurrences(num_lines, 0);
  for (const int line : line_of_pair) ++occurrences[line];
  std::vector<int> rank(num_lines, 0);
  std::vector<int> partners;
  for (int line = 0; line < num_lines; ++line) {
    if (occurrences[line] == 0) continue;
    rank[line] = static_cast<int>(partners.size());
    partners.push_back(occurrences[line]);
  }
  rank_of_pair->clear();
  for (const int line : line_of_pair) rank_of_pair->push_back(rank[line]);
  return partners;
}

}  // namespace

RatioSupport::RatioSupport(const TripletView& triplet,
                           const ScaleOptions& options)
    : coplanar_residual_(options.coplanar_residual) {
  if (options.use_points) AddPoints(triplet);
  if (options.use_lines) AddLines(triplet);
  if (options.use_coplanar) AddPairs(triplet);
  for (const FeatureKind kind :
       {FeatureKind::kPoint, FeatureKind::kLine, FeatureKind::kCoplanar}) {
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
  for (std::size_t n = 0; n < triplet.points.size(); ++n) {
    const TrifocalPoint& point = triplet.points[n];
    const RatioCandidate ratio = TrifocalPointRatio(triplet.geometry, point);
    num_rejected_negative_ += ratio.status == CandidateStatus::kNegativeDepth;
    if (ratio.status != CandidateStatus::kValid) continue;
    points_.Add(triplet.geometry, point, ratio.log_ratio);
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
  std::vector<int> first, last;
  for (const CoplanarPairCandidate& pair : triplet.coplanar.pairs) {
    const MatchedLine& a = triplet.lines_ij[pair.first];
    const MatchedLine& b = triplet.lines_jk[pair.last];
    if (coplanar_residual_ == CoplanarResidual::kPlane) {
      plane_.Add(triplet.geometry, a, b, pair.ratio.log_ratio);
    } else {
      transfer_.Add(triplet.geometry, a, b, pair.ratio.log_ratio);
    }
    pairs_.push_back(pair);
    pair_ratios_.push_back(pair.ratio);
    first.push_back(pair.first);
    last.push_back(pair.last);
  }
  partners_ =
      RankLines(first, static_cast<int>(triplet.lines_ij.size()), &pair_first_);
  partners_last_ =
      RankLines(last, static_cast<int>(triplet.lines_jk.size()), &pair_last_);
}

const std::vector<RatioCandidate>& RatioSupport::Ratios(
    FeatureKind kind) const {
  return kind == FeatureKind::kPoint  ? point_ratios_
         : kind == FeatureKind::kLine ? line_ratios_
                                      : pair_ratios_;
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
  } else if (coplanar_residual_ == CoplanarResidual::kPlane) {
    plane_.Evaluate(tau, errors_px->data());
  } else {
    transfer_.Evaluate(tau, errors_px->data());
  }
}

SupportCounts RatioSupport::Count(double log_ratio,
                                  SupportWorkspace* workspace) const {
  SupportCounts counts;
  CountInto(FeatureKind::kPoint, log_ratio, workspace, &counts);
  CountInto(FeatureKind::kLine, log_ratio, workspace, &counts);
  CountInto(FeatureKind::kCoplanar, log_ratio, workspace, &counts);
  return counts;
}

SupportCounts RatioSupport::CountKind(FeatureKind kind, double log_ratio,
                                      SupportWorkspace* workspace) const {
  SupportCounts counts;
  CountInto(kind, log_ratio, workspace, &counts);
  return counts;
}

void RatioSupport::CountInto(FeatureKind kind, double log_ratio,
                             SupportWorkspace* workspace,
                             SupportCounts* counts) const {
  Errors(kind, log_ratio, &workspace->errors_px);
  const float* const errors_px = workspace->errors_px.data();
  if (workspace->errors_px.empty()) return;
  if (kind == FeatureKind::kPoint) {
    counts->points = CountOnLadder(errors_px, num_points());
  } else if (kind == FeatureKind::kLine) {
    counts->lines = CountOnLadder(errors_px, num_lines());
  } else {
    CountCoplanar(workspace, counts);
  }
}

void RatioSupport::CountCoplanar(SupportWorkspace* workspace,
                                 SupportCounts* counts) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  workspace->least_first_px.assign(partners_.size(), kInfinity);
  workspace->least_last_px.assign(partners_last_.size(), kInfinity);
  float* const least_first = workspace->least_first_px.data();
  float* const least_last = workspace->least_last_px.data();
  for (int pair = 0; pair < num_pairs(); ++pair) {
    const float error_px = workspace->errors_px[pair];
    float& first = least_first[pair_first_[pair]];
    float& last = least_last[pair_last_[pair]];
    first = std::min(first, error_px);
    last = std::min(last, error_px);
  }
  counts->coplanar_first = CountOnLadder(least_first, num_coplanar_first());
  counts->coplanar_last = CountOnLadder(least_last, num_coplanar_last());
}

}  // namespace lowlap
