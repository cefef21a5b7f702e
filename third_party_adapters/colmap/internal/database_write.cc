#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "lowlap/core/internal/file_changes.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/io/internal/failure.h"
#include "lowlap/scene/internal/intrinsic_shift.h"
#include "third_party_adapters/colmap/internal/camera.h"
#include "third_party_adapters/colmap/internal/database.h"
#include "third_party_adapters/colmap/internal/database_records.h"
#include "third_party_adapters/colmap/internal/model_scene.h"
#include "third_party_adapters/internal/landmarks.h"

namespace lowlap::colmap {
namespace {

// The value of two_view_geometries.config for calibrated cameras.
constexpr std::int64_t kCalibrated = 2;
// Databases from 4.0 on say "not set" by NULL, earlier ones by zeros.
constexpr std::int64_t kFirstWithNull = 3140000;
// Cameras whose pixels differ by less are one.
constexpr double kSameCameraPx = 0.01;

struct ImageRow {
  ViewId view;
  std::uint32_t id = 0;
};

std::vector<double> RowMajor(const Mat3& matrix) {
  std::vector<double> numbers(9);
  for (int n = 0; n < 9; ++n) numbers[n] = matrix(n / 3, n % 3);
  return numbers;
}

// With COLMAP's pixels.
Mat3 CalibrationMatrix(const Intrinsic& intrinsic) {
  const Vec2 pp = intrinsic.principal_point_px + PixelShift(intrinsic);
  Mat3 matrix = Mat3::Identity();
  matrix << intrinsic.fx_px, 0, pp.x(), 0, intrinsic.fy_px, pp.y(), 0, 0, 1;
  return matrix;
}

// F = K2^-T E K1^-1; empty with a panorama, which has no calibration matrix.
std::vector<double> FundamentalMatrix(const Mat3& essential,
                                      const Intrinsic& first,
                                      const Intrinsic& second) {
  if (first.model == CameraModel::kSpherical ||
      second.model == CameraModel::kSpherical) {
    return {};
  }
  return RowMajor(CalibrationMatrix(second).transpose().inverse() * essential *
                  CalibrationMatrix(first).inverse());
}

class DatabaseWriter {
 public:
  DatabaseWriter(const Scene& scene, const std::string& path)
      : scene_(scene), sqlite_(path, Sqlite::Mode::kReadWrite) {}

  SceneNotes Write() {
    sqlite_.Require({"cameras", "images", "keypoints", "two_view_geometries"});
    sqlite_.Run("BEGIN IMMEDIATE");
    FindImages();
    CheckKeypoints();
    const auto lock = LockFileChanges();
    RemoveGeometries();
    AddGeometries();
    sqlite_.Run("COMMIT");
    SceneNotes notes;
    if (num_unused_ > 0) {
      notes.push_back(std::to_string(num_unused_) +
                      " images of the database are not in the scene; their "
                      "pairs stay as they are");
    }
    AddNoteOfCameras(&notes);
    return notes;
  }

 private:
  void FindImages() {
    std::map<std::string, std::uint32_t> by_name;
    Statement row(sqlite_, "SELECT image_id, name FROM images", "images",
                  "image_id");
    while (row.Step()) by_name[row.Text(1)] = row.Unsigned(0);
    for (const auto& [id, view] : scene_.views) {
      const auto found = by_name.find(view.PathBelowRoot());
      if (found == by_name.end()) {
        row.FailRow("there is no image '" + view.PathBelowRoot() + "'",
                    ErrorCode::kInvalidArgument);
      }
      image_of_[id] = found->second;
      view_of_[found->second] = id;
    }
    num_unused_ = by_name.size() - view_of_.size();
  }

  // The table of cameras stays as it is.
  void AddNoteOfCameras(SceneNotes* notes) {
    Statement row(sqlite_,
                  "SELECT camera_id, model, width, height, params, image_id "
                  "FROM images JOIN cameras USING(camera_id)",
                  "cameras", "camera_id");
    std::set<std::uint32_t> others;
    double largest_px = 0;
    while (row.Step()) {
      const auto view = view_of_.find(row.Unsigned(5));
      const Intrinsic* ours =
          view == view_of_.end() ? nullptr : scene_.FindIntrinsic(view->second);
      const Camera camera = CameraOfRow(row, 0);
      const auto theirs = ToIntrinsic(camera);
      if (ours == nullptr || !theirs) continue;
      const double shift_px = IntrinsicShiftPx(*theirs, *ours);
      if (shift_px < kSameCameraPx) continue;
      others.insert(camera.id);
      largest_px = std::max(largest_px, shift_px);
    }
    if (others.empty()) return;
    notes->push_back(Format(
        "the cameras of the database stay as they are: %zu of them up to %.1f "
        "pixels off the scene's, which its relative poses go with; formats "
        "colmap and colmap-bin hold the scene's",
        others.size(), largest_px));
  }

  // Inliers are indices of keypoints: of others they would mean nothing.
  void CheckKeypoints() {
    Statement row(sqlite_, "SELECT image_id, rows, cols, data FROM keypoints",
                  "keypoints", "image_id");
    std::map<ViewId, std::vector<std::pair<float, float>>> keypoints;
    while (row.Step()) {
      const auto view = view_of_.find(row.Unsigned(0));
      if (view != view_of_.end()) {
        keypoints[view->second] = ReadKeypoints(row, 1);
      }
    }
    std::set<ViewId> posed;
    for (const auto& [views, pose] : scene_.relative_poses) {
      posed.insert({views.first, views.second});
    }
    for (const ViewId view : posed) {
      if (HasPoints(view, keypoints[view])) continue;
      throw Failure{Error{
          ErrorCode::kInvalidArgument,
          "other keypoints than the points of view " +
              std::to_string(view.value()) + " of the scene",
          {},
          "table keypoints, image_id " + std::to_string(image_of_.at(view))}};
    }
  }

