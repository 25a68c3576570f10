#include "timbre/analysis/spectrum/detail/shifted_factor.h"

#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/spectrum/detail/simplicial_factor.h"
#include "timbre/analysis/spectrum/detail/supernodal_ldlt.h"

namespace timbre::detail {

std::unique_ptr<ShiftedFactor> make_shifted_factor(const Eigen::SparseMatrix<double>& K,
                                                   const Eigen::SparseMatrix<double>& M,
                                                   const Points* positions,
                                                   FactorizationBackend backend, int threads,
                                                   std::function<void()> between) {
  switch (backend) {
    case FactorizationBackend::automatic:
    case FactorizationBackend::supernodal:
      return std::make_unique<SupernodalLdlt>(
          K, M, positions, LdltOptions{.threads = threads, .between = std::move(between)});
    case FactorizationBackend::eigen:
      return make_simplicial_factor(K, M, make_eigen_ldlt());
    case FactorizationBackend::cholmod:
#ifdef TIMBRE_WITH_CHOLMOD
      return make_simplicial_factor(K, M, make_cholmod_ldlt());
#else
      break;
#endif
  }
  throw Error(ErrorKind::bad_request, "", "factorisation",
              "this build of timbre has no CHOLMOD; choose another backend");
}

}  // namespace timbre::detail
