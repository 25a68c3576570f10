#pragma once

#include <Eigen/Core>

namespace timbre {

struct AlignmentOptions {
  int count = 50;  ///< functions of the reference that are looked for, the constant among them
  /// Eigenvalues within this share of each other are one space: its functions may be mixed. 0: only
  /// signs and orders change.
  double near_equal = 0.05;
};

/// The eigenfunctions of one shape in the order, with the signs and within near-equal spaces in
/// the rotation of another's.
struct AlignedBasis {
  Eigen::VectorXd values;  ///< count: mean eigenvalues of the functions, by their shares
  /// m x count, orthonormal: function i is the sum of its own eigenfunctions by column i.
  Eigen::MatrixXd mixture;
  /// count: correlation of function i, carried over by the map, with function i of the reference;
  /// 1 is full agreement, near 0 there is no counterpart.
  Eigen::VectorXd agreement;
};

/// Brings the eigenfunctions of B into agreement with those of A. Each function of A gets a
/// share in one near-equal space of B, by the assignment that explains most of the map; in each
/// space the rotation comes from the polar factor of the map. With `near_equal` at 0 that is
/// a signed order.
///
/// @param C       F(B) -> F(A), rows x m: a functional map, as `match` finds it
/// @param values  m eigenvalues of B, ascending
/// @throws Error  bad_request unless 1 <= count <= rows and <= m, and 0 <= near_equal < 1
/// @see Jain, Zhang and van Kaick 2007 (unswitching); Levy and Zhang 2009, figure 22
[[nodiscard]] AlignedBasis align_basis(const Eigen::MatrixXd& C, const Eigen::VectorXd& values,
                                       const AlignmentOptions& options = {});

/// How many leading functions agree to `least` or better.
[[nodiscard]] int comparable_functions(const AlignedBasis& basis, double least = 0.7);

}  // namespace timbre
