#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/io/internal/failure.h"
#include "lowlap/matching/internal/tracks.h"
#include "third_party_adapters/colmap/internal/camera.h"
#include "third_party_adapters/colmap/internal/database.h"
#include "third_party_adapters/colmap/internal/database_records.h"
#include "third_party_adapters/colmap/internal/model_scene.h"

namespace lowlap::colmap {
namespace {

constexpr std::string_view kSqliteStart("SQLite format 3\0", 16);

// Values of two_view_geometries.config.
constexpr std::int64_t kDegenerate = 1;
constexpr std::int64_t kWatermark = 7;

class DatabaseReader {
 public:
  explicit DatabaseReader(const std::string& path)
      : sqlite_(path, Sqlite::Mode::kReadOnly) {}

  Database Read() {
    sqlite_.Require({"cameras", "images", "keypoints"});
    sqlite_.Run("BEGIN");  // one state, whoever writes
    ReadCameras();
    ReadImages();
    ReadPoints();
    if (sqlite_.HasTable("matches")) ReadMatches("matches");
    // Its name of old.
    for (const char* table : {"inlier_matches", "two_view_geometries"}) {
      if (sqlite_.HasTable(table)) ReadGeometries(table);
    }
    FindUnrelatedPairs();
    AddNotes();
    return std::move(database_);
  }

 private:
  void ReadCameras() {
    Statement row(sqlite_,
                  "SELECT camera_id, model, width, height, params, "
                  "prior_focal_length FROM cameras",
                  "cameras", "camera_id");
    while (row.Step()) {
      Camera camera = CameraOfRow(row, 0);
      if (row.Integer(5) == 0) guessed_.insert(camera.id);
      cameras_[camera.id] = std::move(camera);
    }
  }

  void ReadImages() {
    Statement row(sqlite_, "SELECT image_id, name, camera_id FROM images",
                  "images", "image_id");
    Scene& scene = database_.scene;
    while (row.Step()) {
      const std::int64_t id = row.Integer(0);
      if (id < 0 || id >= kMaxImages) row.FailRow("the id is out of range");
      const std::uint32_t camera_id = row.Unsigned(2);
      const auto camera = cameras_.find(camera_id);
      if (camera == cameras_.end()) {
        row.FailRow("has camera " + std::to_string(camera_id) +
                    ", which is not there");
      }
      if (scene.intrinsics.count(camera_id) == 0) {
        const auto intrinsic = ToIntrinsic(camera->second);
        if (!intrinsic) {
          row.FailRow(intrinsic.error().message, intrinsic.error().code);
        }
        scene.intrinsics[camera_id] = *intrinsic;
      }
      const Intrinsic& intrinsic = scene.intrinsics.at(camera_id);
      const ViewId view_id = static_cast<std::uint32_t>(id);
      scene.views[view_id] =
          ViewOfImage(view_id.value(), row.Text(1), camera_id, intrinsic);
      scene.features[view_id];
    }
  }

  void ReadPoints() {
    Statement row(sqlite_, "SELECT image_id, rows, cols, data FROM keypoints",
                  "keypoints", "image_id");
    Scene& scene = database_.scene;
    while (row.Step()) {
      const ViewId view = row.Unsigned(0);
      if (scene.views.count(view) == 0) row.FailRow("there is no such image");
      const Vec2 shift = PixelShift(*scene.FindIntrinsic(view));
      auto& points_px = scene.features.at(view).points_px;
      for (const auto& [x, y] : ReadKeypoints(row, 1)) {
        points_px.emplace_back(Vec2(x, y) - shift);
      }
    }
  }

  // The views of a row; nullopt, and counted, if the database has them not.
  std::optional<ViewPair> Views(const Statement& row) {
    const auto [first, second] = ImagesOfPair(row.Integer(0));
    if (row.Integer(0) < 0 || first >= second) {
      row.FailRow("names no pair of images");
    }
    const auto& views = database_.scene.views;
    if (views.count(first) > 0 && views.count(second) > 0) {
      return ViewPair{first, second};
    }
    unknown_.insert({first, second});
    return std::nullopt;
  }

  std::vector<FeatureMatch> Matches(const Statement& row,
                                    const ViewPair& views) const {
    std::uint32_t cols = 0;
    const std::vector<FeatureIndex> numbers =
        ReadRows<FeatureIndex>(row, 1, &cols);
    if (!numbers.empty() && cols != 2) {
      row.FailRow("matches have 2 columns, not " + std::to_string(cols));
    }
    const auto& features = database_.scene.features;
    const auto check = [&](FeatureIndex index, ViewId view) {
      const std::size_t count = features.at(view).points_px.size();
      if (index < count) return;
      row.FailRow("keypoint " + std::to_string(index) +
                  " does not exist: image " + std::to_string(view.value()) +
                  " has " + std::to_string(count));
    };
    std::vector<FeatureMatch> matches;
    for (std::size_t n = 0; n < numbers.size(); n += 2) {
      check(numbers[n], views.first);
      check(numbers[n + 1], views.second);
      matches.push_back({numbers[n], numbers[n + 1]});
    }
    return matches;
  }

  void ReadMatches(const std::string& table) {
    Statement row(sqlite_, "SELECT pair_id, rows, cols, data FROM " + table,
                  table, "pair_id");
    while (row.Step()) {
      const auto views = Views(row);
      if (!views) continue;
      TakeMatches(*views, Matches(row, *views));
    }
  }

  void TakeMatches(const ViewPair& views, std::vector<FeatureMatch> matches) {
    if (matches.empty()) {
      without_match_.insert(views);
    } else {
      database_.matches[views] = std::move(matches);
    }
  }

