#include "timbre/cli/commands/result_log.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"

namespace timbre::cli {
namespace {

[[noreturn]] void refuse(const std::string& path, const char* what) {
  throw Error(ErrorKind::io, path, what, std::generic_category().message(errno));
}

// JSON holds UTF-8, file names any bytes. Keys have each byte that is no plain character as
// \xNN: no two names give the same.
std::string plain(const std::string& text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && c != '\\') {
      out += c;
    } else {
      out += std::string("\\x") + kHex[byte >> 4] + kHex[byte & 15];
    }
  }
  return out;
}

std::string to_bytes(const nlohmann::json& line) {
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

bool is_result(const nlohmann::json& line) {
  return line.is_object() && line.contains("key") && line["key"].is_string() &&
         line.contains("result") && line["result"].is_object();
}

}  // namespace

ResultLog::ResultLog(std::string path, const nlohmann::json& parameters, bool force)
    : path_(std::move(path)) {
  if (path_ == "-") {
    throw Error(ErrorKind::bad_request, "", "output", "a log needs a file, not standard output");
  }
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (file_ < 0) refuse(path_, "open");
  try {
    struct stat about = {};
    if (::fstat(file_, &about) != 0) refuse(path_, "open");
    if (!S_ISREG(about.st_mode)) {
      throw Error(ErrorKind::bad_request, path_, "", "is no regular file");
    }
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      throw Error(ErrorKind::bad_request, path_, "", "another run is writing to it");
    }
    // Once more: a run that has just ended may have written to it.
    if (::fstat(file_, &about) != 0) refuse(path_, "open");
    if (about.st_size == 0) {
      write_line(parameters);
    } else {
      read(parameters, force);
    }
  } catch (...) {
    ::close(file_);
    throw;
  }
}

ResultLog::~ResultLog() { ::close(file_); }

// What follows the last whole line was torn off by a crash, and is cut away.
void ResultLog::read(const nlohmann::json& parameters, bool force) {
  const std::string text = read_bytes(path_);
  const std::string first = to_bytes(parameters);
  std::size_t whole = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', whole)) {
    const std::string_view bytes = std::string_view(text).substr(whole, end - whole);
    const nlohmann::json line = nlohmann::json::parse(bytes, nullptr, false);
    const bool is_first = whole == 0;
    const bool fits =
        is_first ? bytes.size() + 1 == first.size() && first.starts_with(bytes) : is_result(line);
    if (!fits && !force) {
      throw Error(ErrorKind::bad_request, path_, "",
                  is_first ? "was made with other options, or is no log; --force begins anew"
                           : "holds a line that is no result; --force begins anew");
    }
    if (!fits) {
      known_.clear();
      whole = 0;
      break;
    }
    if (!is_first) known_[line["key"].get<std::string>()] = line["result"];
    whole = end + 1;
  }
  // Not even the first line may be whole.
  if (whole == 0 && !force && !first.starts_with(text)) {
    throw Error(ErrorKind::bad_request, path_, "", "is no log; --force begins anew");
  }
  if (::ftruncate(file_, static_cast<off_t>(whole)) != 0) refuse(path_, "write");
  if (::lseek(file_, 0, SEEK_END) < 0) refuse(path_, "write");
  was_there_ = whole > 0;
  if (whole == 0) write_line(parameters);
}

void ResultLog::write_line(const nlohmann::json& line) {
  const std::string text = to_bytes(line);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(file_, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path_, "write");
    done += static_cast<std::size_t>(count);
  }
  if (::fsync(file_) != 0) refuse(path_, "write");
}

std::optional<nlohmann::json> ResultLog::find(const std::string& key) const {
  const auto entry = known_.find(plain(key));
  if (entry == known_.end()) return std::nullopt;
  return entry->second;
}

void ResultLog::append(const std::string& key, const nlohmann::json& result) {
  write_line({{"key", plain(key)}, {"result", result}});
}

}  // namespace timbre::cli
