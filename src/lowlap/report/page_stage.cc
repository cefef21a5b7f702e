#include <vector>

#include "lowlap/report/internal/page_parts.h"
#include "lowlap/scene/internal/align_poses.h"

namespace lowlap {

ReportStage AlignToScene(const ReportStage& before, const Scene& scene) {
  std::vector<Pose> source, target;
  for (const auto& [id, pose] : before.poses) {
    const auto after = scene.poses.find(id);
    if (after == scene.poses.end()) continue;
    source.push_back(pose);
    target.push_back(after->second);
  }
  const auto after_from_before = AlignPoses(source, target);
  if (!after_from_before) return before;
  const Similarity& align = *after_from_before;
  ReportStage aligned;
  for (const auto& [id, pose] : before.poses) {
    aligned.poses[id] = {pose.rotation * align.rotation.transpose(),
                         align * pose.center};
  }
  for (const auto& [id, point] : before.points) {
    aligned.points[id] = align * point;
  }
  for (const auto& [id, ends] : before.lines) {
    aligned.lines[id] = {align * ends[0], align * ends[1]};
  }
  return aligned;
}

}  // namespace lowlap
