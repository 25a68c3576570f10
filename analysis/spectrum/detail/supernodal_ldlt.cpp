#include "timbre/analysis/spectrum/detail/supernodal_ldlt.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/spectrum/detail/aligned_array.h"
#include "timbre/analysis/spectrum/detail/factor_check.h"
#include "timbre/analysis/spectrum/detail/front.h"
#include "timbre/analysis/spectrum/detail/panels.h"
#include "timbre/analysis/spectrum/detail/solve_plan.h"
#include "timbre/analysis/spectrum/detail/traversal.h"

namespace timbre::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// A pivot this small beside its row has lost most of its digits.
constexpr double kSmallPivot = 1e-13;

// Row of each entry of the pencil in the front of its column.
std::vector<int> entry_rows(const SymbolicFactor& symbolic, const Pencil& pencil) {
  std::vector<int> rows(static_cast<std::size_t>(pencil.entries()));
  for (int s = 0; s < symbolic.supernodes(); ++s) {
    const int begin = symbolic.first_column[s];
    const int end = symbolic.first_column[s + 1];
    const auto below = symbolic.rows.begin() + symbolic.first_row[s];
    for (int j = begin; j < end; ++j) {
      auto at = below;
      for (std::int64_t e = pencil.start[j]; e < pencil.start[j + 1]; ++e) {
        const int i = pencil.row[e];
        if (i < end) {
          rows[e] = i - begin;
          continue;
        }
        while (*at < i) ++at;
        rows[e] = padded(end - begin) + static_cast<int>(at - below);
      }
    }
  }
  return rows;
}

// Workspaces for each thread at work, kept for the next time.
template <typename Space>
class Pool {
 public:
  struct Return {
    Pool* pool;
    void operator()(Space* space) const {
      const std::lock_guard lock(pool->mutex_);
      pool->free_.emplace_back(space);
    }
  };
  using Loan = std::unique_ptr<Space, Return>;

  /// One that is free, or a new one made of `arguments`.
  template <typename... Arguments>
  [[nodiscard]] Loan borrow(const Arguments&... arguments) {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) free_.push_back(std::make_unique<Space>(arguments...));
    Loan loan(free_.back().release(), Return{this});
    free_.pop_back();
    return loan;
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Space>> free_;
};

// Room for as many numbers as were ever asked for.
struct Scratch {
  AlignedArray numbers;

  [[nodiscard]] double* of_size(std::size_t size) {
    if (numbers.size() < size) numbers = AlignedArray(size);
    return numbers.data();
  }
};

}  // namespace

struct SupernodalLdlt::Impl {
  Impl(const Pencil& given, const Points* positions, const LdltOptions& chosen)
      : options(chosen),
        symbolic(analyse(given, compute_ordering(adjacency(given), positions, chosen.ordering))),
        pencil(permuted(given, symbolic.order)),
        layout(lay_out_panels(symbolic)),
        threads(chosen.threads > 0 ? chosen.threads : hardware_threads()),
        plan(plan_traversal(symbolic, threads)),
        solve_plan(plan_solves(symbolic, layout)),
        entry_row(entry_rows(symbolic, pencil)),
        kernels(tile_kernels(chosen.instructions)) {}

  [[nodiscard]] std::int64_t bytes() const {
    std::int64_t values = layout.values + std::int64_t{2} * symbolic.size + plan.top.values;
    for (const Sequence& subtree : plan.subtrees) values += subtree.values;
    return static_cast<std::int64_t>(sizeof(double)) * values +
           threads * FrontFactorizer::workspace_bytes(symbolic);
  }

  void allocate() {
    if (factor.size() > 0 || symbolic.size == 0) return;
    const auto n = static_cast<std::size_t>(symbolic.size);
    factor = AlignedArray(static_cast<std::size_t>(layout.values));
    d.resize(n);
    e.resize(n);
    order.resize(n);
    counts.resize(symbolic.parent.size());
    for (const Sequence& subtree : plan.subtrees) {
      arenas.emplace_back(static_cast<std::size_t>(subtree.values));
    }
    arenas.emplace_back(static_cast<std::size_t>(plan.top.values));
  }

  double* update_of(int s) {
    const int q = plan.sequence_of[s];
    return (q == -1 ? arenas.back() : arenas[q]).data() + plan.place[s];
  }

  // Stops where `stop` says so, or throws.
  template <typename Stop>
  void run(const FactorInput& input, const Sequence& sequence, FrontFactorizer& fronts,
           const Stop& stop) {
    std::vector<Child> children;
    for (const int s : sequence.supernodes) {
      if (stop()) return;
      children.clear();
      for (const int c : plan.children_of(s)) children.push_back({c, update_of(c)});
      fronts.factorize(input, s, children, update_of(s),
                       {factor.data(), d.data(), e.data(), order.data(), counts.data()});
    }
  }