  void ReadGeometries(const std::string& table) {
    const bool has_config = sqlite_.HasColumn(table, "config");
    const bool has_pose = sqlite_.HasColumn(table, "qvec");
    Statement row(sqlite_,
                  "SELECT pair_id, rows, cols, data, " +
                      std::string(has_config ? "config" : "2") + ", " +
                      (has_pose ? "qvec, tvec" : "NULL, NULL") + " FROM " +
                      table,
                  table, "pair_id");
    while (row.Step()) {
      const auto views = Views(row);
      if (!views) continue;
      const std::int64_t config = row.Integer(4);
      if (config == kWatermark) {
        ++num_watermarks_;
        database_.matches.erase(*views);
        without_match_.erase(*views);
        continue;
      }
      auto matches = Matches(row, *views);
      if (config == kDegenerate) continue;
      // Also one of lines alone, which has no matches here.
      ReadPose(row, *views, matches);
      TakeMatches(*views, std::move(matches));
    }
  }

  // COLMAP has a row for each pair that it compared.
  void FindUnrelatedPairs() {
    for (const ViewPair& views : without_match_) {
      if (database_.matches.count(views) == 0 &&
          database_.relative_poses.count(views) == 0) {
        database_.scene.unrelated_pairs.push_back(views);
      }
    }
  }

  // A pose is "not set" by NULL, in databases before 4.0 also by nothing, zeros
  // or the identity without a translation. A rotation alone, which COLMAP finds
  // between panoramas, is none either: it has no direction.
  void ReadPose(const Statement& row, const ViewPair& views,
                const std::vector<FeatureMatch>& inliers) {
    if (row.IsNull(5) || row.IsNull(6)) return;
    const auto q = Numbers<double>(row.Blob(5));
    const auto t = Numbers<double>(row.Blob(6));
    if (q.empty() && t.empty()) return;
    if (q.size() != 4 || t.size() != 3) {
      row.FailRow("qvec has 4 numbers and tvec 3", ErrorCode::kParse);
    }
    const Vec4 quaternion(q[0], q[1], q[2], q[3]);
    const Vec3 translation(t[0], t[1], t[2]);
    if (!quaternion.allFinite() || !translation.allFinite()) {
      row.FailRow("the relative pose is not finite");
    }
    if (quaternion.norm() == 0 || translation.norm() == 0) return;
    RelativePose& pose = database_.relative_poses[views];
    pose.views = views;
    pose.rotation = RotationFromQuaternion(quaternion);
    pose.direction = translation.normalized();
    pose.point_inliers = inliers;
    // Ours are sorted, and name a point once.
    std::sort(pose.point_inliers.begin(), pose.point_inliers.end());
  }

  void AddNotes() {
    SceneNotes& notes = database_.notes;
    if (!unknown_.empty()) {
      notes.push_back(std::to_string(unknown_.size()) +
                      " pairs name images that the database does not have");
    }
    if (num_watermarks_ > 0) {
      notes.push_back(std::to_string(num_watermarks_) +
                      " pairs that COLMAP took for watermarks were left out");
    }
    const auto num_guessed = std::count_if(
        guessed_.begin(), guessed_.end(), [&](std::uint32_t camera) {
          return database_.scene.intrinsics.count(camera) > 0;
        });
    if (num_guessed > 0) {
      notes.push_back(
          "the focal lengths of " + std::to_string(num_guessed) +
          " cameras are COLMAP's guesses (prior_focal_length is 0)");
    }
  }

  Sqlite sqlite_;
  Database database_;
  std::map<std::uint32_t, Camera> cameras_;
  std::set<std::uint32_t> guessed_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> unknown_;
  std::set<ViewPair> without_match_;  // in one of the tables
  std::size_t num_watermarks_ = 0;
};

}  // namespace

bool IsDatabaseStart(std::string_view start) {
  return start.substr(0, kSqliteStart.size()) == kSqliteStart;
}

bool IsDatabase(const std::string& path) {
  std::string start(kSqliteStart.size(), ' ');
  std::ifstream stream(path, std::ios::binary);
  return stream.read(start.data(), static_cast<std::streamsize>(start.size()))
             .good() &&
         IsDatabaseStart(start);
}

Result<Database> ReadDatabase(const std::string& path) {
  Result<Database> database = Caught([&] {
    Database read = DatabaseReader(path).Read();
    if (Status valid = ValidateScene(read.scene); !valid) {
      throw Failure{std::move(valid.error())};
    }
    return read;
  });
  if (!database) database.error().file = path;
  return database;
}

Result<Scene> ReadDatabaseScene(const std::string& path, SceneNotes* notes) {
  Result<Database> database = ReadDatabase(path);
  if (!database) return tl::unexpected<Error>(database.error());
  Scene& scene = database->scene;
  scene.relative_poses = std::move(database->relative_poses);
  scene.point_tracks = BuildPointTracks(scene);
  notes->insert(notes->end(), database->notes.begin(), database->notes.end());
  const auto without =
      std::count_if(database->matches.begin(), database->matches.end(),
                    [&](const auto& entry) {
                      return scene.relative_poses.count(entry.first) == 0;
                    });
  if (without > 0) {
    notes->push_back("the matches of " + std::to_string(without) +
                     " pairs without a stored relative pose were left out; "
                     "`lowlap solve` estimates these poses");
  }
  return CaughtScene([&] { return std::move(scene); }, path);
}

}  // namespace lowlap::colmap
