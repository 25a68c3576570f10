#include "timbre/analysis/core/column_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"

namespace timbre {
namespace {

using Eigen::Index;

[[noreturn]] void fail(const std::string& path, int code, const char* doing) {
  throw Error(ErrorKind::io, path, doing, std::generic_category().message(code));
}

std::int64_t bytes_of(ElementType type) { return type == ElementType::float64 ? 8 : 4; }

}  // namespace

ColumnFile::ColumnFile(const std::string& path, Index rows, Index cols, ElementType type,
                       bool resume)
    : path_(path), rows_(rows), type_(type) {
  const std::string header = npy_header(rows, cols, type);
  header_size_ = std::ssize(header);
  const std::int64_t size = header_size_ + rows * cols * bytes_of(type);
  try {
    resume ? reopen(header, size) : begin(header, size);
  } catch (...) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw;
  }
}

// Both are on one file system then, whatever the name is a link to.
std::string ColumnFile::unfinished(const std::string& path) {
  std::error_code missing;
  const std::filesystem::path real = std::filesystem::canonical(path, missing);
  return (missing ? path : real.string()) + ".unfinished";
}

ColumnFile::~ColumnFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

// Where space cannot be reserved the file grows as it is written.
void ColumnFile::begin(const std::string& header, std::int64_t size) {
  const std::string name = unfinished(path_);
  descriptor_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(path_, errno, "create");
#ifdef __linux__
  if (::fallocate(descriptor_, 0, 0, size) != 0 && errno != EOPNOTSUPP && errno != ENOSYS) {
    const int code = errno;
    ::unlink(name.c_str());
    fail(path_, code, "write");
  }
#else
  (void)size;
#endif
  write_at(0, header.data(), header.size());
}

void ColumnFile::reopen(const std::string& header, std::int64_t size) {
  const std::string name = unfinished(path_);
  descriptor_ = ::open(name.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) fail(name, errno, "open");
  std::string found(header.size(), '\0');
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || status.st_size > size ||
      ::pread(descriptor_, found.data(), found.size(), 0) != std::ssize(found) || found != header) {
    throw Error(ErrorKind::bad_input, name, "",
                "was begun for a matrix of another size or type of number");
  }
}

void ColumnFile::write_at(std::int64_t place, const char* data, std::size_t size) const {
  while (size > 0) {
    const ssize_t written = ::pwrite(descriptor_, data, size, place);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, errno, "write");
    data += written;
    place += written;
    size -= static_cast<std::size_t>(written);
  }
}

void ColumnFile::write(Index first, const Eigen::MatrixXd& columns) {
  const std::int64_t column_size = rows_ * bytes_of(type_);
  const std::int64_t place = header_size_ + first * column_size;
  if (type_ == ElementType::float64) {
    write_at(place, reinterpret_cast<const char*>(columns.data()),
             static_cast<std::size_t>(columns.cols() * column_size));
  } else {
    for (Index j = 0; j < columns.cols(); ++j) {
      const Eigen::VectorXf column = columns.col(j).cast<float>();
      write_at(place + j * column_size, reinterpret_cast<const char*>(column.data()),
               static_cast<std::size_t>(column_size));
    }
  }
  if (::fdatasync(descriptor_) != 0) fail(path_, errno, "write");
}

void ColumnFile::commit(bool overwrite) {
  if (::fsync(descriptor_) != 0) fail(path_, errno, "write");
  put_in_place(unfinished(path_), path_, overwrite);
}

}  // namespace timbre
