#pragma once

#include <map>
#include <string>

#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/cli/command.h"

namespace timbre::cli {

/// The mesh formats that `dataset make` writes, by their words.
[[nodiscard]] const std::map<std::string, MeshFormat>& mesh_formats();

void add_dataset_info(CLI::App& dataset, Context& context);
void add_make_creatures(CLI::App& make, Context& context);

}  // namespace timbre::cli