  PivotCounts factorize(double shift) {
    allocate();
    factorized = false;
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<bool> is_stopped = false;
    const auto stop = [&] {
      if (!is_stopped && options.between && std::this_thread::get_id() == caller) {
        options.between();
      }
      return is_stopped.load();
    };
    const std::vector<double> scale = row_scales(pencil, shift);
    const FactorInput input{symbolic, layout, pencil, entry_row, scale, kernels, shift};
    parallel_for(std::ssize(plan.subtrees), threads, [&](std::int64_t i) {
      try {
        const auto fronts = workspaces.borrow(symbolic);
        run(input, plan.subtrees[i], *fronts, stop);
      } catch (...) {
        is_stopped = true;
        throw;
      }
    });
    const auto fronts = workspaces.borrow(symbolic);
    run(input, plan.top, *fronts, stop);
    PivotCounts all;
    for (const PivotCounts& one : counts) all.add(one);
    factorized = true;
    return all;
  }

  [[nodiscard]] Panel panel(int s, int p) const {
    const PanelPlace& place = layout.panels[p];
    const double* inverse = factor.data() + place.values;
    return {.inverse = inverse,
            .below = inverse + PanelLayout::inverse_values(place.width),
            .order = order.data() + place.column,
            .d = d.data() + place.column,
            .e = e.data() + place.column,
            .column = place.column,
            .width = place.width,
            .rest = symbolic.first_column[s + 1] - place.column - place.width,
            .listed = symbolic.rows_below(s),
            .rows = symbolic.rows.data() + symbolic.first_row[s]};
  }

  static std::size_t row_at(int row, int width) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
  }

  // The rows of X that the supernode coming next will read, its own and those below.
  void prefetch_rows(int s, const double* X, int width) const {
    constexpr int kLine = 64 / sizeof(double);
    constexpr int kMost = 64;
    const double* own = X + static_cast<std::ptrdiff_t>(symbolic.first_column[s]) * width;
    for (int i = 0; i < std::min(symbolic.columns(s), kMost) * width; i += kLine) {
      __builtin_prefetch(own + i);
    }
    const int* rows = symbolic.rows.data() + symbolic.first_row[s];
    for (int i = 0; i < std::min(symbolic.rows_below(s), kMost); ++i) {
      const double* row = X + static_cast<std::ptrdiff_t>(rows[i]) * width;
      for (int c = 0; c < width; c += kLine) __builtin_prefetch(row + c);
    }
  }

  void forward(int s, double* X, int stride, int columns) const {
    for (int p = layout.first_panel[s]; p < layout.first_panel[s + 1]; ++p) {
      kernels.forward(panel(s, p), X, stride, columns);
    }
  }

  void backward(int s, double* X, int stride, int columns) const {
    for (int p = layout.first_panel[s + 1] - 1; p >= layout.first_panel[s]; --p) {
      kernels.backward(panel(s, p), X, stride, columns);
    }
  }

  // In a copy of its own rows; what it hands on to the rows below its root goes to `handed`.
  void forward_subtree(int q, double* X, int width, double* handed) const {
    const int root = solve_plan.root[q];
    const int first = solve_plan.first[q];
    const auto loan = scratch.borrow();
    double* const Y = loan->of_size(row_at(symbolic.size, width));
    double* const own = X + row_at(symbolic.first_column[first], width);
    double* const copy = Y + row_at(symbolic.first_column[first], width);
    const std::size_t count =
        row_at(symbolic.first_column[root + 1] - symbolic.first_column[first], width);
    std::copy_n(own, count, copy);
    const int* const rows = symbolic.rows.data() + symbolic.first_row[root];
    const int below = symbolic.rows_below(root);
    for (int i = 0; i < below; ++i) std::fill_n(Y + row_at(rows[i], width), width, 0.0);
    for (int s = first; s <= root; ++s) {
      if (s < root) prefetch_rows(s + 1, Y, width);
      forward(s, Y, width, width);
    }
    std::copy_n(copy, count, own);
    for (int i = 0; i < below; ++i) {
      std::copy_n(Y + row_at(rows[i], width), width, handed + row_at(i, width));
    }
  }

  void add_handed(int q, const double* handed, double* X, int width) const {
    const int root = solve_plan.root[q];
    const int* const rows = symbolic.rows.data() + symbolic.first_row[root];
    for (int i = 0; i < symbolic.rows_below(root); ++i) {
      double* const row = X + row_at(rows[i], width);
      for (int c = 0; c < width; ++c)
        row[c] += handed[row_at(i, width) + static_cast<std::size_t>(c)];
    }
  }

  void backward_subtree(int q, double* X, int width) const {
    for (int s = solve_plan.root[q]; s >= solve_plan.first[q]; --s) {
      if (s > solve_plan.first[q]) prefetch_rows(s - 1, X, width);
      backward(s, X, width, width);
    }
  }

  void solve(double* X, int width) const {
    const int subtrees = solve_plan.subtrees();
    const auto loan = scratch.borrow();
    double* const handed = loan->of_size(static_cast<std::size_t>(solve_plan.handed.back()) *
                                         static_cast<std::size_t>(width));
    const auto handed_by = [&](int q) {
      return handed + solve_plan.handed[q] * static_cast<std::int64_t>(width);
    };
    parallel_for(subtrees, threads, [&](std::int64_t q) {
      forward_subtree(static_cast<int>(q), X, width, handed_by(static_cast<int>(q)));
    });
    for (int q = 0; q < subtrees; ++q) add_handed(q, handed_by(q), X, width);
    // Towards the root there is one path; its threads take some right-hand sides each.
    const int columns =
        subtrees > 0 && threads > 1 ? std::max(width / 2, kernels.least_columns) : width;
    parallel_for(width / columns, threads, [&](std::int64_t part) {
      double* const some = X + part * columns;
      const std::vector<int>& top = solve_plan.top;
      for (std::size_t i = 0; i < top.size(); ++i) {
        if (i + 1 < top.size()) prefetch_rows(top[i + 1], X, width);
        forward(top[i], some, width, columns);
      }
      for (std::size_t i = top.size(); i-- > 0;) {
        if (i > 0) prefetch_rows(top[i - 1], X, width);
        backward(top[i], some, width, columns);
      }
    });
    parallel_for(subtrees, threads,
                 [&](std::int64_t q) { backward_subtree(static_cast<int>(q), X, width); });
  }

  LdltOptions options;
  SymbolicFactor symbolic;
  Pencil pencil;
  PanelLayout layout;
  int threads;
  Traversal plan;
  SolvePlan solve_plan;
  std::vector<int> entry_row;
  const TileKernels& kernels;

  bool factorized = false;
  AlignedArray factor;
  std::vector<double> d, e;
  std::vector<int> order;
  std::vector<PivotCounts> counts;
  std::vector<AlignedArray> arenas;  // of the subtrees, and last of the top
  Pool<FrontFactorizer> workspaces;
  mutable Pool<Scratch> scratch;  // of solves
};

