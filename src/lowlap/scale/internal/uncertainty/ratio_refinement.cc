#include "lowlap/scale/internal/uncertainty/ratio_refinement.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lowlap/scale/internal/uncertainty/ratio_variance.h"

namespace lowlap {
namespace {

// Features of one group that come in a row.
struct Run {
  int group = 0;
  Eigen::Index begin = 0;
  Eigen::Index size = 0;

  auto Of(const Eigen::ArrayXd& values) const {
    return values.segment(begin, size);
  }
  Eigen::Map<Eigen::ArrayXd> Of(std::vector<double>* values) const {
    return {values->data() + begin, size};
  }
};

class MixtureFit {
 public:
  MixtureFit(const std::vector<RatioFeature>& features,
             const std::vector<RatioGroup>& groups, double initial)
      : features_(features), groups_(groups) {
    const Eigen::Index size = static_cast<Eigen::Index>(features.size());
    log_ratio_.resize(size);
    stddev_.resize(size);
    for (Eigen::Index n = 0; n < size; ++n) {
      const RatioFeature& feature = features[n];
      log_ratio_[n] = feature.log_ratio;
      stddev_[n] = feature.log_ratio_stddev;
      for (const int side : {0, 1}) {
        const auto num_units =
            static_cast<std::size_t>(feature.units[side]) + 1;
        if (num_units > of_unit_[side].size()) of_unit_[side].resize(num_units);
      }
      if (runs_.empty() || runs_.back().group != feature.group) {
        runs_.push_back({feature.group, n, 0});
      }
      ++runs_.back().size;
    }
    precision_ = stddev_.inverse();
    odds_.resize(groups.size());
    num_right_.resize(groups.size());
    fit_.log_ratio = initial;
    fit_.probability.resize(features.size());
    fit_.weight.resize(features.size());
    fit_.multiplicity.assign(features.size(), 1.0);
    fit_.degrees.resize(groups.size());
    for (const RatioGroup& group : groups) {
      fit_.noise2.push_back(Square(group.noise));
    }
    FindDeviations();
    constexpr double kRightAtFirst = 2.5;  // in deviations
    constexpr double kPriorRight = 0.5;
    for (const Run& run : runs_) {
      run.Of(&fit_.probability) =
          (run.Of(squared_deviation_) <
           Square(kRightAtFirst * groups[run.group].noise))
              .cast<double>();
    }
    FindWeights();
    // Without a right one the odds would stay 0, and all of the group be taken
    // as right.
    for (const Run& run : runs_) {
      num_right_[run.group] = std::max(num_right_[run.group], kPriorRight);
    }
    FindOdds();
  }

  RatioMixture Fit() {
    constexpr int kMaxIterations = 40;
    constexpr double kAccuracy = 1e-3;  // in standard deviations, and of phi^2
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      FindProbabilities();
      FindWeights();
      const double moved = MoveToMean();
      const double change = FindNoise();
      FindOdds();
      if (moved < kAccuracy && change < kAccuracy) break;
    }
    FindProbabilities();
    FindWeights();
    return std::move(fit_);
  }

 private:
  // (r / s)^2 of every feature.
  void FindDeviations() {
    squared_deviation_ = ((log_ratio_ - fit_.log_ratio) * precision_).square();
  }

  void FindProbabilities() {
    constexpr double kRootOf2Pi = 2.5066282746310002;
    for (const Run& run : runs_) {
      const double noise2 = fit_.noise2[run.group];
      right_ = (run.Of(squared_deviation_) * (-0.5 / noise2)).exp() /
               (kRootOf2Pi * std::sqrt(noise2));
      // Neither right nor wrong: far away in a group without wrong features.
      constexpr double kLeast = std::numeric_limits<double>::min();
      run.Of(&fit_.probability) =
          right_ / (right_ + odds_[run.group] * run.Of(stddev_)).max(kLeast);
    }
  }

  // By feature, the mean of the numbers of right pairs of its two lines.
  void FindMultiplicities() {
    if (of_unit_[0].empty()) return;
    for (const int side : {0, 1}) {
      std::vector<double>& of_unit = of_unit_[side];
      std::fill(of_unit.begin(), of_unit.end(), 0.0);
      for (std::size_t n = 0; n < features_.size(); ++n) {
        if (!features_[n].IsPair()) continue;
        of_unit[features_[n].units[side]] += fit_.probability[n];
      }
    }
    for (std::size_t n = 0; n < features_.size(); ++n) {
      if (!features_[n].IsPair()) continue;
      fit_.multiplicity[n] =
          std::max(1.0, 0.5 * (of_unit_[0][features_[n].units[0]] +
                               of_unit_[1][features_[n].units[1]]));
    }
  }

