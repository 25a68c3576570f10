#pragma once

#include <Eigen/Core>
#include <array>

namespace timbre::detail {

/// Values of all nodal polynomials of a triangle, in the order of `LagrangeNodes::of_face`.
/// @param corner  the three barycentric coordinates
[[nodiscard]] Eigen::VectorXd lagrange_values(int degree, const Eigen::Vector3d& corner);

/// Barycentric coordinates of the nodes of a triangle, in the same order; a row each.
[[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 3> lagrange_places(int degree);

/// Integrals over a triangle that do not hang on its shape. With area A and cotangents cot_c,
/// the integral of grad u . grad v is sum_c cot_c stiffness[c], that of u v is A mass.
struct ReferenceElement {
  std::array<Eigen::MatrixXd, 3> stiffness;
  Eigen::MatrixXd mass;
};

[[nodiscard]] ReferenceElement reference_element(int degree);

}  // namespace timbre::detail
