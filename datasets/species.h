#pragma once

#include <string>
#include <vector>

#include "timbre/datasets/random.h"
#include "timbre/datasets/skeleton.h"

namespace timbre {

/// The creatures there are, in the order of the documentation.
[[nodiscard]] std::vector<std::string> species_names();

/// The skeleton of a species at rest.
/// @param variation  bones are longer and thicker by random factors in
///                   [1 - variation, 1 + variation], left and right alike
/// @throws Error  bad_request for a name that `species_names` does not list
[[nodiscard]] Skeleton make_skeleton(const std::string& species, double variation, Random& random);

}  // namespace timbre
