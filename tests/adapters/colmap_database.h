#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lowlap {

/// A database of COLMAP made by SQL, as its versions make them.
class ColmapDatabase {
 public:
  enum class Version { k3_6, k3_8, k4_0 };

  ColmapDatabase(const std::string& path, Version version) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &connection_), SQLITE_OK);
    const bool has_pose = version != Version::k3_6;
    Run("CREATE TABLE cameras(camera_id INTEGER PRIMARY KEY AUTOINCREMENT "
        "NOT NULL, model INTEGER NOT NULL, width INTEGER NOT NULL, height "
        "INTEGER NOT NULL, params BLOB, prior_focal_length INTEGER NOT NULL)");
    Run(std::string("CREATE TABLE images(image_id INTEGER PRIMARY KEY "
                    "AUTOINCREMENT NOT NULL, name TEXT NOT NULL UNIQUE, "
                    "camera_id INTEGER NOT NULL") +
        (version == Version::k4_0 ? ")" : ", prior_qw REAL, prior_tx REAL)"));
    Run("CREATE TABLE keypoints(image_id INTEGER PRIMARY KEY NOT NULL, rows "
        "INTEGER NOT NULL, cols INTEGER NOT NULL, data BLOB)");
    Run("CREATE TABLE matches(pair_id INTEGER PRIMARY KEY NOT NULL, rows "
        "INTEGER NOT NULL, cols INTEGER NOT NULL, data BLOB)");
    Run(std::string("CREATE TABLE two_view_geometries(pair_id INTEGER PRIMARY "
                    "KEY NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT "
                    "NULL, data BLOB, config INTEGER NOT NULL, F BLOB, E BLOB, "
                    "H BLOB") +
        (has_pose ? ", qvec BLOB, tvec BLOB)" : ")"));
    Run(version == Version::k4_0   ? "PRAGMA user_version = 4000000"
        : version == Version::k3_8 ? "PRAGMA user_version = 3800"
                                   : "PRAGMA user_version = 3600");
  }
  ~ColmapDatabase() { sqlite3_close(connection_); }
  ColmapDatabase(const ColmapDatabase&) = delete;
  ColmapDatabase& operator=(const ColmapDatabase&) = delete;

  void Run(const std::string& sql) {
    char* message = nullptr;
    EXPECT_EQ(
        sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, &message),
        SQLITE_OK)
        << sql << ": " << (message ? message : "");
    sqlite3_free(message);
  }

  /// Numbers as an SQL literal of their bytes.
  template <class T>
  static std::string Blob(const std::vector<T>& numbers) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text = "x'";
    const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    for (std::size_t n = 0; n < numbers.size() * sizeof(T); ++n) {
      text += kDigits[bytes[n] >> 4];
      text += kDigits[bytes[n] & 15];
    }
    return text + "'";
  }

  static std::string PairId(std::int64_t first, std::int64_t second) {
    return std::to_string(2147483647 * first + second);
  }

  void AddCamera(int id, int model, int width, int height,
                 const std::vector<double>& params, bool has_prior = true) {
    Run("INSERT INTO cameras VALUES(" + std::to_string(id) + ", " +
        std::to_string(model) + ", " + std::to_string(width) + ", " +
        std::to_string(height) + ", " + Blob(params) +
        (has_prior ? ", 1)" : ", 0)"));
  }
  /// With keypoints of `cols` numbers each.
  void AddImage(int id, const std::string& name, int camera,
                const std::vector<float>& keypoints, std::size_t cols) {
    Run("INSERT INTO images(image_id, name, camera_id) VALUES(" +
        std::to_string(id) + ", '" + name + "', " + std::to_string(camera) +
        ")");
    Run("INSERT INTO keypoints VALUES(" + std::to_string(id) + ", " +
        std::to_string(keypoints.size() / cols) + ", " + std::to_string(cols) +
        ", " + Blob(keypoints) + ")");
  }
  void AddMatches(int first, int second,
                  const std::vector<std::uint32_t>& matches) {
    Run("INSERT INTO matches VALUES(" + PairId(first, second) + ", " +
        std::to_string(matches.size() / 2) + ", 2, " + Blob(matches) + ")");
  }
  /// `pose`: values of qvec and tvec, with a comma before each, if the version
  /// has these columns.
  void AddGeometry(int first, int second,
                   const std::vector<std::uint32_t>& matches, int config,
                   const std::string& pose) {
    Run("INSERT INTO two_view_geometries VALUES(" + PairId(first, second) +
        ", " + std::to_string(matches.size() / 2) + ", 2, " + Blob(matches) +
        ", " + std::to_string(config) + ", NULL, NULL, NULL" + pose + ")");
  }

  /// The only value of a query, as text; blobs in hexadecimal by hex().
  std::string Query(const std::string& sql) {
    std::string text;
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(
        sqlite3_prepare_v2(connection_, sql.c_str(), -1, &statement, nullptr),
        SQLITE_OK)
        << sql;
    if (sqlite3_step(statement) == SQLITE_ROW) {
      const void* bytes = sqlite3_column_blob(statement, 0);
      const int size = sqlite3_column_bytes(statement, 0);
      text.assign(static_cast<const char*>(bytes),
                  static_cast<std::size_t>(size));
    }
    sqlite3_finalize(statement);
    return text;
  }

 private:
  sqlite3* connection_ = nullptr;
};

}  // namespace lowlap
