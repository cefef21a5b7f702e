#include "lowlap/two_view/internal/shuffled_matches.h"

#include <algorithm>
#include <utility>

#include "lowlap/scene/internal/common_errors.h"
#include "lowlap/scene/internal/pixel_unit.h"
#include "lowlap/two_view/internal/line_crossings.h"

namespace lowlap {
namespace {

/// The variance of a segment's end point over that of a keypoint.
constexpr double kLineVariance = 0.25;

}  // namespace

double PixelUnit(const TwoViewInput& input) {
  return PixelUnit(0.5 *
                   (input.image_size1_px.norm() + input.image_size2_px.norm()));
}

ShuffledMatches ShuffleMatches(const TwoViewInput& input, Random& random) {
  ShuffledMatches shuffled;
  PointPairs& pairs = shuffled.pairs;
  const double unit = PixelUnit(input);
  pairs.focal1_px = input.features1->focal_px / unit;
  pairs.focal2_px = input.features2->focal_px / unit;
  pairs.common_error_side1 = kCommonErrorShare * input.image_size1_px.norm() /
                             input.features1->focal_px;
  const auto add = [&](int match, const Vec3& x1, const Vec3& x2,
                       const Mat2& covariance1, const Mat2& covariance2,
                       const std::array<int, 2>& lines) {
    shuffled.match_of_pair.push_back(match);
    pairs.x1.push_back(x1);
    pairs.x2.push_back(x2);
    pairs.covariance1.push_back(covariance1);
    pairs.covariance2.push_back(covariance2);
    pairs.lines.push_back(lines);
  };
  const auto shape = [](const std::vector<Mat2>* covariances, std::size_t n) {
    return covariances == nullptr ? Mat2(Mat2::Identity()) : (*covariances)[n];
  };
  for (std::size_t m = 0; m < input.point_matches.size(); ++m) {
    const FeatureMatch& match = input.point_matches[m];
    const Vec3& x1 = input.features1->points[match.first];
    const Vec3& x2 = input.features2->points[match.second];
    if (x1.z() != 0 && x2.z() != 0) {
      add(static_cast<int>(m), x1, x2,
          shape(input.point_covariances1, match.first),
          shape(input.point_covariances2, match.second), {-1, -1});
    }
  }
  for (const LineCrossing& crossing : FindLineCrossings(
           *input.features1, *input.features2, input.line_matches)) {
    add(ShuffledMatches::kCrossing, crossing.x1, crossing.x2,
        kLineVariance * crossing.covariance1,
        kLineVariance * crossing.covariance2, crossing.matches);
  }
  for (int n = pairs.size(); n > 1; --n) {
    const auto k = random.Index(static_cast<std::uint32_t>(n));
    std::swap(shuffled.match_of_pair[n - 1], shuffled.match_of_pair[k]);
    std::swap(pairs.x1[n - 1], pairs.x1[k]);
    std::swap(pairs.x2[n - 1], pairs.x2[k]);
    std::swap(pairs.covariance1[n - 1], pairs.covariance1[k]);
    std::swap(pairs.covariance2[n - 1], pairs.covariance2[k]);
    std::swap(pairs.lines[n - 1], pairs.lines[k]);
  }
  return shuffled;
}

ShuffledMatches SomeOf(const ShuffledMatches& matches,
                       const std::vector<int>& indices) {
  ShuffledMatches some;
  const PointPairs& all = matches.pairs;
  PointPairs& pairs = some.pairs;
  pairs.focal1_px = all.focal1_px;
  pairs.focal2_px = all.focal2_px;
  pairs.common_error_side1 = all.common_error_side1;
  for (const int n : indices) {
    some.match_of_pair.push_back(matches.match_of_pair[n]);
    pairs.x1.push_back(all.x1[n]);
    pairs.x2.push_back(all.x2[n]);
    pairs.covariance1.push_back(all.covariance1[n]);
    pairs.covariance2.push_back(all.covariance2[n]);
    pairs.lines.push_back(all.lines[n]);
  }
  return some;
}

BackgroundLaw SampsonLaw(const TwoViewInput& input) {
  BackgroundLaw law;
  const double unit = PixelUnit(input);
  for (const Vec2& size_px : {input.image_size1_px, input.image_size2_px}) {
    const Vec2 size = size_px / unit;
    law.coefficient =
        std::max(law.coefficient,
                 BackgroundLaw::Sampson(size.prod(), size.norm()).coefficient);
  }
  return law;
}

}  // namespace lowlap
