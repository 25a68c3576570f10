#include "timbre/matching/switches.h"

#include <algorithm>
#include <cmath>

namespace timbre {
namespace {

constexpr double kPair = 0.7;
constexpr double kPart = 0.3;

// Rows and columns joined to `row` by entries above kPart.
Switch connected_block(const Eigen::MatrixXd& C, int count, int row, std::vector<bool>& seen) {
  Switch block{SwitchKind::mixed, {}, {}};
  const auto columns = static_cast<int>(C.cols());
  std::vector<bool> seen_column(static_cast<std::size_t>(columns), false);
  std::vector<int> rows = {row};
  seen[static_cast<std::size_t>(row)] = true;
  while (!rows.empty()) {
    const int i = rows.back();
    rows.pop_back();
    block.source.push_back(i);
    for (int j = 0; j < columns; ++j) {
      if (std::abs(C(i, j)) <= kPart || seen_column[static_cast<std::size_t>(j)]) continue;
      seen_column[static_cast<std::size_t>(j)] = true;
      block.target.push_back(j);
      for (int other = 0; other < count; ++other) {
        if (std::abs(C(other, j)) <= kPart || seen[static_cast<std::size_t>(other)]) continue;
        seen[static_cast<std::size_t>(other)] = true;
        rows.push_back(other);
      }
    }
  }
  std::sort(block.source.begin(), block.source.end());
  std::sort(block.target.begin(), block.target.end());
  return block;
}

}  // namespace

std::vector<Switch> find_switches(const Eigen::MatrixXd& C, int count) {
  count = static_cast<int>(std::min<Eigen::Index>(count, C.rows()));
  std::vector<bool> seen(static_cast<std::size_t>(count), false);
  std::vector<Switch> switches;
  for (int i = 0; i < count; ++i) {
    if (seen[static_cast<std::size_t>(i)]) continue;
    Eigen::Index partner = 0;
    const double size = C.row(i).cwiseAbs().maxCoeff(&partner);
    if (size <= kPair) {
      switches.push_back(connected_block(C, count, i, seen));
      continue;
    }
    seen[static_cast<std::size_t>(i)] = true;
    const int j = static_cast<int>(partner);
    if (j != i) {
      switches.push_back({SwitchKind::exchanged, {i}, {j}});
    } else if (C(i, j) < 0.0) {
      switches.push_back({SwitchKind::flipped, {i}, {j}});
    }
  }
  return switches;
}

const char* to_word(SwitchKind kind) {
  switch (kind) {
    case SwitchKind::flipped:
      return "flipped";
    case SwitchKind::exchanged:
      return "exchanged";
    case SwitchKind::mixed:
      break;
  }
  return "mixed";
}

}  // namespace timbre
