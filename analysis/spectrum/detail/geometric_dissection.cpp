#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "timbre/analysis/spectrum/detail/ordering.h"

namespace timbre::detail {
namespace {

using Eigen::RowVector3d;

constexpr int kLeaf = 8;        // parts this small are not cut
constexpr int kBins = 256;      // places looked at for a cut
constexpr double kLeast = 0.3;  // share of a part that either side of a cut must have
constexpr int kSample = 512;    // vertices that tell the axes of a part

// The vertices [begin, end) of the list; they are eliminated last at place `last` - 1.
struct Part {
  int begin, end, last;
  [[nodiscard]] int size() const { return end - begin; }
};

struct Axes {
  RowVector3d longest, second;
};

class Dissection {
 public:
  Dissection(const Graph& graph, const Points& positions)
      : graph_(graph),
        positions_(positions),
        vertices_(static_cast<std::size_t>(graph.size())),
        order_(vertices_.size()),
        label_(vertices_.size(), 0),
        key_(vertices_.size()) {
    std::iota(vertices_.begin(), vertices_.end(), 0);
  }

  std::vector<int> run() && {
    std::vector<Part> parts{{0, graph_.size(), graph_.size()}};
    while (!parts.empty()) {
      const Part part = parts.back();
      parts.pop_back();
      if (part.size() <= kLeaf) {
        std::copy(at(part.begin), at(part.end), order_.begin() + (part.last - part.size()));
        continue;
      }
      const auto [left, right] = split(part);
      parts.push_back(left);
      parts.push_back(right);
    }
    return std::move(order_);
  }

 private:
  using Place = std::vector<int>::iterator;
  Place at(int i) { return vertices_.begin() + i; }

  [[nodiscard]] Axes axes_of(const Part& part) const {
    const int step = std::max(1, part.size() / kSample);
    RowVector3d centre = RowVector3d::Zero();
    int count = 0;
    for (int i = part.begin; i < part.end; i += step, ++count) centre += position(i);
    centre /= count;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (int i = part.begin; i < part.end; i += step) {
      const RowVector3d d = position(i) - centre;
      spread += d.transpose() * d;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(spread);
    return {solver.eigenvectors().col(2).transpose(), solver.eigenvectors().col(1).transpose()};
  }

  [[nodiscard]] RowVector3d position(int i) const { return positions_.row(vertices_[i]); }

  // For each bin border: edges of the part that cross it, by their ends. The cheapest border, if
  // any leaves both sides large enough; crossings count more the more uneven the sides are.
  [[nodiscard]] std::optional<double> cheapest_cut(const Part& part, int label) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (int i = part.begin; i < part.end; ++i) {
      low = std::min(low, key_[vertices_[i]]);
      high = std::max(high, key_[vertices_[i]]);
    }
    if (!(high > low)) return std::nullopt;
    const int bins = std::clamp(part.size() / 4, 8, kBins);
    const double scale = bins / (high - low) * (1.0 - 1e-12);
    const auto bin = [&](int v) {
      return std::clamp(static_cast<int>((key_[v] - low) * scale), 0, bins - 1);
    };
    std::array<int, kBins + 1> population{};
    std::array<int, kBins + 1> change{};  // of the number of crossing edges, at each border
    for (int i = part.begin; i < part.end; ++i) {
      const int v = vertices_[i];
      const int from = bin(v);
      ++population[from];
      for (int e = graph_.start[v]; e < graph_.start[v + 1]; ++e) {
        const int w = graph_.neighbours[e];
        if (label_[w] != label || !(key_[w] > key_[v])) continue;
        ++change[from + 1];
        --change[bin(w) + 1];
      }
    }
    std::optional<double> best;
    double least = std::numeric_limits<double>::infinity();
    int below = 0;
    int crossing = 0;
    for (int border = 1; border < bins; ++border) {
      below += population[border - 1];
      crossing += change[border];
      const double share = static_cast<double>(below) / part.size();
      if (share < kLeast || share > 1.0 - kLeast) continue;
      const double cost = (crossing + 1) * (1.0 + 3.0 * (share - 0.5) * (share - 0.5));
      if (cost >= least) continue;
      least = cost;
      best = low + border / scale;
    }
    return best;
  }

  // The list from `begin` on becomes [below the cut][above]; returns where the second starts.
  int cut(const Part& part, int label) {
    if (const auto place = cheapest_cut(part, label)) {
      const auto middle =
          std::partition(at(part.begin), at(part.end), [&](int v) { return key_[v] < *place; });
      const int found = static_cast<int>(middle - vertices_.begin());
      if (found > part.begin && found < part.end) return found;
    }
    const int middle = part.begin + part.size() / 2;
    std::nth_element(at(part.begin), at(middle), at(part.end), [&](int v, int w) {
      return key_[v] < key_[w] || (key_[v] == key_[w] && v < w);
    });
    return middle;
  }

  [[nodiscard]] bool touches(int v, int label) const {
    for (int e = graph_.start[v]; e < graph_.start[v + 1]; ++e) {
      if (label_[graph_.neighbours[e]] == label) return true;
    }
    return false;
  }

  int mark(int begin, int end) {
    ++labels_;
    for (int i = begin; i < end; ++i) label_[vertices_[i]] = labels_;
    return labels_;
  }

  // Moves the vertices of [begin, end) that touch `label` behind the others.
  int boundary_behind(int begin, int end, int label) {
    const auto border =
        std::partition(at(begin), at(end), [&](int v) { return !touches(v, label); });
    return static_cast<int>(border - vertices_.begin());
  }

  // Cuts a part, puts its separator last, and returns the two sides.
  std::pair<Part, Part> split(const Part& part) {
    const Axes axes = axes_of(part);
    const int whole = mark(part.begin, part.end);
    for (int i = part.begin; i < part.end; ++i) key_[vertices_[i]] = axes.longest.dot(position(i));
    const int middle = cut(part, whole);
    const int below = mark(part.begin, middle);
    const int above = mark(middle, part.end);
    const int below_border = boundary_behind(part.begin, middle, above);
    const int above_border = boundary_behind(middle, part.end, below);
    int left_end = middle;
    int right_end = above_border;
    if (middle - below_border < part.end - above_border) {  // [left][separator][right]
      std::rotate(at(below_border), at(middle), at(part.end));
      left_end = below_border;
      right_end = part.end - (middle - below_border);
    }
    place_separator({right_end, part.end, part.last}, axes.second);
    const int before = part.last - (part.end - right_end);
    return {{part.begin, left_end, before - (right_end - left_end)}, {left_end, right_end, before}};
  }

  // Neighbours in space get neighbouring numbers.
  void place_separator(const Part& separator, const RowVector3d& direction) {
    for (int i = separator.begin; i < separator.end; ++i) {
      key_[vertices_[i]] = direction.dot(position(i));
    }
    std::sort(at(separator.begin), at(separator.end),
              [&](int v, int w) { return key_[v] < key_[w] || (key_[v] == key_[w] && v < w); });
    std::copy(at(separator.begin), at(separator.end),
              order_.begin() + (separator.last - separator.size()));
  }

  const Graph& graph_;
  const Points& positions_;
  std::vector<int> vertices_, order_;
  std::vector<int> label_;  // of the part that a vertex was last seen in
  std::vector<double> key_;
  int labels_ = 0;
};

}  // namespace

std::vector<int> geometric_dissection(const Graph& graph, const Points& positions) {
  return Dissection(graph, positions).run();
}

}  // namespace timbre::detail
