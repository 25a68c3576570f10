#include "timbre/analysis/core/array_file.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"

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

Error npy_error(const std::string& place, const std::string& cause) {
  return {ErrorKind::bad_input, "", place, cause};
}

// Reads the header, a dictionary as Python writes it, from front to back.
class NpyHeaderReader {
 public:
  explicit NpyHeaderReader(std::string_view text) : rest_(text) {}

  NpyView read() {
    NpyView header;
    unsigned seen = 0;
    expect('{');
    while (!accept('}')) {
      const std::string_view key = quoted();
      expect(':');
      if (key == "descr") {
        header.type = quoted();
      } else if (key == "fortran_order") {
        header.is_fortran = truth();
      } else if (key == "shape") {
        header.shape = shape();
      } else {
        throw malformed();
      }
      const unsigned bit = key == "descr" ? 1U : key == "shape" ? 2U : 4U;
      if ((seen & bit) != 0) throw malformed();
      seen |= bit;
      if (!accept(',') && (skip_blanks(), !rest_.starts_with('}'))) throw malformed();
    }
    skip_blanks();
    if (seen != 7 || !rest_.empty()) throw malformed();
    return header;
  }

 private:
  static Error malformed() { return npy_error("header", "is not as NumPy writes it"); }

  void skip_blanks() {
    while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\n')) rest_.remove_prefix(1);
  }

  bool accept(char wanted) {
    skip_blanks();
    if (!rest_.starts_with(wanted)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  void expect(char wanted) {
    if (!accept(wanted)) throw malformed();
  }

  std::string_view quoted() {
    expect('\'');
    const std::size_t end = rest_.find('\'');
    if (end == std::string_view::npos) throw malformed();
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return word;
  }

  bool truth() {
    skip_blanks();
    for (const std::string_view word : {"True", "False"}) {
      if (!rest_.starts_with(word)) continue;
      rest_.remove_prefix(word.size());
      return word == "True";
    }
    throw malformed();
  }

  std::vector<std::int64_t> shape() {
    std::vector<std::int64_t> sizes;
    expect('(');
    while (!accept(')')) {
      skip_blanks();
      std::size_t digits = 0;
      while (digits < rest_.size() && rest_[digits] >= '0' && rest_[digits] <= '9') ++digits;
      const std::optional<std::int64_t> size = parse_integer(rest_.substr(0, digits));
      if (!size) throw malformed();
      sizes.push_back(*size);
      rest_.remove_prefix(digits);
      if (!accept(',') && !rest_.starts_with(')')) throw malformed();
    }
    return sizes;
  }

  std::string_view rest_;
};

double to_double(std::int64_t value) {
  constexpr std::int64_t kLargest = std::int64_t{1} << 53;
  if (value < -kLargest || value > kLargest) {
    throw npy_error("data", std::to_string(value) + " is beyond the integers that a double holds");
  }
  return static_cast<double>(value);
}

template <typename Scalar>
Eigen::MatrixXd npy_matrix(const NpyView& header) {
  const std::string_view data = header.data;
  const std::int64_t rows = header.shape[0];
  const std::int64_t cols = header.shape.size() == 2 ? header.shape[1] : 1;
  const auto count = static_cast<std::int64_t>(data.size() / sizeof(Scalar));
  // By division: the product of the two may be beyond 64 bits.
  const bool fits = cols == 0 ? count == 0 : count % cols == 0 && count / cols == rows;
  if (!fits || data.size() % sizeof(Scalar) != 0) {
    throw npy_error(
        "data", "is " + std::to_string(data.size()) + " bytes, another size than its header says");
  }
  Eigen::MatrixXd matrix(rows, cols);
  if (count == 0) return matrix;  // of as many rows as the header likes, all of them empty
  for (std::int64_t i = 0; i < rows; ++i) {
    for (std::int64_t j = 0; j < cols; ++j) {
      Scalar value{};
      const std::int64_t at = header.is_fortran ? j * rows + i : i * cols + j;
      std::memcpy(&value, data.data() + static_cast<std::size_t>(at) * sizeof(Scalar),
                  sizeof(Scalar));
      if constexpr (std::is_same_v<Scalar, std::int64_t>) {
        matrix(i, j) = to_double(value);
      } else {
        matrix(i, j) = static_cast<double>(value);
      }
    }
  }
  return matrix;
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

std::string npy_header(Eigen::Index rows, Eigen::Index cols, ElementType type) {
  return npy(type == ElementType::float64 ? "<f8" : "<f4", true, shape_of(rows, cols), nullptr, 0);
}

std::string npy_vector_header(Eigen::Index size) {
  return npy("<f8", false, std::to_string(size) + ",", nullptr, 0);
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

NpyView view_npy(std::string_view bytes) {
  if (!bytes.starts_with("\x93NUMPY") || bytes.size() < 10) {
    throw npy_error("", "is not a NumPy array");
  }
  const int version = static_cast<unsigned char>(bytes[6]);
  if (version != 1 && version != 2) {
    throw npy_error("header", "has format " + std::to_string(version) + "; 1 and 2 are read");
  }
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  std::size_t length = 0;
  bytes.remove_prefix(8);
  if (bytes.size() >= length_bytes) std::memcpy(&length, bytes.data(), length_bytes);
  if (bytes.size() < length_bytes || bytes.size() - length_bytes < length) {
    throw npy_error("header", "ends too soon");
  }
  NpyView view = NpyHeaderReader(bytes.substr(length_bytes, length)).read();
  view.data = bytes.substr(length_bytes + length);
  return view;
}

Eigen::MatrixXd from_npy(std::string_view bytes) {
  const NpyView header = view_npy(bytes);
  if (header.shape.size() != 1 && header.shape.size() != 2) {
    throw npy_error("header", "gives the array " + std::to_string(header.shape.size()) +
                                  " dimensions; 1 and 2 are read");
  }
  if (header.type == "<f8") return npy_matrix<double>(header);
  if (header.type == "<f4") return npy_matrix<float>(header);
  if (header.type == "<i8") return npy_matrix<std::int64_t>(header);
  if (header.type == "<i4") return npy_matrix<std::int32_t>(header);
  throw npy_error("header", "gives the type '" + header.type.substr(0, 40) +
                                "'; <f8, <f4, <i8 and <i4 are read");
}

std::string to_npz(const std::vector<NamedArray>& arrays) {
  ZipWriter zip;
  for (const NamedArray& array : arrays) zip.add(array);
  return zip.finish();
}

}  // namespace timbre
