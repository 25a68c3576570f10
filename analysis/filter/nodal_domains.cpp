#include "timbre/analysis/filter/nodal_domains.h"

#include <array>

#include "timbre/analysis/core/disjoint_sets.h"
#include "timbre/analysis/core/error.h"

namespace timbre {
namespace {

using Signs = std::vector<int>;

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

Signs signs_of(const Eigen::VectorXd& function, double zero) {
  const double bar = function.size() == 0 ? 0.0 : zero * function.cwiseAbs().maxCoeff();
  Signs signs;
  signs.reserve(static_cast<std::size_t>(function.size()));
  for (const double value : function) signs.push_back(value > bar ? 1 : value < -bar ? -1 : 0);
  return signs;
}

// Joins the ends of each edge of a proper triangle of which both are wanted.
template <typename Wanted>
DisjointSets joined(const Faces& faces, std::size_t vertices, const Wanted& wanted) {
  DisjointSets sets(vertices);
  for (const auto& face : faces.rowwise()) {
    const std::array<std::int32_t, 3> v = {face[0], face[1], face[2]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      if (wanted(v[c], v[(c + 1) % 3])) sets.join(v[c], v[(c + 1) % 3]);
    }
  }
  return sets;
}

void label_strong(const Faces& faces, const Signs& signs, NodalDomains& found) {
  DisjointSets sets = joined(faces, signs.size(), [&](std::int32_t a, std::int32_t b) {
    return signs[at(a)] == signs[at(b)] && signs[at(a)] != 0;
  });
  found.label.assign(signs.size(), -1);
  for (std::size_t v = 0; v < signs.size(); ++v) {
    if (signs[v] == 0) continue;
    const std::size_t root = at(sets.root(static_cast<std::int32_t>(v)));
    if (root == v) found.label[v] = found.count++;
    found.label[v] = found.label[root];
  }
}

// Where the function is not of the other sign; each set that holds one of this sign.
std::int32_t count_weak(const Faces& faces, const Signs& signs, int sign) {
  DisjointSets sets = joined(faces, signs.size(), [&](std::int32_t a, std::int32_t b) {
    return signs[at(a)] != -sign && signs[at(b)] != -sign;
  });
  std::vector<bool> seen(signs.size(), false);
  std::int32_t count = 0;
  for (std::size_t v = 0; v < signs.size(); ++v) {
    if (signs[v] != sign) continue;
    const std::size_t root = at(sets.root(static_cast<std::int32_t>(v)));
    if (!seen[root]) ++count;
    seen[root] = true;
  }
  return count;
}

}  // namespace

NodalDomains find_nodal_domains(const Faces& faces, const Eigen::VectorXd& function, double zero) {
  if (!(zero >= 0.0) ||
      (faces.size() > 0 && (faces.minCoeff() < 0 || faces.maxCoeff() >= function.size()))) {
    throw Error(ErrorKind::bad_request, "", "nodal domains",
                "need a value for each vertex and a threshold of at least 0");
  }
  const Signs signs = signs_of(function, zero);
  NodalDomains found;
  label_strong(faces, signs, found);
  found.weak_count = count_weak(faces, signs, 1) + count_weak(faces, signs, -1);
  return found;
}

}  // namespace timbre