SupernodalLdlt::SupernodalLdlt(const Eigen::SparseMatrix<double>& K,
                               const Eigen::SparseMatrix<double>& M, const Points* positions,
                               const LdltOptions& options)
    : impl_(std::make_unique<Impl>(make_pencil(K, M), positions, options)) {}

SupernodalLdlt::~SupernodalLdlt() = default;
SupernodalLdlt::SupernodalLdlt(SupernodalLdlt&&) noexcept = default;
SupernodalLdlt& SupernodalLdlt::operator=(SupernodalLdlt&&) noexcept = default;

LdltReport SupernodalLdlt::factorize(double shift) {
  const PivotCounts counts = impl_->factorize(shift);
  LdltReport report;
  report.shift = shift;
  report.negative = counts.negative;
  report.two_by_two = counts.two_by_two;
  report.replaced = counts.replaced;
  report.smallest_pivot = counts.smallest;
  if (impl_->options.check) {
    const FactorCheck check =
        check_factor(impl_->pencil, shift, [&](double* X, int width) { impl_->solve(X, width); });
    report.backward_error = check.backward_error;
    report.residual = check.residual;
  }
  report.near_singular =
      counts.replaced > 0 || !(counts.smallest > kSmallPivot) || is_doubtful(report.residual);
  return report;
}

void SupernodalLdlt::solve(Eigen::Ref<MatrixXd> X) const {
  const int n = impl_->symbolic.size;
  if (X.rows() != n || !impl_->factorized) {
    throw Error(ErrorKind::bad_request, "", "solve",
                impl_->factorized ? "right-hand sides have " + std::to_string(X.rows()) +
                                        " rows, the matrix has " + std::to_string(n)
                                  : "nothing is factorised yet");
  }
  const std::vector<int>& order = impl_->symbolic.order;
  for (Index first = 0; first < X.cols();) {
    const Index left = X.cols() - first;
    const int chunk = left <= 8 ? 8 : left <= 16 ? 16 : kMaxChunk;
    const Index used = std::min<Index>(left, chunk);
    AlignedArray rows(static_cast<std::size_t>(n) * static_cast<std::size_t>(chunk));
    for (int i = 0; i < n; ++i) {
      double* row = rows.data() + static_cast<std::ptrdiff_t>(i) * chunk;
      for (Index c = 0; c < chunk; ++c) row[c] = c < used ? X(order[i], first + c) : 0.0;
    }
    impl_->solve(rows.data(), chunk);
    for (int i = 0; i < n; ++i) {
      const double* row = rows.data() + static_cast<std::ptrdiff_t>(i) * chunk;
      for (Index c = 0; c < used; ++c) X(order[i], first + c) = row[c];
    }
    first += used;
  }
}

void SupernodalLdlt::solve_in_factor_order(double* X, int width) const { impl_->solve(X, width); }

const SymbolicFactor& SupernodalLdlt::symbolic() const { return impl_->symbolic; }
const Pencil& SupernodalLdlt::pencil() const { return impl_->pencil; }
std::int64_t SupernodalLdlt::bytes() const { return impl_->bytes(); }

}  // namespace timbre::detail
