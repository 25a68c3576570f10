#include "timbre/analysis/spectrum/detail/banded_eigenproblem.h"

#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"

// NOLINTNEXTLINE(readability-identifier-naming): the name is LAPACK's
extern "C" void dsbevd_(const char* job, const char* half, const int* n, const int* below,
                        double* band, const int* ld, double* values, double* vectors,
                        const int* ld_vectors, double* work, const int* work_size, int* integers,
                        const int* integers_size, int* info);

namespace timbre::detail {

BandedEigenpairs solve(const BandedMatrix& matrix) {
  const int n = matrix.size();
  const int below = matrix.width();
  const int ld = below + 1;
  Eigen::MatrixXd band = matrix.band();  // overwritten
  BandedEigenpairs pairs{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  const int work_size = 1 + 5 * n + 2 * n * n;
  const int integers_size = 3 + 5 * n;
  std::vector<double> work(static_cast<std::size_t>(work_size));
  std::vector<int> integers(static_cast<std::size_t>(integers_size));
  int info = 0;
  dsbevd_("V", "L", &n, &below, band.data(), &ld, pairs.values.data(), pairs.vectors.data(), &n,
          work.data(), &work_size, integers.data(), &integers_size, &info);
  if (info != 0) {
    throw Error(ErrorKind::not_converged, "", "spectrum",
                "LAPACK dsbevd stopped with " + std::to_string(info));
  }
  return pairs;
}

}  // namespace timbre::detail
