#include "timbre/matching/candidates.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

namespace timbre {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A map under search: C without the constants, and its two correlations.
struct State {
  MatrixXd C;
  double products = 0.0;
  double areas = 0.0;
  [[nodiscard]] double score(int orientation) const { return products + orientation * areas; }
};

MatrixXd polar(const MatrixXd& G) {
  const Eigen::JacobiSVD<MatrixXd> svd(G, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Tensor3 weighted(const Tensor3& tensor, const VectorXd& weight) {
  Tensor3 result = tensor;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] =
        weight[static_cast<Index>(i)] * weight.asDiagonal() * result[i] * weight.asDiagonal();
  }
  return result;
}

double leading_norm(const Tensor3& tensor, Index k) {
  double sum = 0.0;
  for (Index i = 0; i < k; ++i) {
    sum += tensor[static_cast<std::size_t>(i)].topLeftCorner(k, k).squaredNorm();
  }
  return std::sqrt(sum);
}

// The tensors of both shapes, weighted so that low functions lead, and what a map's
// agreement with them is.
class TensorPair {
 public:
  TensorPair(const MatchSurface& A, const MatchSurface& B, Index size, int orientation)
      : orientation_(orientation) {
    const VectorXd lambda = 0.5 * (A.values.segment(1, size) + B.values.segment(1, size));
    const double third = lambda[std::min<Index>(2, size - 1)];
    // The exponents even out the growth of P and O with frequency: O grows like lambda.
    const VectorXd p = (lambda.array() + third).pow(-0.5);
    const VectorXd o = (lambda.array() + third).pow(-0.5 - 1.0 / 3.0);
    products_ = {weighted(A.products, p), weighted(B.products, p)};
    areas_ = {weighted(A.areas, o), weighted(B.areas, o)};
    mask_.resize(size, size);
    for (Index i = 0; i < size; ++i) {
      for (Index j = 0; j < size; ++j) {
        const double width = 1.5 + 0.35 * static_cast<double>(std::max(i, j));
        mask_(i, j) = std::exp(-std::pow(static_cast<double>(i - j) / width, 2));
      }
    }
  }

  // A third of the gradient of the score, `size` square, from the terms whose two other
  // indices lie in the part of C that is known; also fills in the correlations.
  MatrixXd gradient(State& state, Index known, Index size) const {
    const MatrixXd C = state.C.topLeftCorner(known, known);
    MatrixXd G = MatrixXd::Zero(size, size);
    state.products = add_gradient(products_, C, size, 1.0, G);
    state.areas = add_gradient(areas_, C, size, orientation_, G);
    return G;
  }

  void polish_seed(State& state, int rounds) const {
    const Index k = state.C.rows();
    for (int round = 0; round < rounds; ++round) {
      const MatrixXd G = gradient(state, k, k);
      const double largest = G.cwiseAbs().maxCoeff() + 1e-15;
      state.C = polar(0.7 / largest * G.cwiseProduct(mask_.topLeftCorner(k, k)) + 0.3 * state.C);
    }
  }

  void grow(State& state, Index size, int rounds) const {
    for (int round = 0; round < rounds; ++round) {
      const Index known = state.C.rows();
      const MatrixXd G = gradient(state, known, size);
      state.C = polar(G.cwiseProduct(mask_.topLeftCorner(size, size)));
    }
  }

  void score(State& state) const { (void)gradient(state, state.C.rows(), state.C.rows()); }

 private:
  using Both = std::pair<Tensor3, Tensor3>;

  static double add_gradient(const Both& tensors, const MatrixXd& C, Index size, double weight,
                             MatrixXd& G) {
    const Index known = C.rows();
    const auto& [TA, TB] = tensors;
    // Row i of `own`: A's slice i; column a of `carried`: C T_a C^T, of B's slice a.
    MatrixXd own(known * known, size);
    MatrixXd carried(known * known, size);
    for (Index i = 0; i < size; ++i) {
      const auto at = static_cast<std::size_t>(i);
      own.col(i) = TA[at].topLeftCorner(known, known).reshaped();
      const MatrixXd half = C * TB[at].topLeftCorner(known, known);
      const MatrixXd whole = half * C.transpose();
      carried.col(i) = whole.reshaped();
    }
    const double norms = leading_norm(TA, known) * leading_norm(TB, known) + 1e-300;
    const MatrixXd g = own.transpose() * carried / norms;
    G += weight * g;
    return g.topLeftCorner(known, known).cwiseProduct(C).sum();
  }

