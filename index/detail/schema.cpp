#include "timbre/index/detail/schema.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <span>
#include <sstream>
#include <system_error>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/index/detail/records.h"

namespace timbre::detail {
namespace {

constexpr int kFormat = 1;
constexpr char kApplicationId[] = "1953066338";  // "timb"

// Blobs of one channel lie together, so that a query reads what it compares and no more.
constexpr char kTables[] =
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL, sha256 BLOB NOT NULL)"
    " STRICT, WITHOUT ROWID;"
    "CREATE TABLE shape(id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, label TEXT NOT NULL,"
    " content BLOB NOT NULL, vertices INTEGER NOT NULL, faces INTEGER NOT NULL,"
    " area REAL NOT NULL, blobs INTEGER NOT NULL, sha256 BLOB NOT NULL) STRICT;"
    "CREATE TABLE blob(channel TEXT NOT NULL, shape INTEGER NOT NULL, version INTEGER NOT NULL,"
    " parameters TEXT NOT NULL, bytes BLOB NOT NULL, sha256 BLOB NOT NULL,"
    " PRIMARY KEY(channel, shape)) STRICT, WITHOUT ROWID;";

std::string schema_text(const Database& database) {
  std::string text;
  Statement rows(database,
                 "SELECT type, name, tbl_name, ifnull(sql, '') FROM sqlite_master ORDER BY name");
  while (rows.step()) {
    for (int column = 0; column < 4; ++column) text += rows.text(column) + '\n';
  }
  return text;
}

std::string our_schema() {
  const Database scratch(":memory:", DatabaseMode::memory);
  scratch.run(kTables);
  return schema_text(scratch);
}

std::string read_meta(const Database& database, std::string_view key) {
  Statement row(database, "SELECT value, sha256 FROM meta WHERE key = ?");
  row.bind(1, key);
  if (!row.step()) throw damaged(database.path(), std::string(key));
  std::string value = row.text(0);
  if (!same_bytes(digest_of_meta(key, value), row.blob(1))) {
    throw damaged(database.path(), std::string(key));
  }
  return value;
}

void write_meta(const Database& database, std::string_view key, std::string_view value) {
  Statement(database, "INSERT OR REPLACE INTO meta(key, value, sha256) VALUES(?, ?, ?)")
      .bind(1, key)
      .bind(2, value)
      .bind(3, as_blob(digest_of_meta(key, value)))
      .run();
}

void require_write_ahead_log(const Database& database) {
  if (database.ask("PRAGMA journal_mode = WAL") != "wal") {
    throw Error(ErrorKind::io, database.path(), "",
                "this file system holds no write-ahead log; use a local disk");
  }
}

void require_ours(const Database& database) {
  if (database.ask("PRAGMA application_id") != kApplicationId) {
    throw Error(ErrorKind::bad_input, database.path(), "", "not a timbre database");
  }
  const std::string format = database.ask("PRAGMA user_version");
  if (format != std::to_string(kFormat)) {
    throw Error(ErrorKind::bad_input, database.path(), "",
                "has format " + format + ", this timbre reads format " + std::to_string(kFormat) +
                    "; use a newer timbre");
  }
  if (schema_text(database) != our_schema()) {
    throw Error(ErrorKind::bad_input, database.path(), "",
                "not a timbre database: its tables are not ours");
  }
}

// Removes the unfinished database and what SQLite keeps beside it.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(std::string path) : path_(std::move(path)) { remove(); }
  ~UnfinishedFile() { remove(); }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

  void become(const std::string& target) const {
    // link() refuses to replace, so two creators cannot both believe they were first.
    if (::link(path_.c_str(), target.c_str()) == 0) return;
    if (errno == EEXIST) throw Error(ErrorKind::bad_request, target, "", "exists already");
    throw Error(ErrorKind::io, target, "create", std::generic_category().message(errno));
  }

 private:
  void remove() const {
    for (const char* const ending : {"", "-wal", "-shm", "-journal"}) {
      ::unlink((path_ + ending).c_str());
    }
  }
  std::string path_;
};

