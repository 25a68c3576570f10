#pragma once

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre {

// Surfaces whose spectrum is known in closed form, for tests and demonstrations.
// All are outward oriented where they enclose a volume; nothing is random.

/// Unit sphere: an icosahedron with each face divided `frequency`^2 times and pushed
/// out; 10 frequency^2 + 2 vertices. Eigenvalues l (l + 1), each 2 l + 1 times.
[[nodiscard]] TriangleMesh make_sphere(int frequency);

/// Rectangle [0, width] x [0, height] of nx x ny cells, each cut along the same diagonal.
/// Neumann eigenvalues pi^2 (i^2 / width^2 + j^2 / height^2).
[[nodiscard]] TriangleMesh make_rectangle(double width, double height, int nx, int ny);

/// Unit disk of `rings` concentric rings, 6 r points on ring r.
/// Neumann eigenvalues: squares of the zeros of the derivatives of Bessel functions.
[[nodiscard]] TriangleMesh make_disk(int rings);

/// Torus of revolution, `major` > `minor` > 0, nu x nv vertices.
[[nodiscard]] TriangleMesh make_torus(double major, double minor, int nu, int nv);

/// Open tube of radius 1 and the given height, around y, nu x nv vertices; nv at least 2.
/// Neumann eigenvalues m^2 + (pi j / height)^2, twice where m > 0.
[[nodiscard]] TriangleMesh make_cylinder(double height, int nu, int nv);

/// Ellipsoid with the given semi-axes, from a sphere of `frequency`.
[[nodiscard]] TriangleMesh make_ellipsoid(double a, double b, double c, int frequency);

/// A surface given by lengths alone; `lengths(f, c)` lies opposite corner c.
struct IntrinsicMesh {
  Faces faces;
  Points lengths;
  Eigen::Index vertices = 0;
};

/// Flat torus of n x n square cells, side 1 in all. With lumped mass the discrete
/// spectrum is closed form: n^2 (4 - 2 cos(2 pi i / n) - 2 cos(2 pi j / n)).
[[nodiscard]] IntrinsicMesh make_flat_torus(int n);

}  // namespace timbre
