#include "lowlap/adjustment/internal/uncertainty/center_shift.h"

#include <cmath>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/similarity.h"

namespace lowlap {
namespace {

double LogRatio(const Vec3& first, const Vec3& middle, const Vec3& last) {
  return std::log((last - middle).norm() / (middle - first).norm());
}

}  // namespace

CenterShift::CenterShift(const CameraSet& cameras,
                         const std::vector<Component>& components,
                         const CameraSet& moved)
    : cameras_(cameras) {
  for (const Component& component : components) {
    std::vector<Vec3> source, target;
    for (const int pose : component.poses) {
      source.push_back(moved.poses[pose].center);
      target.push_back(cameras.poses[pose].center);
    }
    const auto similarity = AlignPoints(source, target);
    if (!similarity) continue;
    for (std::size_t n = 0; n < source.size(); ++n) {
      steps_[cameras.poses[component.poses[n]].id] =
          *similarity * source[n] - target[n];
    }
  }
}

void CenterShift::AddTo(CenterUncertainty* uncertainty) const {
  for (auto& [pose, covariance] : uncertainty->covariances) {
    const auto step = steps_.find(pose);
    if (step == steps_.end()) continue;
    covariance += step->second.squaredNorm() / 3 * Mat3::Identity();
  }
  AddChanges(1, uncertainty);
}

void CenterShift::AddDrawn(double weight,
                           CenterUncertainty* uncertainty) const {
  for (auto& [pose, covariance] : uncertainty->covariances) {
    const auto step = steps_.find(pose);
    if (step == steps_.end()) continue;
    covariance += weight * step->second * step->second.transpose();
  }
  AddChanges(weight, uncertainty);
}

void CenterShift::AddChanges(double weight,
                             CenterUncertainty* uncertainty) const {
  const double factor = std::sqrt(weight);
  for (auto& [views, stddev] : uncertainty->log_ratio_stddevs) {
    if (!Has(views.first) || !Has(views.middle) || !Has(views.last)) continue;
    const double change =
        LogRatio(After(views.first), After(views.middle), After(views.last)) -
        LogRatio(Before(views.first), Before(views.middle), Before(views.last));
    if (std::isfinite(change)) stddev = std::hypot(stddev, factor * change);
  }
  for (auto& [views, stddev_rad] : uncertainty->direction_stddevs_rad) {
    if (!Has(views.first) || !Has(views.second)) continue;
    const double change_rad =
        AngleBetween(After(views.second) - After(views.first),
                     Before(views.second) - Before(views.first));
    if (std::isfinite(change_rad)) {
      stddev_rad = std::hypot(stddev_rad, factor * change_rad);
    }
  }
}

const PoseState& CenterShift::PoseOf(ViewId view) const {
  return cameras_.PoseOf(cameras_.Find(view));
}

bool CenterShift::Has(ViewId view) const {
  return steps_.count(PoseOf(view).id) > 0;
}

Vec3 CenterShift::Before(ViewId view) const { return PoseOf(view).center; }

Vec3 CenterShift::After(ViewId view) const {
  return Before(view) + steps_.at(PoseOf(view).id);
}

}  // namespace lowlap
