#include "timbre/analysis/core/mat_file.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

// Numbers of the format, as its description has them.
enum class Type : std::uint32_t {
  int8 = 1,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  float64 = 9,
  matrix = 14
};
enum class ArrayClass : std::uint32_t { text = 4, float64 = 6, int32 = 12 };

void append(std::string& to, std::uint32_t value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

constexpr std::size_t kPart = 8;  // what precedes a part, and what its size is a multiple of

std::size_t padded_part(std::size_t size) { return kPart + (size + kPart - 1) / kPart * kPart; }

// A part with its type and size, filled up to 8 bytes.
void append_part(std::string& to, Type type, std::string_view data) {
  const std::size_t end = to.size() + padded_part(data.size());
  append(to, static_cast<std::uint32_t>(type));
  append(to, static_cast<std::uint32_t>(data.size()));
  to += data;
  to.resize(end, '\0');
}

template <typename Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

// Column by column, whatever the order in the array.
std::string by_columns(const NpyView& array, std::size_t size, std::int64_t rows,
                       std::int64_t cols) {
  if (array.is_fortran || rows <= 1 || cols <= 1) return std::string(array.data);
  std::string out(array.data.size(), '\0');
  for (std::int64_t i = 0; i < rows; ++i) {
    for (std::int64_t j = 0; j < cols; ++j) {
      std::memcpy(out.data() + static_cast<std::size_t>(j * rows + i) * size,
                  array.data.data() + static_cast<std::size_t>(i * cols + j) * size, size);
    }
  }
  return out;
}

// UTF-32 of ASCII as UTF-16.
std::string narrowed(std::string_view wide) {
  std::string out;
  for (std::size_t i = 0; i + 4 <= wide.size(); i += 4) out += wide.substr(i, 2);
  return out;
}

struct Content {
  ArrayClass array_class;
  Type type;
  std::int32_t rows, cols;
  std::string data;
};

std::int32_t checked(std::int64_t size, const std::string& name) {
  if (size > std::numeric_limits<std::int32_t>::max()) {
    throw Error(ErrorKind::bad_request, "", name,
                "has 2 GiB or more, which .mat files cannot hold; write .npy");
  }
  return static_cast<std::int32_t>(size);
}

Error unsuitable(const std::string& name) {
  return {ErrorKind::bad_request, "", name, "is of a kind that .mat files do not get"};
}

void count_from_one(std::string& integers) {
  for (std::size_t i = 0; i < integers.size(); i += sizeof(std::int32_t)) {
    std::int32_t index = 0;
    std::memcpy(&index, integers.data() + i, sizeof index);
    ++index;
    std::memcpy(integers.data() + i, &index, sizeof index);
  }
}

Content content_of(const NamedArray& array) {
  const NpyView view = view_npy(array.bytes);
  (void)checked(static_cast<std::int64_t>(view.data.size()), array.name);
  if (view.type.starts_with("<U")) {
    std::string text = narrowed(view.data);
    const auto letters = static_cast<std::int32_t>(text.size() / 2);
    return {ArrayClass::text, Type::uint16, letters > 0 ? 1 : 0, letters, std::move(text)};
  }
  const bool is_real = view.type == "<f8";
  const bool is_integer = view.type == "<i4";
  if ((!is_real && !is_integer) || (array.is_index && !is_integer) || view.shape.empty() ||
      view.shape.size() > 2) {
    throw unsuitable(array.name);
  }
  const std::int64_t size = is_real ? sizeof(double) : sizeof(std::int32_t);
  const std::int32_t rows = checked(view.shape[0], array.name);
  const std::int32_t cols = view.shape.size() == 2 ? checked(view.shape[1], array.name) : 1;
  if (std::int64_t{rows} * cols != static_cast<std::int64_t>(view.data.size()) / size ||
      static_cast<std::int64_t>(view.data.size()) % size != 0) {
    throw unsuitable(array.name);
  }
  std::string data = by_columns(view, static_cast<std::size_t>(size), rows, cols);
  if (array.is_index) count_from_one(data);
  return {is_real ? ArrayClass::float64 : ArrayClass::int32, is_real ? Type::float64 : Type::int32,
          rows, cols, std::move(data)};
}

void require_name(const std::string& name) {
  constexpr std::size_t kLongest = 63;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_valid = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  if (!name.empty() && name.size() <= kLongest && is_letter(name[0]) &&
      std::all_of(name.begin(), name.end(), is_valid)) {
    return;
  }
  throw Error(ErrorKind::bad_request, "", name, "cannot be the name of a variable in a .mat file");
}

void append_variable(std::string& out, const NamedArray& array) {
  require_name(array.name);
  const Content content = content_of(array);
  std::string start;
  append_part(
      start, Type::uint32,
      bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(content.array_class), 0}));
  append_part(start, Type::int32, bytes_of(std::vector<std::int32_t>{content.rows, content.cols}));
  append_part(start, Type::int8, array.name);
  append(out, static_cast<std::uint32_t>(Type::matrix));
  append(out, static_cast<std::uint32_t>(start.size() + padded_part(content.data.size())));
  out += start;
  append_part(out, content.type, content.data);
}

}  // namespace

std::string to_mat(const std::vector<NamedArray>& arrays) {
  constexpr std::size_t kText = 116;
  std::string out = "MATLAB 5.0 MAT-file, written by timbre";
  out.resize(kText, ' ');
  out.append(8, '\0');                       // no data of subsystems
  out += std::string_view("\x00\x01IM", 4);  // version 1.0, little-endian
  bool has_indices = false;
  for (const NamedArray& array : arrays) {
    append_variable(out, array);
    has_indices = has_indices || array.is_index;
  }
  if (has_indices) {
    append_variable(out, {"index_base", to_npy(Eigen::VectorXi(Eigen::VectorXi::Ones(1)))});
  }
  return out;
}

}  // namespace timbre
