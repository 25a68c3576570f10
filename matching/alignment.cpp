#include "timbre/matching/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/matching/assignment.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

// The space each function lies in: neighbours are joined, the closest first, while no two of a
// space differ by more than `near_equal` of the larger.
std::vector<Index> near_equal_spaces(const VectorXd& values, double near_equal) {
  const Index m = values.size();
  std::vector<Index> begin(at(m));  // of the space that starts or ends here
  std::vector<Index> end(at(m));
  std::iota(begin.begin(), begin.end(), 0);
  std::iota(end.begin(), end.end(), 0);
  const auto spread = [&](Index low, Index high) { return values[high] - values[low]; };
  std::vector<std::pair<double, Index>> gaps;  // relative, after each function
  for (Index i = 0; i + 1 < m; ++i) {
    const double above = values[i + 1];
    gaps.emplace_back(above > 0.0 ? spread(i, i + 1) / above : 0.0, i);
  }
  std::sort(gaps.begin(), gaps.end());
  for (const auto& [width, gap] : gaps) {
    const Index low = begin[at(gap)];
    const Index high = end[at(gap + 1)];
    if (near_equal == 0.0 || spread(low, high) > near_equal * values[high]) continue;
    end[at(low)] = high;
    begin[at(high)] = low;
  }
  std::vector<Index> space(at(m), 0);
  for (Index i = 0; i < m; i = end[at(i)] + 1) {
    std::fill(space.begin() + i, space.begin() + end[at(i)] + 1, i);
  }
  return space;
}

// The columns Q, orthonormal, with the largest trace of C Q.
MatrixXd best_rotation(const MatrixXd& C) {
  const Eigen::JacobiSVD<MatrixXd> svd(C, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return svd.matrixV() * svd.matrixU().transpose();
}

void require_possible(const MatrixXd& C, const VectorXd& values, const AlignmentOptions& options) {
  if (options.count < 1 || options.count > C.rows() || options.count > C.cols() ||
      C.cols() != values.size()) {
    throw Error(ErrorKind::bad_request, "", "count",
                "is " + std::to_string(options.count) + "; the map has " +
                    std::to_string(C.rows()) + " x " + std::to_string(C.cols()) + " entries, of " +
                    std::to_string(values.size()) + " eigenvalues");
  }
  if (!(options.near_equal >= 0.0 && options.near_equal < 1.0)) {
    throw Error(ErrorKind::bad_request, "", "near_equal", "must be a share, from 0 to below 1");
  }
}

}  // namespace

AlignedBasis align_basis(const MatrixXd& C, const VectorXd& values,
                         const AlignmentOptions& options) {
  require_possible(C, values, options);
  const Index count = options.count;
  const std::vector<Index> space = near_equal_spaces(values, options.near_equal);
  // What of function i of A lies in each space of B; all functions of a space have the same share.
  MatrixXd share = MatrixXd::Zero(count, values.size());
  for (Index j = 0; j < values.size(); ++j) {
    share.col(space[at(j)]) += C.col(j).head(count).cwiseAbs2();
  }
  for (Index j = 0; j < values.size(); ++j) share.col(j) = share.col(space[at(j)]).eval();
  const std::vector<int> column = best_assignment(share);

  AlignedBasis basis;
  basis.mixture = MatrixXd::Zero(values.size(), count);
  for (Index first = 0; first < values.size(); ++first) {
    if (space[at(first)] != first) continue;
    std::vector<Index> columns;
    for (Index j = first; j < values.size() && space[at(j)] == first; ++j) columns.push_back(j);
    std::vector<Index> rows;
    for (Index i = 0; i < count; ++i) {
      if (space[at(column[at(i)])] == first) rows.push_back(i);
    }
    if (!rows.empty()) basis.mixture(columns, rows) = best_rotation(C(rows, columns));
  }
  basis.values = basis.mixture.cwiseAbs2().transpose() * values;
  const MatrixXd carried = C * basis.mixture;
  basis.agreement = carried.topRows(count).diagonal().array() /
                    carried.colwise().norm().transpose().array().max(1e-300);
  return basis;
}

int comparable_functions(const AlignedBasis& basis, double least) {
  const auto end = std::find_if_not(basis.agreement.begin(), basis.agreement.end(),
                                    [least](double agreement) { return agreement >= least; });
  return static_cast<int>(end - basis.agreement.begin());
}

}  // namespace timbre
