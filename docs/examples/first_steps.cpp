#include <iostream>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/matching/match.h"

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const timbre::MeshFile a = timbre::read_mesh(argv[1]);
  const timbre::MeshFile b = timbre::read_mesh(argv[2]);

  const timbre::Operator op = timbre::compute_operator(a.mesh);
  const timbre::Spectrum spectrum = timbre::compute_spectrum(op, {.count = 50});
  std::cout << "lambda_1 = " << spectrum.values[1] << ", " << spectrum.certificate->count
            << " eigenvalues below " << spectrum.certificate->bound << '\n';

  const timbre::MatchResult map =
      timbre::match(timbre::prepare_surface(a.mesh), timbre::prepare_surface(b.mesh));
  std::cout << timbre::to_word(map.verdict) << ": vertex 0 -> " << map.ab[0] << '\n';
} catch (const timbre::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
