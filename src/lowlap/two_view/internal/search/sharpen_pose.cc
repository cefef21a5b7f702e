#include "lowlap/two_view/internal/search/sharpen_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lowlap/robust/internal/a_contrario_ransac.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"
#include "lowlap/two_view/internal/search/same_pose.h"

namespace lowlap {
namespace {

constexpr double kFirstScalePx = 0.3;
constexpr double kCore = 3;  // residuals up to kCore scales count
constexpr std::size_t kNumKept = 2000;
constexpr int kFew = 300;
constexpr double kOneOptimumDeg = 0.1;
constexpr std::size_t kMaxScored = 2000;

// Few matches (but one at least) have many optima, which are cheap to find.
int NumSamples(std::size_t num_inliers) {
  return static_cast<int>(
      std::clamp<std::size_t>(300000 / num_inliers, 200, 3000));
}

std::size_t NumRefined(std::size_t num_inliers) {
  return std::clamp<std::size_t>(10000 / num_inliers, 8, 100);
}

std::size_t MaxOptima(std::size_t num_inliers) {
  return std::clamp<std::size_t>(3000 / num_inliers, 1, 16);
}

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

  /// The optima that the start and samples of `inliers` lead to, each once, the
  /// greatest score first.
  std::vector<RigidTransform> Run(const RigidTransform& start,
                                  const std::vector<int>& inliers,
                                  Random& random) {
    std::vector<Optimum> optima;
    AddOptimum(start, &optima);
    if (inliers.size() >= 6) {
      std::size_t num_climbed = 0;
      for (const Optimum& sampled : BestSamples(inliers, random)) {
        if (IsKnown(sampled.pose, optima)) continue;
        AddOptimum(sampled.pose, &optima);
        if (++num_climbed == NumRefined(inliers.size())) break;
      }
    }
    std::stable_sort(optima.begin(), optima.end(), HasGreaterScore);
    if (optima.size() > MaxOptima(inliers.size())) {
      optima.resize(MaxOptima(inliers.size()));
    }
    std::vector<RigidTransform> poses;
    for (const Optimum& optimum : optima) poses.push_back(optimum.pose);
    return poses;
  }

 private:
  struct Optimum {
    double score;
    RigidTransform pose;
  };
  static bool HasGreaterScore(const Optimum& a, const Optimum& b) {
    return a.score > b.score;
  }
  static bool IsKnown(const RigidTransform& pose,
                      const std::vector<Optimum>& optima) {
    return std::any_of(optima.begin(), optima.end(), [&](const Optimum& known) {
      return SamePose(pose, known.pose, kOneOptimumDeg);
    });
  }

  // The better one of two that are the same.
  void AddOptimum(RigidTransform pose, std::vector<Optimum>* optima) {
    const double score = Climb(pose);
    for (Optimum& known : *optima) {
      if (!SamePose(pose, known.pose, kOneOptimumDeg)) continue;
      if (score > known.score) known = {score, pose};
      return;
    }
    optima->push_back({score, pose});
  }

  std::vector<Optimum> BestSamples(const std::vector<int>& inliers,
                                   Random& random) {
    std::vector<Optimum> best;  // a heap, the worst in front
    std::vector<RigidTransform> models;
    const int num_samples = NumSamples(inliers.size());
    for (int n = 0; n < num_samples; ++n) {
      auto sample = DrawSample<5>(static_cast<int>(inliers.size()), random);
      for (int& i : sample) i = inliers[i];
      models.clear();
      kernel_.Solve(sample, models);
      for (const RigidTransform& model : models) {
        const double score = Score(model);
        if (best.size() == kNumKept) {
          if (score <= best.front().score) continue;
          std::pop_heap(best.begin(), best.end(), HasGreaterScore);
          best.pop_back();
        }
        best.push_back({score, model});
        std::push_heap(best.begin(), best.end(), HasGreaterScore);
      }
    }
    std::stable_sort(best.begin(), best.end(), HasGreaterScore);
    return best;
  }

  const PointPairs& pairs_;
  EssentialKernel kernel_;
  double scale_px_;
  std::vector<float> squared_;
};

}  // namespace

SharpenedPoses SharpenPose(const EssentialKernel& kernel,
                           const RigidTransform& cam2_from_cam1,
                           double threshold_px, Random& random) {
  // Of few matches, those that other optima explain count as well. Data are in
  // random order, so the first ones are a fair sample.
  std::vector<int> near = kernel.WithinThreshold(
      cam2_from_cam1, kernel.NumData() < kFew
                          ? std::numeric_limits<double>::infinity()
                          : 2 * threshold_px);
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
  if (inliers.empty()) return {{cam2_from_cam1}, kFirstScalePx};

  for (double scale_px = kFirstScalePx;; scale_px *= 2) {
    CoreSearch search(pairs, scale_px);
    std::vector<RigidTransform> optima =
        search.Run(cam2_from_cam1, inliers, random);
    const std::size_t core =
        near_kernel.WithinThreshold(optima.front(), kCore * scale_px).size();
    if (2 * core >= inliers.size() || kCore * scale_px > threshold_px) {
      return {std::move(optima), scale_px};
    }
  }
}

}  // namespace lowlap
