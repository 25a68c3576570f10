#include "timbre/index/detail/sqlite.h"

#include <sqlite3.h>

#include <new>
#include <system_error>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {
namespace {

constexpr int kBusyTimeoutMilliseconds = 30000;

// Percent-encodes what an SQLite URI would read as something else.
std::string to_uri(const std::string& path) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#') {
      const auto byte = static_cast<unsigned char>(c);
      uri += '%';
      uri += kHex[byte >> 4];
      uri += kHex[byte & 15];
    } else {
      uri += c;
    }
  }
  return uri + "?immutable=1";
}

int open_flags(DatabaseMode mode) {
  switch (mode) {
    case DatabaseMode::immutable:
      return SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
    case DatabaseMode::memory:
      return SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY;
    case DatabaseMode::create:
      return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
    case DatabaseMode::reading:
    case DatabaseMode::read_write:
      break;
  }
  // Also for reading: SQLite falls back by itself where the file may not be written, and
  // a connection opened read-only would leave its log behind.
  return SQLITE_OPEN_READWRITE;
}

Error error_of(sqlite3* handle, const std::string& path) {
  const int code = sqlite3_errcode(handle);
  const int system = sqlite3_system_errno(handle);
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return {ErrorKind::bad_input, path, "", "not a timbre database"};
    case SQLITE_CORRUPT:
      return {ErrorKind::bad_input, path, "", "damaged: " + std::string(sqlite3_errmsg(handle))};
    case SQLITE_BUSY:
      return {ErrorKind::io, path, "", "another process kept it locked for 30 s"};
    case SQLITE_FULL:
      return {ErrorKind::io, path, "write", "the disk is full"};
    default:
      break;
  }
  std::string cause = sqlite3_errmsg(handle);
  if (system != 0) cause += " (" + std::generic_category().message(system) + ")";
  return {ErrorKind::io, path, "", cause};
}

}  // namespace

void Database::Closer::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

Database::Database(const std::string& path, DatabaseMode mode) : path_(path) {
  // SQLite gives a meaning to an empty name and to names that start with a colon.
  std::string name = path.empty() || path[0] == ':' ? "./" + path : path;
  if (mode == DatabaseMode::memory) name = ":memory:";
  if (mode == DatabaseMode::immutable) name = to_uri(name);
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &raw, open_flags(mode), nullptr);
  handle_.reset(raw);
  if (raw == nullptr) throw std::bad_alloc();
  if (code != SQLITE_OK) fail();
  sqlite3_extended_result_codes(raw, 1);
  sqlite3_busy_timeout(raw, kBusyTimeoutMilliseconds);
  // The file is data: nothing in it may run, nor be reached by way of the schema.
  sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  run("PRAGMA cell_size_check = ON");
  run("PRAGMA synchronous = FULL");
  if (mode == DatabaseMode::reading) run("PRAGMA query_only = ON");
}

void Database::fail() const { throw error_of(handle_.get(), path_); }

void Database::run(const char* sql) const {
  if (sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

std::string Database::ask(const char* sql) const {
  Statement statement(*this, sql);
  return statement.step() ? statement.text(0) : std::string();
}

void Statement::Closer::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(const Database& database, std::string_view sql) : database_(&database) {
  sqlite3_stmt* raw = nullptr;
  const int code = sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()),
                                      &raw, nullptr);
  statement_.reset(raw);
  check(code);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) database_->fail();
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(statement_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  check(sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::byte> blob) {
  // A null pointer would bind NULL; an empty blob is a blob.
  const void* const data = blob.empty() ? static_cast<const void*>("") : blob.data();
  check(sqlite3_bind_blob64(statement_.get(), parameter, data, blob.size(), SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_->fail();
  return code == SQLITE_ROW;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string Statement::text(int column) const {
  const auto* const text = sqlite3_column_text(statement_.get(), column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::span<const std::byte> Statement::blob(int column) const {
  const void* const data = sqlite3_column_blob(statement_.get(), column);
  if (data == nullptr) return {};
  return {static_cast<const std::byte*>(data),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

Transaction::Transaction(const Database& database, Kind kind) : database_(database) {
  database_.run(kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  if (open_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace timbre::detail
