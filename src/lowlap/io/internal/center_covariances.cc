#include "lowlap/io/internal/center_covariances.h"

#include <string>

#include "lowlap/io/internal/failure.h"

namespace lowlap {

CenterCovariances CenterCovariancesOf(const Scene& scene) {
  CenterCovariances covariances;
  for (const auto& [id, pose] : scene.poses) {
    if (pose.center_covariance) covariances[id] = *pose.center_covariance;
  }
  return covariances;
}

void SetCenterCovariances(const CenterCovariances& covariances, Scene& scene) {
  for (const auto& [id, covariance] : covariances) {
    const auto pose = scene.poses.find(id);
    if (pose == scene.poses.end()) {
      const std::string number = std::to_string(id.value());
      throw Failure{Error{ErrorCode::kInvalidScene,
                          "there is no pose " + number,
                          {},
                          "$.lowlap.center_covariances[id=" + number + "]"}};
    }
    pose->second.center_covariance = covariance;
  }
}

}  // namespace lowlap
