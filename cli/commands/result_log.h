#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace timbre::cli {

/// Results of a long evaluation, kept as they come: a file of JSON lines, the first of which
/// tells what they were made with. A run that was interrupted goes on from it.
class ResultLog {
 public:
  /// @param parameters  of this run; a log made with others is refused, or with `force`
  ///                    begun anew
  /// @throws Error  io; bad_request for other parameters or a file that is no such log
  ResultLog(std::string path, const nlohmann::json& parameters, bool force);
  ~ResultLog();
  ResultLog(const ResultLog&) = delete;
  ResultLog& operator=(const ResultLog&) = delete;

  [[nodiscard]] std::size_t kept() const { return known_.size(); }
  /// Whether an earlier run with these parameters began it.
  [[nodiscard]] bool was_there() const { return was_there_; }
  [[nodiscard]] std::optional<nlohmann::json> find(const std::string& key) const;

  /// The line is on the disk when this returns.
  /// @throws Error  io
  void append(const std::string& key, const nlohmann::json& result);

 private:
  void read(const nlohmann::json& parameters, bool force);
  void write_line(const nlohmann::json& line);

  std::string path_;
  std::map<std::string, nlohmann::json> known_;
  int file_ = -1;
  bool was_there_ = false;
};

}  // namespace timbre::cli
