#include "timbre/analysis/core/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

[[noreturn]] void fail(const std::string& path, int code, const char* doing) {
  throw Error(ErrorKind::io, path, doing, std::generic_category().message(code));
}

[[noreturn]] void refuse(const std::string& path, const char* why) {
  throw Error(ErrorKind::bad_request, path, "output", why);
}

[[noreturn]] void refuse_to_replace(const std::string& path) {
  refuse(path, "exists already; --force replaces it");
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// Where the bytes really go, and the mode of the file that is there.
struct Target {
  std::string path;
  std::optional<mode_t> mode;
};

Target find_target(const std::string& path, bool overwrite) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(path, EISDIR, "output");
    if (!S_ISREG(status.st_mode)) refuse(path, "is not a regular file");
    if (!overwrite) refuse_to_replace(path);
    std::error_code failure;
    const std::filesystem::path real = std::filesystem::canonical(path, failure);
    if (failure) fail(path, failure.value(), "output");
    return {real.string(), status.st_mode & 07777U};
  }
  if (errno != ENOENT) fail(path, errno, "output");
  if (::lstat(path.c_str(), &status) == 0) refuse(path, "is a link to a file that is not there");
  return {path, std::nullopt};
}

void require_folder_takes_files(const std::string& path, const Target& target) {
  if (::faccessat(AT_FDCWD, folder_of(target.path).c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
    fail(path, errno, "create");
  }
}

// Renames unless the new name is taken, so that two writers cannot both believe they were first.
bool rename_to_free_name(const char* from, const char* to) {
#ifdef RENAME_NOREPLACE
  if (::renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
#endif
  // Some file systems cannot: NFS has links for this; on FAT the name is taken by an empty
  // file first.
  if (::link(from, to) == 0) {
    ::unlink(from);
    return true;
  }
  if (errno == EEXIST) return false;
  const int claim = ::open(to, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (claim < 0) return false;
  ::close(claim);
  if (::rename(from, to) == 0) return true;
  const int code = errno;
  ::unlink(to);
  errno = code;
  return false;
}

void rename_to(const std::string& from, const std::string& path, const Target& target,
               bool overwrite) {
  const bool renamed = overwrite ? ::rename(from.c_str(), target.path.c_str()) == 0
                                 : rename_to_free_name(from.c_str(), target.path.c_str());
  if (!renamed && errno == EEXIST) refuse_to_replace(path);
  if (!renamed) fail(path, errno, "rename");
}

// Removes the temporary file unless it became the real one.
class TemporaryFile {
 public:
  TemporaryFile(std::string path, Target target)
      : path_(std::move(path)),
        target_(std::move(target)),
        name_(target_.path + ".part." + std::to_string(::getpid())) {
    open_new();
    if (descriptor_ < 0 && errno == EEXIST) {
      // Left by a process that died and whose number came round again.
      ::unlink(name_.c_str());
      open_new();
    }
    if (descriptor_ < 0) fail(path_, errno, "create");
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view content) const {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, errno, "write");
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  void become_target(bool overwrite) {
    // File systems without modes refuse to set one; there is none to keep.
    if (target_.mode) (void)::fchmod(descriptor_, *target_.mode);
    if (::fsync(descriptor_) != 0) fail(path_, errno, "write");
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(path_, errno, "write");
    rename_to(name_, path_, target_, overwrite);
    name_.clear();
  }

 private:
  // Never open to more people than the file it replaces.
  void open_new() {
    descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                         target_.mode.value_or(0666) & 0777U);
  }

  std::string path_;  // as the caller wrote it: for errors
  Target target_;
  std::string name_;
  int descriptor_ = -1;
};

void sync_folder_of(const std::string& path) {
  const int descriptor = ::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder we may write to but not read
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

struct OutputFile::Impl {
  Target target;
  TemporaryFile temporary;
  bool overwrite;
};

OutputFile::OutputFile(const std::string& path, bool overwrite) {
  const Target target = find_target(path, overwrite);
  impl_.reset(new Impl{target, TemporaryFile(path, target), overwrite});
}

OutputFile::~OutputFile() = default;
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;

void OutputFile::write(std::string_view content) { impl_->temporary.write(content); }

void OutputFile::commit() {
  impl_->temporary.become_target(impl_->overwrite);
  sync_folder_of(impl_->target.path);
}

void write_file(const std::string& path, std::string_view content, bool overwrite) {
  OutputFile file(path, overwrite);
  file.write(content);
  file.commit();
}

void put_in_place(const std::string& from, const std::string& path, bool overwrite) {
  const Target target = find_target(path, overwrite);
  if (target.mode) (void)::chmod(from.c_str(), *target.mode);
  rename_to(from, path, target, overwrite);
  sync_folder_of(target.path);
}

void require_writable(const std::string& path, bool overwrite) {
  require_folder_takes_files(path, find_target(path, overwrite));
}

}  // namespace timbre
