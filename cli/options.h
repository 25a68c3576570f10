#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "timbre/analysis/operators/operator.h"
#include "timbre/cli/render/camera.h"

namespace timbre::cli {

// Options that mean the same in every command.

/// --operator and --mass.
void add_operator_options(CLI::App& command, OperatorOptions& options);

/// --up: which axis of the meshes points up in pictures.
void add_up_option(CLI::App& command, UpAxis& up);

/// A number in [low, high], which messages show as people write them.
[[nodiscard]] CLI::Validator number_between(double low, double high);

/// What the ending of an output name asks for: "npz", "npy" or "txt".
/// @throws Error  bad_request for another ending; "-" is text
[[nodiscard]] std::string array_format(const std::string& path);

}  // namespace timbre::cli
