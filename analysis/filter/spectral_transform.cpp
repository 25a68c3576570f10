#include "timbre/analysis/filter/spectral_transform.h"

#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/matrix_product.h"

namespace timbre {

Eigen::MatrixXd forward_transform(const Spectrum& spectrum, const SparseMatrix& mass,
                                  const Eigen::MatrixXd& F) {
  const Eigen::Index rows = spectrum.vectors.rows();
  if (mass.rows() != rows || F.rows() != rows) {
    throw Error(ErrorKind::bad_request, "", "transform",
                "the functions have " + std::to_string(F.rows()) + " rows and the mass " +
                    std::to_string(mass.rows()) + "; the eigenfunctions have " +
                    std::to_string(rows));
  }
  return product_at_b(spectrum.vectors, mass * F);
}

Eigen::MatrixXd inverse_transform(const Spectrum& spectrum, const Eigen::MatrixXd& coefficients) {
  if (coefficients.rows() > spectrum.vectors.cols()) {
    throw Error(ErrorKind::bad_request, "", "transform",
                std::to_string(coefficients.rows()) + " coefficients are too many for " +
                    std::to_string(spectrum.vectors.cols()) + " eigenfunctions");
  }
  return product_a_b(spectrum.vectors.leftCols(coefficients.rows()), coefficients);
}

}  // namespace timbre
