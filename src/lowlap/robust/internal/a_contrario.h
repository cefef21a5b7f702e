#pragma once

#include <cstdint>
#include <vector>

namespace lowlap {

/// Probability that a wrong datum has a residual of at most e:
///   alpha(e) = min(1, coefficient e^dimension).
/// Distance to a line in an image of area A and diagonal D: 2 D e / A, in one
/// dimension; distance to a point: pi e^2 / A, in two.
struct BackgroundLaw {
  double coefficient = 0;
  int dimension = 1;

  static BackgroundLaw PointToLine(double image_area, double image_diagonal) {
    return {2 * image_diagonal / image_area, 1};
  }
  /// Sampson distance from an epipolar line: that to the line over sqrt(2),
  /// where the gradients of the two images are alike.
  static BackgroundLaw Sampson(double image_area, double image_diagonal) {
    BackgroundLaw law = PointToLine(image_area, image_diagonal);
    law.coefficient *= 1.4142135623730951;
    return law;
  }
  static BackgroundLaw PointToPoint(double image_area) {
    return {3.14159265358979323846 / image_area, 2};
  }

  double Alpha(double residual) const;
};

/// A model's score: its least NFA over the thresholds, and where it is.
struct AContrarioScore {
  double log10_nfa = 0;
  double threshold = 0;
  int num_inliers = 0;
};

/// The a-contrario criterion of Moisan and Stival ("A probabilistic criterion
/// to detect rigid point matches between two images and estimate the
/// fundamental matrix", IJCV 2004) on a ladder of thresholds instead of all
/// residuals: with k of n residuals at most e_j,
///   NFA = T M C(n, k) C(k, s) alpha(e_j)^(k - s),
/// s the sample size, M the models per sample, T the steps of the ladder (the
/// number of thresholds tested). A model is meaningful if its NFA is below 1.
///
/// The steps are 2^(1/8) apart on average (8 per octave of the residual, linear
/// between powers of two of its square), so that a residual finds its step by
/// integer arithmetic on its bits, and scoring is O(n) without a sort.
class AContrarioLadder {
 public:
  /// Thresholds from about `min_threshold` to `max_threshold` > min > 0.
  AContrarioLadder(int num_data, int sample_size, int max_models_per_sample,
                   const BackgroundLaw& law, double min_threshold,
                   double max_threshold);

  /// The same ladder for data whose wrong members are not uniform: alpha at
  /// each step becomes the share of `background_counts` (residuals of data
  /// known to be wrong, such as permuted matches, per step, NumSteps() + 1
  /// entries) where that exceeds the law. Plus one, so that no alpha is zero.
  AContrarioLadder WithBackground(
      const std::vector<int>& background_counts) const;

  int NumSteps() const { return static_cast<int>(thresholds_.size()); }
  double Threshold(int step) const { return thresholds_[step]; }

  /// The lowest step whose threshold is not below the residual; NumSteps() if
  /// there is none.
  int Step(float squared_residual) const;

  /// log10 NFA of k inliers at a step; +infinity for k <= sample size.
  double Log10Nfa(int num_inliers, int step) const;

  /// The best step for counts[j] = number of residuals in step j (not
  /// cumulated), NumSteps() + 1 entries.
  AContrarioScore Best(const std::vector<int>& counts) const;
  AContrarioScore Score(const std::vector<float>& squared_residuals) const;

  /// The least number of inliers at `step` that beats `log10_nfa`; more than
  /// the number of data if none does.
  int InliersToBeat(double log10_nfa, int step) const;

 private:
  int num_data_;
  int sample_size_;
  std::uint32_t first_bits_ = 0;
  std::vector<double> thresholds_;
  std::vector<double> log10_alpha_;
  std::vector<double> log10_tests_;  // by number of inliers
};

}  // namespace lowlap
