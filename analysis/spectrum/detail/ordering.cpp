#include "timbre/analysis/spectrum/detail/ordering.h"

#ifdef TIMBRE_WITH_METIS
#include <metis.h>
#endif

#include <Eigen/OrderingMethods>
#include <limits>
#include <new>
#include <numeric>
#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre::detail {
namespace {

// Below this many unknowns nested dissection gains nothing over minimum degree.
constexpr int kSmall = 3000;

[[noreturn]] void refuse(const std::string& cause) {
  throw Error(ErrorKind::bad_request, "", "ordering", cause);
}

std::vector<int> natural(int n) {
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<int> minimum_degree(const Graph& graph) {
  const int n = graph.size();
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  const std::vector<double> ones(graph.neighbours.size(), 1.0);
  const Eigen::Map<const Matrix> pattern(n, n, graph.start[n], graph.start.data(),
                                         graph.neighbours.data(), ones.data());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(Matrix(pattern), permutation);
  const auto& indices = permutation.indices();
  return {indices.data(), indices.data() + n};
}

#ifdef TIMBRE_WITH_METIS
std::vector<int> metis(const Graph& graph) {
  static_assert(sizeof(idx_t) == sizeof(int));
  idx_t n = graph.size();
  Graph copy = graph;  // METIS takes pointers to what it could change
  std::vector<int> order(static_cast<std::size_t>(n));
  std::vector<int> place(order.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  const int status = METIS_NodeND(&n, copy.start.data(), copy.neighbours.data(), nullptr, options,
                                  order.data(), place.data());
  if (status != METIS_OK) throw std::bad_alloc();
  return order;
}
#endif

OrderingMethod chosen(const Graph& graph, const Points* positions, OrderingMethod method) {
  if (method != OrderingMethod::automatic) return method;
  if (graph.size() < kSmall) return OrderingMethod::minimum_degree;
  if (positions != nullptr) return OrderingMethod::geometric;
  return has_metis() ? OrderingMethod::metis : OrderingMethod::minimum_degree;
}

std::vector<int> checked_geometric(const Graph& graph, const Points* positions) {
  if (positions == nullptr) refuse("'geometric' needs positions; choose 'metis' or 'automatic'");
  if (positions->rows() != graph.size()) {
    refuse(std::to_string(positions->rows()) + " positions for " + std::to_string(graph.size()) +
           " unknowns; one for each is needed");
  }
  if (!positions->allFinite()) refuse("a position is not finite");
  return geometric_dissection(graph, *positions);
}

}  // namespace

Graph adjacency(const Pencil& pencil) {
  const int n = pencil.size;
  if (2 * (pencil.entries() - n) > std::numeric_limits<int>::max()) {
    refuse("the pattern has more than 2^31 - 1 entries");
  }
  Graph graph;
  graph.start.assign(static_cast<std::size_t>(n) + 1, 0);
  const auto for_each = [&](auto&& visit) {
    for (int j = 0; j < n; ++j) {
      for (std::int64_t e = pencil.start[j]; e < pencil.start[j + 1]; ++e) {
        if (pencil.row[e] != j) visit(pencil.row[e], j);
      }
    }
  };
  for_each([&](int i, int j) {
    ++graph.start[i + 1];
    ++graph.start[j + 1];
  });
  std::partial_sum(graph.start.begin(), graph.start.end(), graph.start.begin());
  graph.neighbours.resize(static_cast<std::size_t>(graph.start[n]));
  // Smaller neighbours of v come from columns before v, larger ones from column v: ascending.
  std::vector<int> next(graph.start.begin(), graph.start.end() - 1);
  for_each([&](int i, int j) {
    graph.neighbours[next[i]++] = j;
    graph.neighbours[next[j]++] = i;
  });
  return graph;
}

bool has_metis() {
#ifdef TIMBRE_WITH_METIS
  return true;
#else
  return false;
#endif
}

std::vector<int> compute_ordering(const Graph& graph, const Points* positions,
                                  OrderingMethod method) {
  switch (chosen(graph, positions, method)) {
    case OrderingMethod::geometric:
      return checked_geometric(graph, positions);
    case OrderingMethod::metis:
#ifdef TIMBRE_WITH_METIS
      if (graph.neighbours.empty()) return natural(graph.size());  // METIS divides by them
      return metis(graph);
#else
      refuse("this build of timbre has no METIS; choose 'geometric' or 'automatic'");
#endif
    case OrderingMethod::minimum_degree:
      if (graph.neighbours.empty()) return natural(graph.size());
      return minimum_degree(graph);
    default:
      return natural(graph.size());
  }
}

}  // namespace timbre::detail