  void FindWeights() {
    FindMultiplicities();
    std::vector<double> information(groups_.size(), 0.0);
    std::fill(fit_.degrees.begin(), fit_.degrees.end(), 0.0);
    std::fill(num_right_.begin(), num_right_.end(), 0.0);
    for (const Run& run : runs_) {
      auto weight = run.Of(&fit_.weight);
      weight = run.Of(&fit_.probability) / run.Of(&fit_.multiplicity);
      fit_.degrees[run.group] += weight.sum();
      weight *= run.Of(precision_).square() / fit_.noise2[run.group];
      information[run.group] += weight.sum();
      num_right_[run.group] += run.Of(&fit_.probability).sum();
    }
    information_ = 0;
    for (const double of_group : information) information_ += of_group;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const double share =
          information_ > 0 ? information[g] / information_ : 0.0;
      // The mean follows `share` of the group's independent features.
      const double count = fit_.degrees[g];
      fit_.degrees[g] =
          (count > share ? num_right_[g] * (1 - share / count) : 0.0) +
          groups_[g].prior_count;
    }
  }

  // Returns by how many standard deviations.
  double MoveToMean() {
    if (!(information_ > 0)) return 0;
    double sum = 0;
    for (const Run& run : runs_) {
      sum +=
          (run.Of(&fit_.weight) * (run.Of(log_ratio_) - fit_.log_ratio)).sum();
    }
    fit_.log_ratio += sum / information_;
    FindDeviations();
    return std::abs(sum) / std::sqrt(information_);
  }

  // Returns the largest relative change. Pairs all count alike, since the
  // squares of those that share a line hardly depend on each other, and weights
  // 1 / m would favour wrong ones, whose lines have few right pairs.
  double FindNoise() {
    std::vector<double> squares;
    for (const RatioGroup& group : groups_) {
      squares.push_back(group.prior_count);
    }
    for (const Run& run : runs_) {
      squares[run.group] +=
          (run.Of(&fit_.probability) * run.Of(squared_deviation_)).sum();
    }
    double change = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!(num_right_[g] > 0)) continue;
      const double noise2 = squares[g] / fit_.degrees[g];
      change = std::max(change, std::abs(noise2 / fit_.noise2[g] - 1));
      fit_.noise2[g] = noise2;
    }
    return change;
  }

  // The density of one wrong feature from those within reach, over the lengths
  // that all of the group's wrong features reach over; times the number of
  // wrong features over that of right ones.
  void FindOdds() {
    std::vector<double> wrong_stddevs;
    std::vector<double> wrong(groups_.size(), kPriorWrong);
    for (const RatioGroup& group : groups_) {
      wrong_stddevs.push_back(group.sum_of_stddevs);
    }
    for (const Run& run : runs_) {
      const auto probability = run.Of(&fit_.probability);
      wrong[run.group] += (1 - probability).sum();
      wrong_stddevs[run.group] -= (probability * run.Of(stddev_)).sum();
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const RatioGroup& group = groups_[g];
      if (!(num_right_[g] > 0)) continue;
      const double reach =
          2 * kRefinementReach * group.noise *
          std::max(wrong_stddevs[g], group.sum_of_stddevs / group.count);
      const double num_wrong =
          std::max(group.count - num_right_[g], 0.0) + kPriorWrong;
      odds_[g] = wrong[g] / reach * num_wrong / num_right_[g];
    }
  }

  const std::vector<RatioFeature>& features_;
  const std::vector<RatioGroup>& groups_;
  std::vector<Run> runs_;
  // By feature.
  Eigen::ArrayXd log_ratio_;
  Eigen::ArrayXd stddev_;
  Eigen::ArrayXd precision_;  // 1 / stddev
  Eigen::ArrayXd squared_deviation_;
  Eigen::ArrayXd right_;  // density if right, of one run
  RatioMixture fit_;
  double information_ = 0;
  std::vector<double> odds_;
  std::vector<double> num_right_;
  // Right pairs of every line.
  std::array<std::vector<double>, 2> of_unit_;
};

}  // namespace

RefinedRatio RefineRatio(const std::vector<RatioFeature>& features,
                         const std::vector<RatioGroup>& groups,
                         double initial) {
  RefinedRatio refined;
  if (features.empty()) {
    refined.log_ratio = initial;
    refined.log_ratio_stddev = std::numeric_limits<double>::infinity();
    refined.group_noise.assign(groups.size(), 1.0);
    refined.information_share.assign(groups.size(), 0.0);
    return refined;
  }
  RatioMixture fit = MixtureFit(features, groups, initial).Fit();
  RatioVariance variance = FindRatioVariance(features, groups, fit);
  refined.log_ratio = fit.log_ratio;
  refined.log_ratio_stddev = variance.stddev;
  refined.information_share = std::move(variance.information_share);
  refined.probability = std::move(fit.probability);
  refined.weight = std::move(fit.weight);
  for (const double noise2 : fit.noise2) {
    refined.group_noise.push_back(std::sqrt(noise2));
  }
  return refined;
}

}  // namespace lowlap
