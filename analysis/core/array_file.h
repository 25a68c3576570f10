#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace timbre {

/// The bytes of a NumPy `.npy` file, format 1.0, little-endian.
/// Matrices are stored as they lie in memory (`fortran_order: True`).
[[nodiscard]] std::string to_npy(const Eigen::MatrixXd& matrix);
[[nodiscard]] std::string to_npy(const Eigen::VectorXd& vector);
[[nodiscard]] std::string to_npy(const Eigen::VectorXi& vector);
/// Row-major n x 3 tables: points (float64) and faces (int32).
[[nodiscard]] std::string to_npy(
    const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>& points);
[[nodiscard]] std::string to_npy(
    const Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>& faces);
/// A zero-dimensional text; ASCII only.
[[nodiscard]] std::string to_npy(const std::string& ascii);

/// The array of a NumPy `.npy` file, format 1.0 or 2.0, of one or two dimensions, of
/// little-endian float64, float32, int64 or int32, in either order; n numbers give n x 1.
/// @throws Error  bad_input, with place and cause, for anything else, for data of another size
///                than the header says, and for an int64 that no double holds
[[nodiscard]] Eigen::MatrixXd from_npy(std::string_view bytes);

/// What the bytes of a NumPy array say of themselves, and its numbers as they lie.
struct NpyView {
  std::string type;  ///< "<f8": little-endian float64
  bool is_fortran = false;
  std::vector<std::int64_t> shape;
  std::string_view data;  ///< in the bytes given
};

/// @throws Error  bad_input, with place and cause, unless `bytes` begin as format 1.0 or 2.0
[[nodiscard]] NpyView view_npy(std::string_view bytes);

enum class ElementType : std::uint8_t { float64, float32 };

/// What stands before the numbers of a matrix that follow column by column.
[[nodiscard]] std::string npy_header(Eigen::Index rows, Eigen::Index cols,
                                     ElementType type = ElementType::float64);
/// What stands before the numbers of a vector of float64.
[[nodiscard]] std::string npy_vector_header(Eigen::Index size);

/// One array of an archive: `bytes` as `to_npy` makes them.
struct NamedArray {
  std::string name;
  std::string bytes;
  bool is_index = false;  ///< numbers of vertices or the like, from 0; -1 is none
};

/// The bytes of a NumPy `.npz` file: a zip archive, stored, not deflated, without
/// times, so that the same arrays give the same bytes.
/// @throws Error  bad_request beyond 4 GiB, which this zip format cannot hold
[[nodiscard]] std::string to_npz(const std::vector<NamedArray>& arrays);

}  // namespace timbre
