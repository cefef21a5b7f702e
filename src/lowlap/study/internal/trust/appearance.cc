#include "lowlap/study/internal/trust/appearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

constexpr std::uint64_t kPointStream = 101'000'000'000;
constexpr std::uint64_t kLineStream = 102'000'000'000;
constexpr double kValueNoise = 0.2;
// A blob of 1 cm a metre away, in pixels: a hundredth of the focal length.
constexpr double kBlob_m = 0.01;

constexpr std::size_t kNumValues = 256;
using Values = std::array<double, kNumValues>;

class Appearance {
 public:
  explicit Appearance(Random* random) {
    const double change = random->Uniform(0.2, 1.5);
    for (std::size_t n = 0; n < kNumValues; ++n) {
      base_[n] = random->Gaussian();
      for (double& component : gradient_[n]) {
        component = random->Gaussian(change);
      }
    }
  }

  Values SeenFrom(const Vec3& direction, Random* random) const {
    Values values;
    for (std::size_t n = 0; n < kNumValues; ++n) {
      values[n] = base_[n] + gradient_[n].dot(direction) +
                  random->Gaussian(kValueNoise);
    }
    return values;
  }

 private:
  std::array<double, kNumValues> base_;
  std::array<Vec3, kNumValues> gradient_;
};

PointDescriptor PointDescriptorOf(const Values& values) {
  PointDescriptor descriptor;
  const Eigen::Map<const Eigen::Matrix<double, descriptor.size(), 1>> sizes(
      values.data());
  const double unit = 512 / sizes.norm();
  for (std::size_t n = 0; n < descriptor.size(); ++n) {
    descriptor[n] = static_cast<std::uint8_t>(
        std::min(255.0, std::round(unit * std::abs(values[n]))));
  }
  return descriptor;
}

LineDescriptor LineDescriptorOf(const Values& values) {
  LineDescriptor descriptor = {};
  for (std::size_t n = 0; n < kNumValues; ++n) {
    if (values[n] > 0) descriptor[n / 8] |= 1 << (n % 8);
  }
  return descriptor;
}

Vec3 PlaceOf(const Vec3& point) { return point; }
Vec3 PlaceOf(const SyntheticLine& line) {
  return 0.5 * (line.start + line.end);
}

// Of one place, in the views of both sessions.
class Place {
 public:
  // Drawn from `stream`, and what has changed from three times that.
  Place(const LikenessOptions& likeness, std::uint64_t seed,
        std::uint64_t stream, std::uint64_t id)
      : likeness_(likeness), first_(DrawnFrom(seed, stream + id)) {
    Random changes(seed, 3 * stream + id);
    if (changes.Uniform() < likeness.changed_share) second_.emplace(&changes);
  }

  const Appearance& In(ViewId view) const {
    const std::vector<ViewId>& second = likeness_.second_session;
    const bool is_second =
        std::find(second.begin(), second.end(), view) != second.end();
    return is_second && second_ ? *second_ : first_;
  }

 private:
  static Appearance DrawnFrom(std::uint64_t seed, std::uint64_t stream) {
    Random random(seed, stream);
    return Appearance(&random);
  }

  const LikenessOptions& likeness_;
  Appearance first_;
  std::optional<Appearance> second_;
};

// Calls describe(ref, ray, values) for all features of the tracks, with the
// vector from the camera.
template <class Id, class Shape, class Describe>
void DescribeTracks(const std::map<ViewId, Pose>& cameras,
                    const std::map<Id, Track>& tracks,
                    const std::map<Id, Shape>& shapes,
                    const std::vector<AlikeTracks<Id>>& alike,
                    const LikenessOptions& likeness, std::uint64_t seed,
                    std::uint64_t stream, const Describe& describe) {
  std::map<Id, const AlikeTracks<Id>*> original_of;
  for (const AlikeTracks<Id>& both : alike) original_of[both.second] = &both;
  for (const auto& [id, shape] : shapes) {
    const auto original = original_of.find(id);
    const bool is_copy = original != original_of.end();
    const Place place(likeness, seed, stream,
                      (is_copy ? original->second->first : id).value());
    Random random(seed, 2 * stream + id.value());
    for (const FeatureRef& ref : tracks.at(id)) {
      const Vec3 ray = PlaceOf(shape) - cameras.at(ref.view).center;
      Vec3 direction = ray.normalized();
      if (is_copy) direction = original->second->first_from_second * direction;
      const bool is_found = random.Uniform() < likeness.found_share;
      const Appearance& seen =
          is_found ? place.In(ref.view) : Appearance(&random);
      describe(ref, ray, seen.SeenFrom(direction, &random));
    }
  }
}

}  // namespace

std::map<ViewId, DetectedFeatures> DescribeFeatures(
    const SyntheticScene& synthetic, const LikenessOptions& likeness,
    std::uint64_t seed) {
  const Scene& scene = synthetic.scene;
  std::map<ViewId, DetectedFeatures> detected;
  for (const auto& [view, features] : scene.features) {
    DetectedFeatures& of_view = detected[view];
    of_view.features = features;
    for (const Vec2& point_px : features.points_px) {
      of_view.keypoints.emplace_back().position_px = point_px;
    }
    of_view.point_descriptors.resize(features.points_px.size());
    of_view.line_descriptors.resize(features.segments.size());
  }
  DescribeTracks(
      synthetic.true_poses, scene.point_tracks, synthetic.true_points,
      synthetic.alike_points, likeness, seed, kPointStream,
      [&](const FeatureRef& ref, const Vec3& ray, const Values& values) {
        DetectedFeatures& of_view = detected[ref.view];
        of_view.keypoints[ref.feature].scale_px =
            kBlob_m * scene.FindIntrinsic(ref.view)->MeanFocalPx() / ray.norm();
        of_view.point_descriptors[ref.feature] = PointDescriptorOf(values);
      });
  DescribeTracks(
      synthetic.true_poses, scene.line_tracks, synthetic.true_lines,
      synthetic.alike_lines, likeness, seed, kLineStream,
      [&](const FeatureRef& ref, const Vec3& /*ray*/, const Values& values) {
        detected[ref.view].line_descriptors[ref.feature] =
            LineDescriptorOf(values);
      });
  return detected;
}

}  // namespace lowlap
