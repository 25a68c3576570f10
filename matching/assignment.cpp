#include "timbre/matching/assignment.h"

#include <limits>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kFree = -1;

// Rows are assigned one at a time; prices of rows and columns keep every reduced cost at 0 or
// above, and at 0 for pairs.
class Assignment {
 public:
  explicit Assignment(const Eigen::MatrixXd& profit)
      : profit_(profit),
        row_price_(VectorXd::Zero(profit.rows())),
        column_price_(VectorXd::Zero(profit.cols())),
        row_of_(static_cast<std::size_t>(profit.cols()), kFree) {}

  // Along the shortest path from the row to a free column, as Dijkstra finds it.
  void add(Index row) {
    const Index columns = profit_.cols();
    VectorXd distance = VectorXd::Constant(columns, std::numeric_limits<double>::infinity());
    std::vector<Index> before(row_of_.size(), kFree);  // column on the way
    std::vector<bool> is_settled(row_of_.size(), false);
    Index last = kFree;
    double way = 0.0;
    for (Index at_row = row;;) {
      Index nearest = kFree;
      for (Index c = 0; c < columns; ++c) {
        const auto at = static_cast<std::size_t>(c);
        if (is_settled[at]) continue;
        const double through = way - profit_(at_row, c) - row_price_[at_row] - column_price_[c];
        if (through < distance[c]) {
          distance[c] = through;
          before[at] = last;
        }
        if (nearest == kFree || distance[c] < distance[nearest]) nearest = c;
      }
      way = distance[nearest];
      last = nearest;
      at_row = row_of_[static_cast<std::size_t>(nearest)];
      if (at_row == kFree) break;
      is_settled[static_cast<std::size_t>(nearest)] = true;
    }
    row_price_[row] += way;
    for (Index c = 0; c < columns; ++c) {
      const auto at = static_cast<std::size_t>(c);
      if (!is_settled[at]) continue;
      column_price_[c] -= way - distance[c];
      row_price_[row_of_[at]] += way - distance[c];
    }
    for (Index c = last; c != kFree;) {
      const Index previous = before[static_cast<std::size_t>(c)];
      row_of_[static_cast<std::size_t>(c)] =
          previous == kFree ? row : row_of_[static_cast<std::size_t>(previous)];
      c = previous;
    }
  }

  [[nodiscard]] std::vector<int> columns() const {
    std::vector<int> column(static_cast<std::size_t>(profit_.rows()), 0);
    for (std::size_t c = 0; c < row_of_.size(); ++c) {
      if (row_of_[c] != kFree) column[static_cast<std::size_t>(row_of_[c])] = static_cast<int>(c);
    }
    return column;
  }

 private:
  const Eigen::MatrixXd& profit_;
  VectorXd row_price_, column_price_;
  std::vector<Index> row_of_;  // of a column
};

}  // namespace

std::vector<int> best_assignment(const Eigen::MatrixXd& profit) {
  if (profit.rows() > profit.cols()) {
    throw Error(ErrorKind::bad_request, "", "assignment",
                std::to_string(profit.rows()) + " rows, only " + std::to_string(profit.cols()) +
                    " columns");
  }
  Assignment assignment(profit);
  for (Index row = 0; row < profit.rows(); ++row) assignment.add(row);
  return assignment.columns();
}

}  // namespace timbre
