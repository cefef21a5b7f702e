#include "lowlap/robust/internal/a_contrario_ransac.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

struct Point {
  double x;
  double y;
};

/// Lines y = slope x + offset through points of a square of side 1000.
class LineKernel {
 public:
  struct Model {
    double slope;
    double offset;
  };
  static constexpr int kSampleSize = 2;

  explicit LineKernel(std::vector<Point> points) : points_(std::move(points)) {}

  int NumData() const { return static_cast<int>(points_.size()); }
  void Solve(const std::array<int, 2>& sample,
             std::vector<Model>& models) const {
    const Point& a = points_[sample[0]];
    const Point& b = points_[sample[1]];
    if (a.x == b.x) return;
    const double slope = (b.y - a.y) / (b.x - a.x);
    models.push_back({slope, a.y - slope * a.x});
  }
  void SquaredResiduals(const Model& model, int begin, int end,
                        float* squared) const {
    for (int i = begin; i < end; ++i) {
      const double r = Residual(model, points_[i]);
      squared[i] = static_cast<float>(r * r);
    }
  }
  std::optional<Model> Refine(const Model& model, double threshold) const {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Point& p : points_) {
      if (std::abs(Residual(model, p)) > threshold) continue;
      ++n, sx += p.x, sy += p.y, sxx += p.x * p.x, sxy += p.x * p.y;
    }
    const double determinant = n * sxx - sx * sx;
    if (!(determinant > 0)) return std::nullopt;
    const double slope = (n * sxy - sx * sy) / determinant;
    return Model{slope, (sy - slope * sx) / n};
  }

 private:
  static double Residual(const Model& model, const Point& p) {
    return (p.y - model.slope * p.x - model.offset) /
           std::hypot(1.0, model.slope);
  }
  std::vector<Point> points_;
};

const BackgroundLaw kLineLaw = BackgroundLaw::PointToLine(1e6, 1414);

std::vector<Point> LineWithOutliers(int num_inliers, int num_outliers,
                                    double noise, Random& random) {
  std::vector<Point> points;
  for (int i = 0; i < num_inliers; ++i) {
    const double x = random.Uniform(0, 1000);
    points.push_back({x, 0.5 * x + 100 + random.Gaussian(noise)});
  }
  for (int i = 0; i < num_outliers; ++i) {
    points.push_back({random.Uniform(0, 1000), random.Uniform(0, 1000)});
  }
  for (std::size_t n = points.size(); n > 1; --n) {
    std::swap(points[n - 1],
              points[random.Index(static_cast<std::uint32_t>(n))]);
  }
  return points;
}

AContrarioRansacResult<LineKernel::Model> Fit(const std::vector<Point>& points,
                                              std::uint64_t seed) {
  const LineKernel kernel(points);
  const AContrarioLadder ladder(kernel.NumData(), 2, 1, kLineLaw, 0.1, 30);
  Random random(seed);
  return AContrarioRansac(kernel, ladder, {}, random);
}

TEST(DrawSample, GivesDifferentIndicesAndAllOfThem) {
  Random random(1);
  std::set<int> seen;
  for (int trial = 0; trial < 1000; ++trial) {
    const auto sample = DrawSample<3>(5, random);
    EXPECT_EQ(std::set<int>(sample.begin(), sample.end()).size(), 3u);
    seen.insert(sample.begin(), sample.end());
  }
  EXPECT_EQ(seen, (std::set<int>{0, 1, 2, 3, 4}));
}

TEST(AContrarioRansac, FindsTheLineAndItsNoiseAmongNineTenthsOutliers) {
  for (const double noise : {0.3, 3.0}) {
    Random random(2);
    const auto result = Fit(LineWithOutliers(100, 900, noise, random), 7);
    ASSERT_TRUE(result.model);
    EXPECT_LT(result.score.log10_nfa, -20);
    EXPECT_NEAR(result.model->slope, 0.5, 0.003 * noise);
    EXPECT_NEAR(result.model->offset, 100, 2 * noise);
    // The threshold follows the noise; nobody told it.
    EXPECT_GT(result.score.threshold, noise);
    EXPECT_LT(result.score.threshold, 5 * noise);
  }
}

TEST(AContrarioRansac, IsDeterministic) {
  Random random(3);
  const std::vector<Point> points = LineWithOutliers(40, 100, 1, random);
  const auto a = Fit(points, 5);
  const auto b = Fit(points, 5);
  EXPECT_EQ(a.model->slope, b.model->slope);
  EXPECT_EQ(a.num_samples, b.num_samples);
}

TEST(AContrarioRansac, DrawsFewSamplesWhenInliersAreMany) {
  Random random(4);
  EXPECT_EQ(Fit(LineWithOutliers(200, 20, 1, random), 1).num_samples, 100);
  EXPECT_GT(Fit(LineWithOutliers(40, 300, 1, random), 1).num_samples, 300);
}

TEST(AContrarioRansac, FindsNoLineInNoise) {
  for (int trial = 0; trial < 20; ++trial) {
    Random random(100 + trial);
    EXPECT_GT(Fit(LineWithOutliers(0, 100, 1, random), trial).score.log10_nfa,
              -2);
  }
}

TEST(AContrarioRansac, GivesNoModelForAMinimalSampleOnly) {
  EXPECT_FALSE(Fit({{0, 0}, {1, 1}}, 1).model);
  EXPECT_FALSE(Fit({}, 1).model);
}

TEST(EarlyBailOut, KeepsWhatMayWinAndDropsWhatCannot) {
  const int n = 1000;
  const AContrarioLadder ladder(n, 2, 1, kLineLaw, 0.1, 30);
  EarlyBailOut bail_out(ladder, n);
  std::vector<int> counts(ladder.NumSteps() + 1, 0);
  counts.back() = 100;
  EXPECT_TRUE(bail_out.MayWin(counts, 100)) << "nothing to beat yet";
  const int step = ladder.Step(1.0f);
  bail_out.SetBest(ladder.Log10Nfa(500, step));
  EXPECT_FALSE(bail_out.MayWin(counts, 100));
  counts.back() = 55;
  counts[step] = 45;  // a little below the share of the best
  EXPECT_TRUE(bail_out.MayWin(counts, 100));
}

}  // namespace
}  // namespace lowlap
