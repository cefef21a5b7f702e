#include "third_party_adapters/trajectories/internal/tum.h"

#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/internal/landmarks.h"
#include "third_party_adapters/internal/number_text.h"

namespace lowlap::trajectories {
namespace {

struct TumPose {
  std::string timestamp;
  Pose pose;
};

void SkipComments(TokenReader* reader) {
  while (!reader->AtEnd() && reader->Peek() == '#') reader->RestOfLine();
}

TumPose NextTumPose(TokenReader* reader) {
  TumPose result;
  result.timestamp = std::string(reader->Word("a timestamp"));
  TokenReader number(result.timestamp, {});
  number.Next<double>("a timestamp");
  if (reader->status() && !number.status()) {
    reader->Fail(number.status().error().message);
  }
  Eigen::Matrix<double, 7, 1> numbers;
  for (double& value : numbers) {
    if (reader->status() && reader->AtLineEnd()) {
      reader->Fail("the line ends where eight numbers are expected");
    }
    value = reader->Next<double>("a number of a pose");
  }
  if (reader->status() && !reader->AtLineEnd()) {
    reader->Fail("the line goes on after the eight numbers of a pose");
  }
  if (!reader->status()) return result;
  const Vec4 wxyz(numbers[6], numbers[3], numbers[4], numbers[5]);
  const Mat3 world_from_cam =
      CheckedRotation(wxyz, "timestamp " + result.timestamp, reader);
  result.pose = {world_from_cam.transpose(), numbers.head<3>()};
  return result;
}

/// The ids that timestamps are; empty if one is no id, or one is repeated.
std::vector<std::uint32_t> IdsOf(const std::vector<TumPose>& poses) {
  std::vector<std::uint32_t> ids;
  std::set<std::uint32_t> distinct;
  for (const TumPose& pose : poses) {
    TokenReader number(pose.timestamp, {});
    ids.push_back(number.Next<std::uint32_t>("an id"));
    const bool is_id = number.status() && ids.back() != kInvalidId;
    if (!is_id || !distinct.insert(ids.back()).second) return {};
  }
  return ids;
}

/// File names without extension as timestamps; empty if one is no number, or
/// two are equal.
std::map<ViewId, std::string> TimestampsOf(const Scene& scene) {
  std::map<ViewId, std::string> timestamps;
  std::set<double> distinct;
  for (const auto& [id, view] : scene.views) {
    // Not stem(): what a name without extension has after its point is part of
    // its number.
    for (const std::string& name :
         {view.filename,
          std::filesystem::path(view.filename).stem().string()}) {
      TokenReader number(name, {});
      const double time = number.Next<double>("a number");
      if (!number.status() || !number.AtEnd()) continue;
      if (!distinct.insert(time).second) return {};
      timestamps[id] = name;
      break;
    }
    if (timestamps.count(id) == 0) return {};
  }
  return timestamps;
}

}  // namespace

bool IsTumStart(std::string_view start) {
  TokenReader reader(start, {});
  SkipComments(&reader);
  NextTumPose(&reader);
  return static_cast<bool>(reader.status());
}

Result<Scene> ParseTum(std::string_view text, const std::string& file) {
  TokenReader reader(text, file);
  std::vector<TumPose> poses;
  std::set<std::string> distinct;
  for (SkipComments(&reader); reader.status() && !reader.AtEnd();
       SkipComments(&reader)) {
    poses.push_back(NextTumPose(&reader));
    if (!distinct.insert(poses.back().timestamp).second) {
      reader.Fail("the timestamp " + poses.back().timestamp + " is repeated");
    }
  }
  if (poses.empty()) reader.Fail("the file holds no pose");
  if (!reader.status()) return reader.error();
  const std::vector<std::uint32_t> ids = IdsOf(poses);
  Scene scene;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const auto id = ids.empty() ? static_cast<std::uint32_t>(n) : ids[n];
    scene.views[id].filename = poses[n].timestamp;
    scene.views[id].pose_id = id;
    scene.poses[id] = poses[n].pose;
  }
  return scene;
}

Result<std::string> FormatTum(const Scene& scene, SceneNotes* notes) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  const auto timestamps = TimestampsOf(scene);
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  std::size_t num_unposed = 0;
  for (const auto& [id, view] : scene.views) {
    const Pose* pose = scene.FindPose(id);
    if (pose == nullptr) {
      ++num_unposed;
      continue;
    }
    const Vec4 wxyz = QuaternionOf(pose->rotation.transpose());
    text +=
        (timestamps.empty() ? std::to_string(id.value()) : timestamps.at(id)) +
        " " + NumberText(pose->center) + " " +
        NumberText(Vec4(wxyz[1], wxyz[2], wxyz[3], wxyz[0])) + "\n";
  }
  AddNote(num_unposed, "views without a pose were left out", notes);
  if (timestamps.empty()) {
    notes->push_back(
        "not all file names are different numbers: timestamps are the ids of "
        "the views");
  }
  return text;
}

}  // namespace lowlap::trajectories
