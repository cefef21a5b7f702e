#include "third_party_adapters/colmap/internal/sqlite.h"

#include <sqlite3.h>

#include <filesystem>
#include <limits>
#include <system_error>

#include "lowlap/core/internal/format.h"
#include "lowlap/io/internal/failure.h"

namespace lowlap::colmap {
namespace {

// A path as the URI that SQLite wants for its options. Behind two slashes it
// looks for a host, which is none here, whatever the path begins with.
std::string FileUri(const std::string& path) {
  std::string uri =
      std::filesystem::path(path).is_absolute() ? "file://" : "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#') {
      uri += Format("%%%02X", static_cast<unsigned>(c));
    } else {
      uri += c;
    }
  }
  return uri;
}

bool HasContent(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return !error && size > 0;
}

}  // namespace

Sqlite::Sqlite(const std::string& path, Mode mode) {
  std::string uri = FileUri(path);
  // Nobody writes to a database without a log.
  const bool is_at_rest =
      !HasContent(path + "-wal") && !HasContent(path + "-journal");
  if (mode == Mode::kReadOnly) {
    uri += "?mode=ro";
    // COLMAP's databases are in write-ahead mode, where readers, too, make
    // files, unless they are told that nobody writes.
    if (is_at_rest) uri += "&immutable=1";
  }
  const int flags =
      SQLITE_OPEN_URI |
      (mode == Mode::kReadOnly ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE);
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &connection, flags, nullptr);
  connection_.reset(connection);
  if (code != SQLITE_OK) Fail({});
  sqlite3_busy_timeout(connection, 10000);
  if (is_at_rest) CheckSize(path);
}

// SQLite takes the rest of a last page that is cut off for zeros.
void Sqlite::CheckSize(const std::string& path) const {
  Statement size(*this,
                 "SELECT page_count * page_size FROM pragma_page_count, "
                 "pragma_page_size",
                 "sqlite_schema");
  std::error_code error;
  const auto file_size = std::filesystem::file_size(path, error);
  if (!error && size.Step() &&
      file_size < static_cast<std::uintmax_t>(size.Integer(0))) {
    throw Failure{Error{ErrorCode::kParse,
                        "the file ends early",
                        {},
                        "byte " + std::to_string(file_size)}};
  }
}

void Sqlite::Closer::operator()(sqlite3* connection) const {
  sqlite3_close(connection);
}

void Sqlite::Fail(const std::string& place) const {
  const int code = sqlite3_errcode(get()) & 0xFF;
  const bool is_content = code == SQLITE_CORRUPT || code == SQLITE_NOTADB ||
                          code == SQLITE_ERROR;  // a column is missing
  throw Failure{Error{is_content ? ErrorCode::kParse : ErrorCode::kIo,
                      std::string("SQLite: ") + sqlite3_errmsg(get()),
                      {},
                      place}};
}

bool Sqlite::HasTable(const std::string& table) { return HasColumn(table, {}); }

void Sqlite::Require(std::initializer_list<const char*> tables) {
  for (const char* table : tables) {
    if (HasTable(table)) continue;
    throw Failure{Error{ErrorCode::kInvalidScene,
                        "not a database of COLMAP: it has no such table",
                        {},
                        std::string("table ") + table}};
  }
}

bool Sqlite::HasColumn(const std::string& table, const std::string& column) {
  Statement columns(
      *this, "SELECT name FROM pragma_table_info('" + table + "')", table);
  while (columns.Step()) {
    if (column.empty() || columns.Text(0) == column) return true;
  }
  return false;
}

void Sqlite::Run(const std::string& sql) {
  if (sqlite3_exec(get(), sql.c_str(), nullptr, nullptr, nullptr) !=
      SQLITE_OK) {
    Fail({});
  }
}

Statement::Statement(const Sqlite& database, const std::string& sql,
                     std::string table, std::string key)
    : database_(database), table_(std::move(table)), key_(std::move(key)) {
  sqlite3_stmt* statement = nullptr;
  Check(
      sqlite3_prepare_v2(database.get(), sql.c_str(), -1, &statement, nullptr));
  statement_.reset(statement);
}

void Statement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

bool Statement::Step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    database_.Fail("table " + table_);
  }
  has_row_ = code == SQLITE_ROW;
  return has_row_;
}

void Statement::Execute() {
  Step();
  sqlite3_reset(statement_.get());
}

void Statement::FailRow(const std::string& message, ErrorCode code) const {
  std::string place = "table " + table_;
  if (has_row_ && !key_.empty()) place += ", " + key_ + " " + Text(0);
  throw Failure{Error{code, message, {}, place}};
}

void Statement::Check(int code) const {
  if (code != SQLITE_OK) database_.Fail("table " + table_);
}

std::int64_t Statement::Integer(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER) {
    FailRow(std::string(sqlite3_column_name(statement_.get(), column)) +
            " is not an integer");
  }
  return sqlite3_column_int64(statement_.get(), column);
}

std::uint32_t Statement::Unsigned(int column) const {
  const std::int64_t value = Integer(column);
  if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
    FailRow(std::string(sqlite3_column_name(statement_.get(), column)) +
            " is out of range");
  }
  return static_cast<std::uint32_t>(value);
}

std::string Statement::Text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

bool Statement::IsNull(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::string_view Statement::Blob(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const char*>(bytes),
          bytes == nullptr ? 0 : static_cast<std::size_t>(size)};
}

void Statement::Bind(int parameter, std::int64_t value) {
  Check(sqlite3_bind_int64(statement_.get(), parameter + 1, value));
}

void Statement::BindBlob(int parameter, std::string_view bytes) {
  // An empty blob is one, where a null pointer would be NULL.
  Check(sqlite3_bind_blob64(statement_.get(), parameter + 1,
                            bytes.empty() ? "" : bytes.data(), bytes.size(),
                            SQLITE_STATIC));
}

void Statement::BindNull(int parameter) {
  Check(sqlite3_bind_null(statement_.get(), parameter + 1));
}

}  // namespace lowlap::colmap