void sync(const std::string& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder we may write to but not read
  const int code = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (code != 0) throw Error(ErrorKind::io, path, "create", std::generic_category().message(code));
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

Database open_checked(const std::string& path, DatabaseMode mode) {
  Database database(path, mode);
  require_ours(database);
  return database;
}

// A database with a write-ahead log wants a shared-memory file beside it. Where that
// cannot be made and no log is left, the file is whole and can be read as it stands.
Database open_for_reading(const std::string& path) {
  try {
    return open_checked(path, DatabaseMode::reading);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::io || ::access(folder_of(path).c_str(), W_OK) == 0) throw;
    struct stat log {};
    if (::stat((path + "-wal").c_str(), &log) == 0 && log.st_size > 0) {
      throw Error(ErrorKind::io, path, "",
                  "a writer's log lies beside it, and this folder may not be written; "
                  "open it once where it may, or copy both files there");
    }
  }
  return open_checked(path, DatabaseMode::immutable);
}

template <typename Kind>
std::optional<Kind> from_word(const std::string& word, std::span<const Kind> kinds) {
  for (const Kind kind : kinds) {
    if (word == to_word(kind)) return kind;
  }
  return std::nullopt;
}

}  // namespace

Error damaged(const std::string& path, const std::string& place) {
  return {ErrorKind::bad_input, path, place,
          "checksum differs; run 'timbre db verify " + path + "'"};
}

void Roster::put_in(const Sha256Digest& row) {
  ++count;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] ^= row[i];
}

void Roster::take_out(const Sha256Digest& row) {
  put_in(row);
  count -= 2;
}

void create_database(const std::string& path, const StoreParameters& parameters) {
  if (std::filesystem::symlink_status(path).type() != std::filesystem::file_type::not_found) {
    throw Error(ErrorKind::bad_request, path, "", "exists already");
  }
  const UnfinishedFile unfinished(path + ".part." + std::to_string(::getpid()));
  try {
    const Database database(unfinished.path(), DatabaseMode::create);
    Transaction transaction(database, Transaction::Kind::write);
    database.run(kTables);
    database.run(("PRAGMA application_id = " + std::string(kApplicationId)).c_str());
    database.run(("PRAGMA user_version = " + std::to_string(kFormat)).c_str());
    write_meta(database, "parameters", canonical_text(to_parameters(parameters)));
    write_roster(database, {});
    transaction.commit();
    require_write_ahead_log(database);
  } catch (const Error& error) {
    throw error.in_file(path);
  }
  sync(unfinished.path(), O_RDONLY);
  unfinished.become(path);
  sync(folder_of(path), O_RDONLY | O_DIRECTORY);
}

Database open_database(const std::string& path, StoreAccess access) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw Error(ErrorKind::io, path, "", std::generic_category().message(errno));
  }
  if (!S_ISREG(status.st_mode)) {
    throw Error(ErrorKind::bad_input, path, "", "not a timbre database");
  }
  if (access == StoreAccess::read) return open_for_reading(path);
  Database database = open_checked(path, DatabaseMode::read_write);
  require_write_ahead_log(database);
  return database;
}

StoreParameters read_parameters(const Database& database) {
  const std::string text = read_meta(database, "parameters");
  Parameters found;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) found[word.substr(0, equals)] = word.substr(equals + 1);
  }
  const auto kind = from_word<OperatorKind>(found["operator"], kOperatorKinds);
  const auto mass = from_word<MassKind>(found["mass"], kMassKinds);
  const auto count = parse_integer(found["k"]);
  StoreParameters parameters;
  if (kind) parameters.operator_kind = *kind;
  if (mass) parameters.mass = *mass;
  if (count) parameters.count = static_cast<int>(*count);
  if (canonical_text(to_parameters(parameters)) != text) {
    throw Error(ErrorKind::bad_input, database.path(), "parameters",
                "'" + text + "' is unknown to this timbre; use a newer one");
  }
  return parameters;
}

Roster read_roster(const Database& database) {
  const std::string text = read_meta(database, "roster");
  Roster roster;
  const std::size_t space = text.find(' ');
  const auto count = parse_integer(std::string_view(text).substr(0, space));
  const std::string hex = space == std::string::npos ? "" : text.substr(space + 1);
  if (!count || hex.size() != 2 * roster.sum.size()) throw damaged(database.path(), "roster");
  roster.count = *count;
  for (std::size_t i = 0; i < roster.sum.size(); ++i) {
    std::from_chars(hex.data() + 2 * i, hex.data() + 2 * i + 2, roster.sum[i], 16);
  }
  return roster;
}

void write_roster(const Database& database, const Roster& roster) {
  write_meta(database, "roster", std::to_string(roster.count) + ' ' + to_hex(roster.sum));
}

}  // namespace timbre::detail