  bool HasPoints(ViewId view,
                 const std::vector<std::pair<float, float>>& keypoints) const {
    const auto features = scene_.features.find(view);
    const Intrinsic* intrinsic = scene_.FindIntrinsic(view);
    if (features == scene_.features.end() || intrinsic == nullptr) return false;
    const auto& points_px = features->second.points_px;
    const Vec2 shift = PixelShift(*intrinsic);
    return std::equal(points_px.begin(), points_px.end(), keypoints.begin(),
                      keypoints.end(), [&](const Vec2& ours, const auto& xy) {
                        const Vec2 theirs = ours + shift;
                        return static_cast<float>(theirs.x()) == xy.first &&
                               static_cast<float>(theirs.y()) == xy.second;
                      });
  }

  void RemoveGeometries() {
    Statement row(sqlite_, "SELECT pair_id FROM two_view_geometries",
                  "two_view_geometries", "pair_id");
    std::vector<std::int64_t> removed;
    while (row.Step()) {
      const auto [first, second] = ImagesOfPair(row.Integer(0));
      if (view_of_.count(first) > 0 && view_of_.count(second) > 0) {
        removed.push_back(row.Integer(0));
      }
    }
    Statement remove(sqlite_,
                     "DELETE FROM two_view_geometries WHERE pair_id = ?",
                     "two_view_geometries");
    for (const std::int64_t pair : removed) {
      remove.Bind(0, pair);
      remove.Execute();
    }
  }

  void AddGeometries() {
    if (!sqlite_.HasColumn("two_view_geometries", "qvec")) {
      for (const char* column : {"qvec", "tvec"}) {
        sqlite_.Run("ALTER TABLE two_view_geometries ADD COLUMN " +
                    std::string(column) + " BLOB");
      }
    }
    Statement version(sqlite_, "PRAGMA user_version", "two_view_geometries");
    const bool null_is_unset =
        version.Step() && version.Integer(0) >= kFirstWithNull;
    Statement insert(sqlite_,
                     "INSERT INTO two_view_geometries(pair_id, rows, cols, "
                     "data, config, F, E, H, qvec, tvec) "
                     "VALUES(?, ?, 2, ?, ?, ?, ?, ?, ?, ?)",
                     "two_view_geometries");
    for (const auto& [views, pose] : scene_.relative_poses) {
      AddGeometry(pose, null_is_unset, &insert);
    }
  }

  void AddGeometry(const RelativePose& pose, bool null_is_unset,
                   Statement* insert) const {
    ImageRow first{pose.views.first, image_of_.at(pose.views.first)};
    ImageRow second{pose.views.second, image_of_.at(pose.views.second)};
    const bool is_swapped = first.id > second.id;
    if (is_swapped) std::swap(first, second);
    std::vector<FeatureIndex> matches;
    for (const FeatureMatch& match : pose.point_inliers) {
      matches.push_back(is_swapped ? match.second : match.first);
      matches.push_back(is_swapped ? match.first : match.second);
    }
    const RigidTransform motion = UnitTransform(pose, first.view, second.view);
    const Mat3 e = CrossMatrix(motion.translation) * motion.rotation;
    const std::vector<double> essential = RowMajor(e);
    const std::vector<double> fundamental =
        FundamentalMatrix(e, *scene_.FindIntrinsic(first.view),
                          *scene_.FindIntrinsic(second.view));
    const std::vector<double> zeros(9, 0.0);
    const auto bind = [&](int parameter, const std::vector<double>& matrix) {
      if (!matrix.empty()) {
        insert->BindBlob(parameter, Bytes(matrix));
      } else if (null_is_unset) {
        insert->BindNull(parameter);
      } else {
        insert->BindBlob(parameter, Bytes(zeros));
      }
    };
    const Vec4 q = QuaternionFromRotation(motion.rotation);
    const std::vector<double> qvec(q.begin(), q.end());
    const std::vector<double> tvec(motion.translation.begin(),
                                   motion.translation.end());
    insert->Bind(0, PairId(first.id, second.id));
    insert->Bind(1, static_cast<std::int64_t>(pose.point_inliers.size()));
    insert->BindBlob(2, Bytes(matches));
    insert->Bind(3, kCalibrated);
    bind(4, fundamental);
    bind(5, essential);
    bind(6, {});
    insert->BindBlob(7, Bytes(qvec));
    insert->BindBlob(8, Bytes(tvec));
    insert->Execute();
  }

  const Scene& scene_;
  Sqlite sqlite_;
  std::map<ViewId, std::uint32_t> image_of_;
  std::map<std::uint32_t, ViewId> view_of_;
  std::size_t num_unused_ = 0;
};

}  // namespace

Status CheckDatabaseToUpdate(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return MakeError(ErrorCode::kNotFound,
                     "no such database; relative poses are written into one "
                     "that COLMAP made",
                     path);
  }
  if (!IsDatabase(path)) {
    return MakeError(ErrorCode::kParse, "not an SQLite database", path);
  }
  return {};
}

Result<SceneNotes> WriteRelativePoses(const Scene& scene,
                                      const std::string& path) {
  LOWLAP_RETURN_IF_ERROR(CheckDatabaseToUpdate(path));
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  Result<SceneNotes> notes =
      Caught([&] { return DatabaseWriter(scene, path).Write(); });
  if (!notes) notes.error().file = path;
  return notes;
}

}  // namespace lowlap::colmap
