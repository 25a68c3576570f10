#pragma once

#include <string>

#include "timbre/analysis/mesh/triangle_mesh.h"

namespace timbre::detail {

/// @throws Error  bad_request unless a creature of that many vertices can be asked for
void require_possible_count(int vertices);

/// Whether a mesh is one closed, oriented surface of genus 0.
[[nodiscard]] bool is_sphere(const TriangleMesh& mesh);

/// @throws Error  bad_input, always: so few vertices do not make a sphere of this species
[[noreturn]] void refuse_count(int vertices, const std::string& species);

}  // namespace timbre::detail
