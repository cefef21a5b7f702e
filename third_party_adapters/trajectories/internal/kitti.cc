#include "third_party_adapters/trajectories/internal/kitti.h"

#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/internal/landmarks.h"
#include "third_party_adapters/internal/number_text.h"

namespace lowlap::trajectories {
namespace {

Mat34 NextKittiMatrix(TokenReader* reader) {
  Mat34 matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (reader->status() && (row > 0 || column > 0) && reader->AtLineEnd()) {
        reader->Fail("the line ends where twelve numbers are expected");
      }
      matrix(row, column) = reader->Next<double>("a number of a pose");
    }
  }
  if (reader->status() && !reader->AtLineEnd()) {
    reader->Fail("the line goes on after the twelve numbers of a pose");
  }
  return matrix;
}

}  // namespace

bool IsKittiStart(std::string_view start) {
  TokenReader reader(start, {});
  NextKittiMatrix(&reader);
  return static_cast<bool>(reader.status());
}

Result<Scene> ParseKitti(std::string_view text, const std::string& file) {
  TokenReader reader(text, file);
  Scene scene;
  for (std::uint32_t n = 0; reader.status() && !reader.AtEnd(); ++n) {
    const Mat34 world_from_cam = NextKittiMatrix(&reader);
    if (!reader.status()) break;
    const Mat3 rotation = world_from_cam.leftCols<3>();
    scene.views[n].pose_id = n;
    scene.poses[n] = {
        CheckedRotation(rotation, "pose " + std::to_string(n), &reader)
            .transpose(),
        world_from_cam.col(3)};
  }
  if (scene.poses.empty()) reader.Fail("the file holds no pose");
  if (!reader.status()) return reader.error();
  return scene;
}

Result<std::string> FormatKitti(const Scene& scene, SceneNotes* notes) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  std::string text;
  std::uint32_t num_lines = 0;
  std::size_t num_unposed = 0;
  bool lines_are_ids = true;
  for (const auto& [id, view] : scene.views) {
    const Pose* pose = scene.FindPose(id);
    if (pose == nullptr) {
      ++num_unposed;
      continue;
    }
    lines_are_ids = lines_are_ids && id == num_lines;
    ++num_lines;
    for (int row = 0; row < 3; ++row) {
      text += NumberText(Vec3(pose->rotation.col(row))) +
              Format(" %.17g", pose->center[row]) + (row < 2 ? " " : "\n");
    }
  }
  AddNote(num_unposed, "views without a pose were left out", notes);
  if (!lines_are_ids) {
    notes->push_back(
        "the views' ids are not 0, 1, 2, ...: line n of the file is the n-th "
        "posed view in the order of ids, from 0");
  }
  return text;
}

}  // namespace lowlap::trajectories
