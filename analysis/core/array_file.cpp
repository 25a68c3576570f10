#include "timbre/analysis/core/array_file.h"

#include <zlib.h>

#include <bit>
#include <limits>
#include <string_view>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie");

std::string npy(std::string_view type, bool fortran, const std::string& shape, const void* data,
                std::size_t bytes) {
  constexpr std::size_t kPreamble = 10;
  std::string header = "{'descr': '" + std::string(type) +
                       "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': (" +
                       shape + "), }";
  header.append(63 - (kPreamble + header.size()) % 64, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size() & 0xff);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  if (bytes > 0) out.append(static_cast<const char*>(data), bytes);
  return out;
}

std::string shape_of(Eigen::Index rows, Eigen::Index cols) {
  return std::to_string(rows) + ", " + std::to_string(cols);
}

template <typename Array>
std::size_t bytes_of(const Array& array) {
  return static_cast<std::size_t>(array.size()) * sizeof(typename Array::Scalar);
}

class ZipWriter {
 public:
  void add(const NamedArray& array) {
    const std::string name = array.name + ".npy";
    const auto crc = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(array.bytes.data()), array.bytes.size()));
    const auto size = checked(array.bytes.size());
    const std::uint32_t start = checked(out_.size());
    const auto fields = [&](std::string& to) {
      number(to, 20, 2);  // version needed
      number(to, 0, 2);   // flags
      number(to, 0, 2);   // stored
      number(to, 0, 2);   // time
      number(to, 33, 2);  // date: 1 January 1980
      number(to, crc, 4);
      number(to, size, 4);
      number(to, size, 4);
      number(to, name.size(), 2);
      number(to, 0, 2);  // extra
    };
    number(out_, 0x04034b50, 4);
    fields(out_);
    out_ += name;
    out_ += array.bytes;
    number(directory_, 0x02014b50, 4);
    number(directory_, 20, 2);  // version made by
    fields(directory_);
    number(directory_, 0, 2);  // comment
    number(directory_, 0, 2);  // disk
    number(directory_, 0, 2);  // internal attributes
    number(directory_, 0, 4);  // external attributes
    number(directory_, start, 4);
    directory_ += name;
    ++count_;
  }

  std::string finish() {
    const std::uint32_t start = checked(out_.size());
    out_ += directory_;
    number(out_, 0x06054b50, 4);
    number(out_, 0, 2);
    number(out_, 0, 2);
    number(out_, count_, 2);
    number(out_, count_, 2);
    number(out_, checked(directory_.size()), 4);
    number(out_, start, 4);
    number(out_, 0, 2);
    return std::move(out_);
  }

 private:
  static void number(std::string& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>((value >> (8 * i)) & 0xff);
  }

  static std::uint32_t checked(std::size_t size) {
    if (size > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorKind::bad_request, "", "npz",
                  "holds at most 4 GiB; write the arrays to .npy files");
    }
    return static_cast<std::uint32_t>(size);
  }

  std::string out_, directory_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::string npy_header(Eigen::Index rows, Eigen::Index cols) {
  return cols == 1 ? npy("<f8", false, std::to_string(rows) + ",", nullptr, 0)
                   : npy("<f8", true, shape_of(rows, cols), nullptr, 0);
}

std::string to_npy(const Eigen::MatrixXd& matrix) {
  return npy("<f8", true, shape_of(matrix.rows(), matrix.cols()), matrix.data(), bytes_of(matrix));
}

std::string to_npy(const Eigen::VectorXd& vector) {
  return npy("<f8", false, std::to_string(vector.size()) + ",", vector.data(), bytes_of(vector));
}

std::string to_npy(const Eigen::VectorXi& vector) {
  return npy("<i4", false, std::to_string(vector.size()) + ",", vector.data(), bytes_of(vector));
}

std::string to_npy(const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>& points) {
  return npy("<f8", false, shape_of(points.rows(), 3), points.data(), bytes_of(points));
}

std::string to_npy(const Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>& faces) {
  return npy("<i4", false, shape_of(faces.rows(), 3), faces.data(), bytes_of(faces));
}

std::string to_npy(const std::string& ascii) {
  std::u32string wide(ascii.begin(), ascii.end());
  return npy("<U" + std::to_string(wide.size()), false, "", wide.data(),
             wide.size() * sizeof(char32_t));
}

std::string to_npz(const std::vector<NamedArray>& arrays) {
  ZipWriter zip;
  for (const NamedArray& array : arrays) zip.add(array);
  return zip.finish();
}

}  // namespace timbre
