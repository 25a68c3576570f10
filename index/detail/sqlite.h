#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

// A thin, safe layer over SQLite: handles that close themselves, errors that throw.
namespace timbre::detail {

enum class DatabaseMode : std::uint8_t {
  reading,  ///< never changes content; may tidy up the log, as any last user does
  read_write,
  create,
  memory,     ///< of its own, gone with the connection
  immutable,  ///< promises SQLite that nobody writes: for folders without write permission
};

/// One connection; used by one thread at a time.
class Database {
 public:
  /// @throws Error  io or bad_input, with `path` as its file
  Database(const std::string& path, DatabaseMode mode);

  void run(const char* sql) const;
  /// The first column of the first row as text; empty if there is none.
  [[nodiscard]] std::string ask(const char* sql) const;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  /// Throws what the last failed call of this connection means to a person.
  [[noreturn]] void fail() const;

 private:
  struct Closer {
    void operator()(sqlite3* handle) const;
  };
  std::string path_;
  std::unique_ptr<sqlite3, Closer> handle_;
};

/// A prepared statement. Parameters count from 1, columns from 0.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::span<const std::byte> blob);

  /// True: a row is there to read.
  bool step();
  /// For statements that return no rows.
  void run() {
    while (step()) {
    }
  }

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  /// Valid until the next step.
  [[nodiscard]] std::span<const std::byte> blob(int column) const;

 private:
  struct Closer {
    void operator()(sqlite3_stmt* statement) const;
  };
  void check(int code) const;

  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Closer> statement_;
};

/// Rolls back unless committed.
class Transaction {
 public:
  enum class Kind : std::uint8_t {
    read,   ///< one snapshot for several statements
    write,  ///< takes the write lock at once, so that it cannot fail half way for want of it
  };
  Transaction(const Database& database, Kind kind);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void commit();

 private:
  const Database& database_;
  bool open_ = true;
};

}  // namespace timbre::detail