  int orientation_;
  Both products_, areas_;
  MatrixXd mask_;
};

// Every order of k functions in which none moves further than `displacement`.
void add_orders(std::vector<int>& order, std::vector<bool>& used, int displacement,
                std::vector<std::vector<int>>& all) {
  const auto k = static_cast<int>(used.size());
  const auto place = static_cast<int>(order.size());
  if (place == k) {
    all.push_back(order);
    return;
  }
  for (int j = std::max(0, place - displacement); j <= std::min(k - 1, place + displacement); ++j) {
    if (used[static_cast<std::size_t>(j)]) continue;
    used[static_cast<std::size_t>(j)] = true;
    order.push_back(j);
    add_orders(order, used, displacement, all);
    order.pop_back();
    used[static_cast<std::size_t>(j)] = false;
  }
}

std::vector<State> signed_orders(int k, int displacement) {
  std::vector<std::vector<int>> orders;
  std::vector<int> order;
  std::vector<bool> used(static_cast<std::size_t>(k), false);
  add_orders(order, used, displacement, orders);
  std::vector<State> seeds;
  for (const std::vector<int>& to : orders) {
    for (unsigned signs = 0; signs < (1U << k); ++signs) {
      State seed{MatrixXd::Zero(k, k)};
      for (int i = 0; i < k; ++i) {
        seed.C(i, to[static_cast<std::size_t>(i)]) = (signs >> i & 1U) != 0 ? -1.0 : 1.0;
      }
      seeds.push_back(std::move(seed));
    }
  }
  return seeds;
}

void keep_best(std::vector<State>& states, int orientation, std::size_t cap) {
  std::stable_sort(states.begin(), states.end(), [&](const State& a, const State& b) {
    return a.score(orientation) > b.score(orientation);
  });
  if (states.size() > cap) states.resize(cap);
}

void drop_duplicates(std::vector<State>& states, int orientation, double tolerance,
                     std::size_t cap) {
  keep_best(states, orientation, states.size());
  std::vector<State> kept;
  for (State& state : states) {
    const double far = tolerance * static_cast<double>(state.C.rows());
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const State& other) {
      return (other.C - state.C).squaredNorm() > far;
    });
    if (is_new) kept.push_back(std::move(state));
    if (kept.size() == cap) break;
  }
  states = std::move(kept);
}

}  // namespace

std::vector<Candidate> search_candidates(const MatchSurface& A, const MatchSurface& B,
                                         int orientation, const CandidateOptions& options) {
  const auto size = static_cast<Index>(std::min(
      {A.products.size(), B.products.size(), static_cast<std::size_t>(options.final_size)}));
  const int seed_size = static_cast<int>(std::min<Index>(options.seed_size, size));
  const TensorPair pair(A, B, size, orientation);

  std::vector<State> states = signed_orders(seed_size, options.displacement);
  for (State& state : states) pair.score(state);
  keep_best(states, orientation, static_cast<std::size_t>(options.kept_seeds));
  for (State& state : states) {
    pair.polish_seed(state, 4);
    pair.score(state);
  }
  const auto polished = static_cast<std::size_t>(options.kept_polished);
  const auto grown = static_cast<std::size_t>(options.kept_grown);
  drop_duplicates(states, orientation, 0.3, polished);

  for (Index k = seed_size; k < size;) {
    k = std::min(size, k + 2);
    for (State& state : states) pair.grow(state, k, 3);
    if (k != 12 && k != 16) continue;
    for (State& state : states) pair.score(state);
    drop_duplicates(states, orientation, 0.2, k == 16 ? grown : polished);
  }
  for (State& state : states) {
    pair.grow(state, size, 3);
    pair.score(state);
  }
  drop_duplicates(states, orientation, 0.2, grown);

  std::vector<Candidate> candidates;
  for (const State& state : states) {
    Candidate candidate{MatrixXd::Zero(size + 1, size + 1), state.products, state.areas,
                        orientation};
    candidate.C(0, 0) = 1.0;
    candidate.C.bottomRightCorner(size, size) = state.C;
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

std::vector<Candidate> without_duplicates(std::vector<Candidate> candidates, double tolerance,
                                          std::size_t cap) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score() > b.score(); });
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return (other.C - candidate.C).squaredNorm() >
             tolerance * static_cast<double>(candidate.C.rows() - 1);
    });
    if (is_new && kept.size() < cap) kept.push_back(std::move(candidate));
  }
  return kept;
}

double tensor_correlation(const Tensor3& A, const Tensor3& B, const MatrixXd& C) {
  const Index k = C.rows();
  double inner = 0.0;
  double norm_a = 0.0;
  double norm_b = 0.0;
  // Carry the last two indices slice by slice, then mix the slices.
  std::vector<MatrixXd> carried;
  for (Index b = 0; b < k; ++b) {
    carried.emplace_back(C * B[static_cast<std::size_t>(b)].topLeftCorner(k, k) * C.transpose());
  }
  for (Index i = 0; i < k; ++i) {
    MatrixXd predicted = MatrixXd::Zero(k, k);
    for (Index b = 0; b < k; ++b) predicted += C(i, b) * carried[static_cast<std::size_t>(b)];
    const auto own = A[static_cast<std::size_t>(i)].topLeftCorner(k, k);
    inner += own.cwiseProduct(predicted).sum();
    norm_a += own.squaredNorm();
    norm_b += predicted.squaredNorm();
  }
  return inner / (std::sqrt(norm_a * norm_b) + 1e-15);
}

}  // namespace timbre
