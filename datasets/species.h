#pragma once

#include <string>
#include <vector>

#include "timbre/datasets/skeleton.h"

namespace timbre {

/// The creatures there are, in the order of the documentation.
[[nodiscard]] std::vector<std::string> species_names();

/// The skeleton of a species at rest.
/// @throws Error  bad_request for a name that `species_names` does not list
[[nodiscard]] Skeleton make_skeleton(const std::string& species);

}  // namespace timbre
