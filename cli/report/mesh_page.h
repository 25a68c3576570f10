#pragma once

#include <string>

#include "timbre/analysis/mesh/diagnosis.h"
#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/cli/report/pictures.h"

namespace timbre::cli {

/// One page about a mesh: what it is, what is odd about it and what that means, with pictures on
/// which each defect is marked. It needs no other file and no network. The same inputs give the
/// same bytes.
/// @param name   what to call the mesh
/// @param found  its diagnosis; what its lists hold is marked
[[nodiscard]] std::string make_mesh_page(const std::string& name, const MeshFile& file,
                                         const Diagnosis& found, const PictureOptions& options);

}  // namespace timbre::cli
