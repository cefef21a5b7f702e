#include "lowlap/two_view/internal/sharpen_pose.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lowlap/robust/internal/a_contrario_ransac.h"
#include "lowlap/two_view/internal/refine_relative_pose.h"

namespace lowlap {
namespace {

constexpr double kFirstScalePx = 0.3;
constexpr double kCore = 3;  // residuals up to kCore scales count
constexpr int kNumSamples = 200;
constexpr std::size_t kNumRefined = 8;
constexpr std::size_t kMaxScored = 2000;

class CoreSearch {
 public:
  CoreSearch(const PointPairs& pairs, double scale_px)
      : pairs_(pairs),
        kernel_(pairs),
        scale_px_(scale_px),
        squared_(pairs.size()) {}

  double Score(const RigidTransform& pose) {
    kernel_.SquaredResiduals(pose, 0, kernel_.NumData(), squared_.data());
    const float inverse = static_cast<float>(1 / (scale_px_ * scale_px_));
    constexpr float kLimit = static_cast<float>(kCore * kCore);
    // The logarithm of the product, taken before the product can overflow.
    double score = 0;
    double product = 1;
    for (const float squared : squared_) {
      const float ratio = squared * inverse;
      if (ratio < kLimit) product *= (1 + kLimit) / (1 + ratio);
      if (product > 1e200) {
        score += std::log(product);
        product = 1;
      }
    }
    return score + std::log(product);
  }

  /// Climbs while the score rises; returns the score reached.
  double Climb(RigidTransform& pose) {
    PoseRefinementOptions options;
    options.loss_scale_px = scale_px_;
    options.max_iterations = 3;
    double score = Score(pose);
    for (int round = 0; round < 6; ++round) {
      const RigidTransform refined = RefineRelativePose(
          pose, pairs_, kernel_.WithinThreshold(pose, 2 * kCore * scale_px_),
          options);
      const double refined_score = Score(refined);
      if (!(refined_score > score)) break;
      pose = refined;
      score = refined_score;
    }
    return score;
  }

  RigidTransform Run(const RigidTransform& start,
                     const std::vector<int>& inliers, Random& random) {
    RigidTransform best = start;
    double best_score = Climb(best);
    if (inliers.size() < 6) return best;

    struct Candidate {
      double score;
      RigidTransform pose;
    };
    const auto better = [](const Candidate& a, const Candidate& b) {
      return a.score > b.score;
    };
    std::vector<Candidate> candidates;  // a heap, the worst in front
    std::vector<RigidTransform> models;
    for (int n = 0; n < kNumSamples; ++n) {
      auto sample = DrawSample<5>(static_cast<int>(inliers.size()), random);
      for (int& i : sample) i = inliers[i];
      models.clear();
      kernel_.Solve(sample, models);
      for (const RigidTransform& model : models) {
        const double score = Score(model);
        if (candidates.size() == kNumRefined) {
          if (score <= candidates.front().score) continue;
          std::pop_heap(candidates.begin(), candidates.end(), better);
          candidates.pop_back();
        }
        candidates.push_back({score, model});
        std::push_heap(candidates.begin(), candidates.end(), better);
      }
    }
    for (Candidate& candidate : candidates) {
      const double score = Climb(candidate.pose);
      if (score > best_score) {
        best_score = score;
        best = candidate.pose;
      }
    }
    return best;
  }

 private:
  const PointPairs& pairs_;
  EssentialKernel kernel_;
  double scale_px_;
  std::vector<float> squared_;
};

}  // namespace

SharpenedPose SharpenPose(const EssentialKernel& kernel,
                          const RigidTransform& cam2_from_cam1,
                          double threshold_px, Random& random) {
  // Data are in random order, so the first ones are a fair sample.
  std::vector<int> near =
      kernel.WithinThreshold(cam2_from_cam1, 2 * threshold_px);
  if (near.size() > kMaxScored) near.resize(kMaxScored);
  PointPairs pairs;
  pairs.focal1_px = kernel.pairs().focal1_px;
  pairs.focal2_px = kernel.pairs().focal2_px;
  for (const int i : near) {
    pairs.x1.push_back(kernel.pairs().x1[i]);
    pairs.x2.push_back(kernel.pairs().x2[i]);
    pairs.covariance1.push_back(kernel.pairs().Covariance1(i));
    pairs.covariance2.push_back(kernel.pairs().Covariance2(i));
  }
  const EssentialKernel near_kernel(pairs);
  const std::vector<int> inliers =
      near_kernel.WithinThreshold(cam2_from_cam1, threshold_px);

  for (double scale_px = kFirstScalePx;; scale_px *= 2) {
    CoreSearch search(pairs, scale_px);
    const RigidTransform pose = search.Run(cam2_from_cam1, inliers, random);
    const std::size_t core =
        near_kernel.WithinThreshold(pose, kCore * scale_px).size();
    if (2 * core >= inliers.size() || kCore * scale_px > threshold_px) {
      return {pose, scale_px};
    }
  }
}

}  // namespace lowlap
