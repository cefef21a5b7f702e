#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

#include "lowlap/core/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace lowlap::colmap {

// SQLite with errors as Failures, whose place is the table and, once there is
// one, the row.

class Sqlite {
 public:
  enum class Mode { kReadOnly, kReadWrite };

  /// Opens a file that exists. Reading leaves no file beside it, and works
  /// where none could be made, unless a program is writing to it.
  Sqlite(const std::string& path, Mode mode);

  bool HasTable(const std::string& table);
  /// kInvalidScene, with the first of these tables that is missing.
  void Require(std::initializer_list<const char*> tables);
  bool HasColumn(const std::string& table, const std::string& column);
  void Run(const std::string& sql);

  [[noreturn]] void Fail(const std::string& place) const;
  sqlite3* get() const { return connection_.get(); }

 private:
  void CheckSize(const std::string& path) const;

  struct Closer {
    void operator()(sqlite3* connection) const;
  };
  std::unique_ptr<sqlite3, Closer> connection_;
};

/// A statement about one table. Columns and parameters count from 0.
class Statement {
 public:
  /// `key`: the name of column 0 where that tells the row, else empty.
  Statement(const Sqlite& database, const std::string& sql, std::string table,
            std::string key = {});

  /// The next row; false after the last.
  bool Step();
  /// Runs a statement that returns no rows, and makes it ready for the next.
  void Execute();

  std::int64_t Integer(int column) const;
  /// Within 0 ... 2^32 - 1.
  std::uint32_t Unsigned(int column) const;
  std::string Text(int column) const;
  bool IsNull(int column) const;
  /// Bytes until the next step.
  std::string_view Blob(int column) const;

  void Bind(int parameter, std::int64_t value);
  /// The bytes must stay until the statement has run.
  void BindBlob(int parameter, std::string_view bytes);
  void BindNull(int parameter);

  [[noreturn]] void FailRow(const std::string& message,
                            ErrorCode code = ErrorCode::kInvalidScene) const;

 private:
  void Check(int code) const;

  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };
  const Sqlite& database_;
  std::string table_;
  std::string key_;
  bool has_row_ = false;
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
};

}  // namespace lowlap::colmap
