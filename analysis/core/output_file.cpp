#include "timbre/analysis/core/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

[[noreturn]] void fail(const std::string& path, int code, const char* doing) {
  throw Error(ErrorKind::io, path, doing, std::generic_category().message(code));
}

// Removes the temporary file unless it became the real one.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path)
      : name_(path + ".part." + std::to_string(::getpid())) {
    descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == EEXIST) {
      // Left by a process that died and whose number came round again.
      ::unlink(name_.c_str());
      descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (descriptor_ < 0) fail(path, errno, "create");
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(const std::string& path, std::string_view content) const {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path, errno, "write");
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  void become(const std::string& path, bool overwrite) {
    if (::fsync(descriptor_) != 0) fail(path, errno, "write");
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(path, errno, "write");
    // link() refuses to replace, so two writers cannot both believe they were first.
    if (!overwrite && ::link(name_.c_str(), path.c_str()) != 0) {
      if (errno != EEXIST) fail(path, errno, "create");
      throw Error(ErrorKind::bad_request, path, "output", "exists already; --force replaces it");
    }
    if (overwrite) {
      if (::rename(name_.c_str(), path.c_str()) != 0) fail(path, errno, "rename");
      name_.clear();
    }
  }

 private:
  std::string name_;
  int descriptor_ = -1;
};

void sync_folder_of(const std::string& path) {
  std::string folder = std::filesystem::path(path).parent_path().string();
  if (folder.empty()) folder = ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder we may write to but not read
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_file(const std::string& path, std::string_view content, bool overwrite) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(path, EISDIR, "output");
    if (!overwrite) {
      throw Error(ErrorKind::bad_request, path, "output", "exists already; --force replaces it");
    }
  }
  {
    TemporaryFile temporary(path);
    temporary.write(path, content);
    temporary.become(path, overwrite);
  }
  sync_folder_of(path);
}

}  // namespace timbre
